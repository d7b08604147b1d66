// What the chain reports beside its results, as data. An interface turns a notice into words (words.h), or finds by it
// what to mark.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace sparselens {

// In the order of the table of words. Each comment lists the notice's values.
enum class NoticeKind {
    // Files. Values: the reader's own words.
    reading,
    file_note,
    file_warning,
    coverage_by_colour,
    speckles, // what was done about them, in words
    clamped,  // number of values
    camera,
    camera_unsure, // the reason; `parameter` settles it
    // Colours.
    colour_space, // name
    unnamed_chromaticities,
    unnamed_space,  // attribute
    no_colorconfig, // the reason
    displayed,
    // Views and LDIs.
    picture_warning,   // a check's finding, in its words
    coverage_differs,  // the deep file, number of pixels, of all pixels
    without_colours,   // the deep file, pixels
    light_at_infinity, // pixels
    regions,           // radius, focal length in pixels, focus
    framing,           // x and y of the axis in pixels, zoom, forward
    warped,            // views, samples, pixels
    clustered,         // samples before and after, the largest change of the CoC in pixels
    clustered_blindly,
    // Pictures.
    focused, // depth, x, y of the pixel
    wide_lens,
    round_aperture,   // method
    overscan,         // pixels needed, pixels rendered
    missing_overscan, // the same
    // Devices.
    on_cpu,
    on_device,       // name
    no_vulkan,       // reason
    gather_unusable, // reason
    gather_failed,   // reason
    gathered_tiles,  // tiles of the device, all tiles
    left_tiles,      // number, reason
    warp_unusable,   // the same for the warp
    warp_failed,
    warped_rows,
    left_rows,
    uploaded, // MB
};

struct Notice {
    using Value = std::variant<double, std::size_t, std::string>;

    NoticeKind kind;
    std::string file = {};          // its name, for messages
    std::vector<Value> values = {}; // as listed with the kind
    std::string parameter = {};     // that would change it, named as in errors (base/error.h)
};

// Called with each notice as soon as it is known, by one thread at a time.
using Tell = std::function<void(const Notice &)>;

} // namespace sparselens
