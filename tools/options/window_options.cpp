#include "options/window_options.h"

#include "base/error.h"
#include "deep/pad.h"
#include "deep/proxy.h"
#include "harness/words.h"
#include "io/camera/camera_read.h"
#include "io/files/memory_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace sparselens {

namespace {

// "x0,y0,x1,y1" with x0 <= x1 and y0 <= y1, or nothing.
std::optional<Imath::Box2i> parse_box(const std::string &text) {
    int v[4] = {};
    const char *at = text.data(), *const end = at + text.size();
    for (int i = 0; i < 4; ++i) {
        if (i > 0 && (at == end || *at++ != ',')) return {};
        const auto [after, error] = std::from_chars(at, end, v[i]);
        if (error != std::errc()) return {};
        at = after;
    }
    if (at != end || v[0] > v[2] || v[1] > v[3]) return {};
    return Imath::Box2i({v[0], v[1]}, {v[2], v[3]});
}

Imath::Box2i common(const Imath::Box2i &a, const Imath::Box2i &b, const char *what) {
    const Imath::Box2i box({std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)},
                           {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)});
    if (box.isEmpty()) throw UsageError(fmt::format("{} holds no pixel of the picture", what));
    return box;
}

// `data` grown by `reach` where there is display window beyond it.
Imath::Box2i grown(const Imath::Box2i &data, const Imath::V2i &reach, const Imath::Box2i &display) {
    return {{std::min(data.min.x, std::max(display.min.x, data.min.x - reach.x)),
             std::min(data.min.y, std::max(display.min.y, data.min.y - reach.y))},
            {std::max(data.max.x, std::min(display.max.x, data.max.x + reach.x)),
             std::max(data.max.y, std::min(display.max.y, data.max.y + reach.y))}};
}

// A few near samples in a huge display window may require a picture of gigabytes.
void check_growth(const InputLdi &in, const Ldi &ldi, const Imath::Box2i &window) {
    const double pixels =
        (double(window.max.x) - window.min.x + 1) * (double(window.max.y) - window.min.y + 1);
    const std::size_t channels = ldi.channels.size() * sizeof(float), offset = sizeof(ldi.begin[0]);
    check_memory(in.name, pixels * double(channels + offset),
                 ldi.samples() * channels + ldi.windows.pixels() * offset);
}

} // namespace

void add_window_options(CLI::App &app, WindowOptions &options) {
    const std::map<std::string, OutputOverscan> overscans{
        {"keep", OutputOverscan::keep}, {"grow", OutputOverscan::grow}, {"crop", OutputOverscan::crop}};
    app.add_option("--overscan", options.overscan,
                   "Pixels to make. keep: those of the file; grow: also those of the display window that the "
                   "blur reaches; "
                   "crop: those in the display window (default: keep)")
        ->type_name("keep|grow|crop")
        ->transform(words(overscans))
        ->group("Windows");
    app.add_option("--proxy", options.proxy, "Make a picture of 1/N the size (default: 1)")
        ->type_name("N")
        ->check(CLI::Range(1, 1024))
        ->group("Windows");
    app.add_option_function<std::string>(
           "--region",
           [&options](const std::string &text) {
               options.region = parse_box(text);
               if (!options.region)
                   throw CLI::ValidationError("--region",
                                              fmt::format("must be X0,Y0,X1,Y1 (left, top, right and bottom, "
                                                          "all included), not '{}'",
                                                          text));
           },
           "Make only these pixels of the full-size picture, in EXR coordinates, the last ones included")
        ->type_name("X0,Y0,X1,Y1")
        ->group("Windows");
}

GatherWindows gather_windows(const WindowOptions &options, const InputLdi &in, ThinLens &lens) {
    lens.focal_px /= options.proxy;
    GatherWindows frame{reduced(read_picture_window(in.header), options.proxy), {}, {}};
    if (options.proxy > 1) frame.changed = proxy(in.ldi, options.proxy);
    const auto made = [&]() -> const Ldi & { return frame.changed ? *frame.changed : in.ldi; };
    if (options.overscan == OutputOverscan::grow && lens.radius > 0) {
        frame.gathered = grown(frame.gathered, largest_reach(made(), lens), made().windows.display);
        check_growth(in, made(), frame.gathered);
        frame.changed = padded(made(), frame.gathered);
    }
    frame.written = frame.gathered;
    if (options.overscan == OutputOverscan::crop)
        frame.written = common(frame.written, made().windows.display, "--overscan crop: the display window");
    if (options.region)
        frame.written = common(frame.written, reduced(*options.region, options.proxy), "--region");
    return frame;
}

} // namespace sparselens
