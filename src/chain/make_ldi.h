// Makes an LDI from views: takes a request as a user gives it, returns the LDI and its header, and sends notices.
#pragma once

#include "chain/colours.h"
#include "chain/notices.h"
#include "chain/stated_camera.h"
#include "deep/packed_view.h"
#include "denoised/denoised_views.h"
#include "io/open_packed_view.h"
#include "warp/warp.h"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {

struct WarpingDevice; // chain/devices.h

struct LdiFromViews {
    std::string name = "warp"; // of the LDI, for messages
    std::vector<std::string> files =
        {}; // the centre view first; the cameras of the others are in their metadata
    std::vector<std::pair<Imath::V2d, std::string>> placed =
        {};                                    // further views with positions (scene units, x right, y up)
    std::vector<std::string> depth_files = {}; // one per view, or empty
    // The denoised views, in the order of the views, as files or in memory; or the name of the layer in which denoised
    // views hold their noisy colours. Empty: the views are taken as they are.
    std::vector<std::string> denoised = {};
    std::vector<DenoisedPicture> denoised_pictures = {};
    std::string noisy = {};
    CameraRequest camera = {};           // of all views, instead of those in the files
    std::optional<int> supersample = {}; // pixels of all views, across and down, per pixel of the picture
    LensValues lens = {};
    DepthOptions depth = {};
    std::optional<ColourOptions> colour = {}; // how they are made linear; empty: they are linear
    WarpOptions warp = {};                    // lens and device are filled in
    bool round_for_lens = false;              // see deep/rounded.h
    std::string device = "cpu";               // as for choose_device() of gpu/device_list.h
};

// A view in memory, flat or deep, and the position given by the user, see StatedView.
struct ViewInMemory {
    const OpenedView *flat = nullptr;
    const OpenedLdi *deep = nullptr; // set if `flat` is null
    std::optional<Imath::V2d> position = {};
};

struct MadeLdi {
    Ldi ldi;
    Imf::Header header; // of the centre view, with the camera
    Camera camera;      // of the centre view, with the lens of the request and the lens points of all views
    std::size_t views = 0, empty_views = 0, samples_given = 0, pixels_given = 0,
                all_pixels = 0; // masked views give only some
};

struct WarpWork {
    Progress &progress;
    Tell tell;
    WarpingDevice *device = nullptr; // finds the device of the request; null: the CPU works
};

// Makes the LDI from the files of the request, or from views in memory, whose pixels are copied. Throws Error and
// UsageError.
MadeLdi make_ldi(const LdiFromViews &request, const WarpWork &work);
MadeLdi make_ldi(std::span<const ViewInMemory> views, const LdiFromViews &request, const WarpWork &work);

// How to open each of several pictures. If there are depth files, their depths come from these. Throws UsageError if
// the number of files differs from that of the pictures.
std::vector<DepthOptions> depths_of_pictures(const DepthOptions &depth, const std::vector<std::string> &files,
                                             std::size_t pictures);

} // namespace sparselens
