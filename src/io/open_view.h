// A rendered view from a file, ready for use: depth is planar, invalid values are repaired, and the camera comes from
// the file, overridden by the user's values.
#pragma once

#include "../base/image.h"
#include "../deep/sanitize.h"
#include "../view/depth.h"
#include "../view/resolve_lens.h"
#include "../view/view.h"
#include "camera/camera_header.h"
#include "exr/exr_flat.h"
#include "exr/exr_parts.h"
#include "usd/film_camera.h"

#include <ImfHeader.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

// How files are opened: what the user states about their camera and their depth.

struct DepthOptions {
    DepthMeaning meaning = DepthMeaning::planar;
    PictureChoice picture = {};
    // In the unit of the depth channel. Anything at `far` (1e10) or beyond is sky. Both planes are needed if depth is
    // normalized or hyperbolic (see below).
    std::optional<double> near = {}, far = {};

    bool operator==(const DepthOptions &) const = default;
};

// The disparities that become 0 and 1.
struct DisparityRange {
    double least = 0, most = 1;
};

// A pixel in focus, and the depth of its front surface.
struct PixelInFocus {
    Imath::V2i pixel;
    double depth = 0;
};

struct OpenOptions {
    LensValues lens = {}; // empty values come from the file
    DepthOptions depth = {};
    std::optional<FilmCamera> camera = {};          // instead of the camera of the file
    std::optional<DisparityRange> disparities = {}; // of a photograph (repair_disparities); empty: its own
};

// The planes that the depths of a file refer to: `near` and `far` of the user, otherwise those of its header.

// Only normalised and hyperbolic depths need a near plane and take planes from the header (the attributes near and far,
// nearClip and farClip, clipNear and clipFar). Throws UsageError if a needed plane is unknown, the far one is not
// behind the near one, or a near plane is given for other depths.
DepthRange depth_range(const DepthOptions &options, const Imf::Header &header);

// A warning if depths that are read unchanged look like normalised ones: none is above 1, and the farthest are exactly
// 1. For a flat picture of that grid it also warns if they bend like depths that are white near (picture_checks.h).
std::optional<std::string> normalized_warning(const DepthOptions &options, std::span<const float> depths);
std::optional<std::string> normalized_warning(const DepthOptions &options, std::span<const float> depths,
                                              const ArrayGrid &grid);

// The camera that the options state, else that of the header, for which it throws as read_perspective_camera() does.
// The values of OpenOptions::lens are not applied. `windows` are the picture's.
inline Camera opened_camera(const Imf::Header &header, const std::string &name,
                            const std::optional<FilmCamera> &stated, const Windows &windows) {
    return stated ? with_film(*stated, read_camera(header), windows) : read_perspective_camera(header, name);
}

// What is known of an opened file besides its pixels.
struct OpenedFile {
    Imf::Header header;
    Camera camera;                             // of the header, overridden by the user's values
    InvalidValues bad;                         // what was repaired
    DepthMeaning depth = DepthMeaning::planar; // how the file's depths were read
    std::vector<std::string> notes, warnings;  // see FlatFile, LdiFile
    // For flat pictures alone:
    bool depth_filtered = false;  // see RepairedEdges
    std::size_t speckles = 0;     // depths of speckles replaced (view/flat_pixels.h)
    bool unpremultiplied = false; // whether its colours seem to be so
    double flicker =
        0; // of a photograph, since the frame before (deep/checks/flicker.h); 0: none, or unknown
    std::optional<DisparityRange> disparities = {}; // by which those of a photograph were scaled
    std::optional<PixelInFocus> focus = {};         // usual_focus() of a photograph
};

struct OpenedView : OpenedFile {
    View view; // at the origin: the caller knows its position

    // Throws UsageError if a value of the lens is unknown (see resolve_lens.h).
    ThinLens lens() const { return resolve_lens(camera, view.image.windows); }
};

// Opens a flat EXR with a depth channel; `-` is standard input. Ray lengths need the frustum; if the file lacks it, it
// is taken from `otherwise`. Throws Error if most depths are invalid (see sanitize()), UsageError if its depth is the
// length of the ray and the focal length is unknown.
OpenedView open_view(const std::string &path, const OpenOptions &options = {}, const Camera &otherwise = {});

// The same for a picture that is already in memory; `path` is for messages.
OpenedView prepare_view(FlatFile file, const std::string &path, const OpenOptions &options = {},
                        const Camera &otherwise = {});

} // namespace sparselens
