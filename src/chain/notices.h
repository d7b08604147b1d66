// What the chain has to say beside its results, as data: a face makes words of it (words.h), or finds by it what to mark.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace sparselens {

// In the order of the table of words.
enum class NoticeKind {
    // Files. Values: what a reader says, in its words.
    reading,
    file_note,
    file_warning,
    coverage_by_colour,
    clamped, // how many values
    camera,
    camera_unsure, // why; the parameter settles it
    // Colours.
    colour_space, // name
    unnamed_chromaticities,
    unnamed_space,  // attribute
    no_colorconfig, // why
    displayed,
    // Views and LDIs.
    picture_warning,   // what a check found, in its words
    coverage_differs,  // the deep file, pixels, of all
    without_colours,   // the deep file, pixels
    light_at_infinity, // pixels
    regions,           // radius, focal length in pixels, focus
    framing,           // x and y of the axis in pixels, zoom, forward
    warped,            // views, samples, pixels
    clustered,         // samples before and after, the largest change of the CoC in pixels
    clustered_blindly,
    // Pictures.
    focused, // depth, x, y
    wide_lens,
    round_aperture,   // method
    overscan,         // pixels needed, pixels rendered
    missing_overscan, // the same
    // Devices.
    on_cpu,
    on_device,       // name
    no_vulkan,       // why
    gather_unusable, // why
    gather_failed,   // why
    gathered_tiles,  // by the device, of all
    left_tiles,      // how many, why
    warp_unusable,   // the same of the warp
    warp_failed,
    warped_rows,
    left_rows,
    uploaded, // MB
};

struct Notice {
    using Value = std::variant<double, std::size_t, std::string>;

    NoticeKind kind;
    std::string file = {};          // its name, for messages
    std::vector<Value> values = {}; // as the kind has them
    std::string parameter = {};     // that would change it, as errors name it (base/error.h)
};

// Called with each when it is known, by one thread at a time.
using Tell = std::function<void(const Notice &)>;

} // namespace sparselens
