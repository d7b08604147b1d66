// A device, such as a GPU (gpu/warp/warp_device.h), that turns reprojected views into samples in place of the CPU. The
// warp prepares the views in the same way for both (depths of edges, silhouettes), and looks for images in mirrors and
// glass.
#pragma once

#include "base/progress.h"
#include "deep/ldi.h"
#include "lens/thin_lens.h"
#include "warp/images/patch_comparison.h"

#include <optional>
#include <vector>

namespace sparselens {

class ReprojectedViews;

struct WarpScene {
    const ReprojectedViews &views;
    const Ldi &layout;             // windows and channels of the result
    bool averages;                 // Merge::average
    bool tests_photo_consistency;  // only with `averages`
    double tolerance;              // of 1 / z, within one surface
    double scale;                  // R F
    std::optional<ThinLens> focus; // if the focus is known
    int across;                    // WarpOptions::across
};

struct WarpedViews {
    Ldi ldi;
    std::vector<Disagreement> differ; // by blocks of kernels::photo_block pixels, row by row
};

class WarpDevice {
public:
    WarpDevice() = default;
    WarpDevice(const WarpDevice &) = delete;
    WarpDevice &operator=(const WarpDevice &) = delete;
    virtual ~WarpDevice() = default;

    // Empty if the device cannot.
    virtual std::optional<WarpedViews> warp(const WarpScene &scene) = 0;
    virtual DeviceReport take_report() = 0; // of rows
};

} // namespace sparselens
