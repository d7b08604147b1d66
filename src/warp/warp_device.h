// A device, such as a GPU (gpu/warp/warp_device.h), that turns reprojected views into samples in place of the CPU. The
// warp prepares the views in the same way for both (depths of edges, silhouettes). It works itself on the rows that the
// device leaves, and it looks for images in mirrors and glass.
#pragma once

#include "base/progress.h"
#include "deep/ldi.h"
#include "lens/thin_lens.h"
#include "warp/images/patch_comparison.h"

#include <functional>
#include <optional>
#include <vector>

namespace sparselens {

class ReprojectedViews;

inline constexpr int warp_band_rows = 16; // worked on at once; a device is given whole bands

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

// Bands of the result, one below the other.
struct WarpedBands {
    std::size_t first, count;
    Ldi ldi;                          // of the pixels of these bands only
    std::vector<Disagreement> differ; // by blocks of kernels::photo_block pixels of these bands, row by row
};

class WarpDevice {
public:
    WarpDevice() = default;
    WarpDevice(const WarpDevice &) = delete;
    WarpDevice &operator=(const WarpDevice &) = delete;
    virtual ~WarpDevice() = default;

    // Works on the bands of the data window that it can, and calls done() for each of them once.
    virtual void warp(const WarpScene &scene, const std::function<void(WarpedBands)> &done) = 0;
    virtual DeviceReport take_report() = 0; // of rows
};

} // namespace sparselens
