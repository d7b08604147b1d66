// Makes an LDI of views: from a request, which is what a user may say, to the LDI, its header and what is to be said of it.
#pragma once

#include "chain/colours.h"
#include "chain/notices.h"
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
        {};                                    // where they stood (scene units, x right, y up), after those
    std::vector<std::string> depth_files = {}; // of all views, or none
    // What a denoiser made of the views, in their order, as files or in memory; or the layer in which views that are denoised hold
    // what they were before. None: the views are taken as they are.
    std::vector<std::string> denoised = {};
    std::vector<DenoisedPicture> denoised_pictures = {};
    std::string noisy = {};
    std::optional<int> supersample = {}; // pixels of all, across and down, in one of the picture
    LensValues lens = {};
    DepthOptions depth = {};
    std::optional<ColourOptions> colour = {}; // how they are made linear; none: they are
    WarpOptions warp = {};                    // its lens and its device are found
    bool round_for_lens = false;              // see deep/rounded.h
    std::string device = "cpu";               // as choose_device() of gpu/device_list.h has it
};

// A view in memory, flat or deep, and where the user says that it stands, see StatedView.
struct ViewInMemory {
    const OpenedView *flat = nullptr;
    const OpenedLdi *deep = nullptr; // where `flat` is null
    std::optional<Imath::V2d> position = {};
};

struct MadeLdi {
    Ldi ldi;
    Imf::Header header; // of the centre view, with the camera
    Camera camera;      // of the centre view, with the lens over it and the lens points of all views
    std::size_t views = 0, empty_views = 0, samples_given = 0, pixels_given = 0,
                all_pixels = 0; // masked views do not give them all
};

struct WarpWork {
    Progress &progress;
    Tell tell;
    WarpingDevice *device = nullptr; // which finds the device of the request; none: the CPU works
};

// Makes the LDI of the files of the request, or of views in memory, whose pixels are copied. Throws Error and UsageError.
MadeLdi make_ldi(const LdiFromViews &request, const WarpWork &work);
MadeLdi make_ldi(std::span<const ViewInMemory> views, const LdiFromViews &request, const WarpWork &work);

// How each of several pictures is opened, whose depths are in the files where there are any. Throws UsageError where there are more or
// fewer files than pictures.
std::vector<DepthOptions> depths_of_pictures(const DepthOptions &depth, const std::vector<std::string> &files,
                                             std::size_t pictures);

} // namespace sparselens
