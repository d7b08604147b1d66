// How the tools load what they work on: depth made planar, camera and lens put together.
//
// What no picture can mean is made good (bad_values.h) and counted; the caller says so, see warn_of_invalid_values().
#pragma once

#include "deep/holdout.h"
#include "deep/ldi.h"
#include "deep/sanitize.h"
#include "harness/tool.h"
#include "io/exr/exr_deep.h"
#include "options/lens_options.h"
#include "view/view.h"

#include <ImfHeader.h>

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct LoadedLdi {
    Ldi ldi; // tidy
    Imf::Header header;
    Camera camera; // of the header, with the options over it
    InvalidValues bad;
    std::size_t invisible =
        0; // samples of the file that show nothing, or are one with another: tidy() left them out
    std::vector<std::string> notes; // see LdiFile
};

LoadedLdi load_ldi(const std::string &path, const LensOptions &lens, const DepthOptions &depth);

// The deep picture that holds another out; none where the path is empty. Made a
// proxy. Error: its display window is not `windows`'.
std::optional<Holdout> load_holdout(const std::string &path, const Windows &windows, int proxy_factor,
                                    const LensOptions &lens, const DepthOptions &depth);

struct LoadedView {
    View view; // at the origin: the caller knows where it stands
    Imf::Header header;
    Camera camera; // of the header alone
    InvalidValues bad;
};

// What the file does not say of its frustum, which ray lengths need, is as in `otherwise`.
LoadedView load_view(const std::string &path, const LensOptions &lens, const DepthOptions &depth,
                     const Camera &otherwise = {});

// With --verbose: what was made of the parts of the file, and whether coverage is coloured.
void say_samples(const ToolContext &tool, const std::string &path, const LoadedLdi &loaded);

// With --verbose: what the file says about its camera, and which attribute says so.
void say_camera(const ToolContext &tool, const std::string &path, const Camera &camera);

// Each one line on stderr, where there were any; `clamped` is what write_flat_exr and write_ldi return.
void warn_of_clamped(const ToolContext &tool, const std::string &path, std::size_t clamped);
void warn_of_invalid_values(const ToolContext &tool, const std::string &path, const InvalidValues &bad);

} // namespace sparselens
