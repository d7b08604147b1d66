// What the chain reports beside its results: notices, as data, and one table of their words for all interfaces.
// Parameters stand between backquotes, as in errors (base/error.h).
#pragma once

#include "../io/open_ldi.h"
#include "../lens/lens_looks.h"

#include <cstddef>
#include <functional>
#include <span>
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
    dropped_alpha,
    converted,    // the picture whose space the colours get
    changed_data, // the channel; `parameter` changes it
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
    focused,     // depth, x, y of the pixel
    usual_focus, // x, y of the pixel
    used_lens,   // radius, focal length in pixels, focus
    wide_lens,
    round_aperture,   // method
    overscan,         // pixels needed, pixels rendered
    missing_overscan, // the same
    too_much_blur,    // the same
    flicker,          // pixels of blur
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
using Notify = std::function<void(const Notice &)>;

enum class NoticeLevel {
    note, // shown on request
    warning,
    once, // a warning that need not be repeated for each frame of an animation
};

NoticeLevel level_of(const Notice &notice);
std::string words_of(const Notice &notice);

// The notes and warnings of a file's reader.
void notify_reading(const Notify &notify, const std::string &path, const std::vector<std::string> &notes,
                    const std::vector<std::string> &warnings);

// What happens to each layer, in the order of their first channels, as in the table of docs/file-format.md.
std::vector<std::string> layer_notes(std::span<const Channel> channels);
void notify_layers(const Notify &notify, const std::string &path, std::span<const Channel> channels);

// The notes and warnings of an LDI, whether it has per-channel alpha, and its invalid values.
void notify_samples(const Notify &notify, const OpenedLdi &in);

// What the file states about its camera, and in which attributes.
void notify_camera(const Notify &notify, const std::string &path, const Camera &camera);

// The findings of checks in pictures (deep/checks/view_warnings.h).
void notify_warnings(const Notify &notify, const std::vector<std::string> &warnings);

// Warns if the headers name another lens or camera for a render than for the gathered picture (finish/lens_check.h).
void notify_other_lens(const Notify &notify, const Imf::Header &gathered, const Imf::Header &render,
                       const std::string &path);

// How much overscan the blur needs, in pixels of `across` sub-pixels. It warns if there is too little and a light at
// the border would have its disc cut.
void notify_border_reach(const Notify &notify, const std::string &path, const Ldi &ldi, const ThinLens &lens,
                         int across, const LensLooks &looks);

// All send a notice only if there is something to report. `speckles`: how many were settled (view/flat_pixels.h).
// `clamped` is the result of write_flat_exr or write_ldi.
void notify_clamped(const Notify &notify, const std::string &path, std::size_t clamped);
void notify_speckles(const Notify &notify, const std::string &path, std::size_t speckles);
void notify_invalid_values(const Notify &notify, const std::string &path, const InvalidValues &bad);

} // namespace sparselens
