// Makes an LDI: from views, or with fewer samples from deep pictures. Takes a request as a user gives it, returns the
// LDI and its header, and sends notices.
#pragma once

#include "chain/colours.h"
#include "chain/notices.h"
#include "chain/stated_camera.h"
#include "deep/cluster.h"
#include "deep/view_samples.h"
#include "denoised/denoised_views.h"
#include "io/open_ldi.h"
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
    Notify notify;
    WarpingDevice *device = nullptr; // finds the device of the request; null: the CPU works
};

// Makes the LDI from the files of the request, or from views in memory, whose pixels are copied.
MadeLdi make_ldi(const LdiFromViews &request, const WarpWork &work);
MadeLdi make_ldi(std::span<const ViewInMemory> views, const LdiFromViews &request, const WarpWork &work);

// How to open each of several pictures. If there are depth files, their depths come from these. Throws UsageError if
// the number of files differs from that of the pictures.
std::vector<DepthOptions> depths_of_pictures(const DepthOptions &depth, const std::vector<std::string> &files,
                                             std::size_t pictures);

struct ClusterRequest {
    std::vector<std::string> inputs = {}, depth_files = {}; // files; the latter one per input or none
    std::string recolor = {};                               // a flat picture with their colours; or empty
    DepthOptions depth = {};
    ColourOptions colour = {};        // how the flat picture's colours are read
    const FlatFile *beauty = nullptr; // the same picture in memory, with linear colours
    LensValues lens = {};             // override the files' values
    std::optional<int> supersample = {};
    std::optional<double> tolerance = {}; // pixels of CoC; default 0.25 if the lens is known
    int layers = 0;                       // see ClusterOptions
};

struct ClusteredLdi : Clustered {
    Imf::Header header = {};
    Camera camera = {};
    std::size_t samples_read = 0, invisible = 0; // see OpenedLdi
};

// Takes the files of the request, or LDIs in memory. Name, header and camera are those of the first. Throws Error,
// naming the file, if its display window, its sub-pixels or its focal length differ from those of the first.
ClusteredLdi cluster_ldi(const ClusterRequest &request, Progress &progress, const Notify &notify);
ClusteredLdi cluster_ldi(std::span<const OpenedLdi *const> ldis, const ClusterRequest &request,
                         Progress &progress, const Notify &notify);

} // namespace sparselens
