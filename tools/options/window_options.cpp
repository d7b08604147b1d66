#include "options/window_options.h"

#include "harness/words.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

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

} // namespace

void add_window_options(CLI::App &app, WindowOptions &options) {
    const std::map<std::string, OutputOverscan> overscans{
        {"grow", OutputOverscan::grow}, {"keep", OutputOverscan::keep}, {"crop", OutputOverscan::crop}};
    app.add_option("--overscan", options.overscan,
                   "Pixels to make. grow: the pixels of the file, and beyond them as far as the blur reaches "
                   "in the display window; keep: the pixels of the file, which cuts the blur off; crop: the "
                   "pixels of the file in the display window (default: grow)")
        ->type_name("grow|keep|crop")
        ->transform(words(overscans))
        ->group("Windows");
    app.add_option("--proxy", options.proxy, "Make a picture of 1/N the size (default: 1)")
        ->type_name("N")
        ->check(CLI::Range(1, 1024))
        ->group("Windows");
    app.add_option("--supersample", options.supersample,
                   "Number of pixels of the file, across and down, that make one pixel of the picture; 1: "
                   "keep all pixels (default: as the file says, else 1)")
        ->type_name("N")
        ->check(CLI::Range(1, most_across))
        ->group("Windows");
    app.add_option_function<std::string>(
           "--pixel-filter",
           [&options](const std::string &text) {
               options.filter = pixel_filter_of(text);
               if (!options.filter)
                   throw CLI::ValidationError(
                       "--pixel-filter",
                       fmt::format("must be box, blackman-harris or gaussian, the latter two with :WIDTH in "
                                   "pixels if wanted, not '{}'",
                                   text));
           },
           "With --supersample, the renderer's pixel filter for the picture, and its width as in Cycles "
           "(default: as the file says, else box; width 1.5)")
        ->type_name("box|blackman-harris|gaussian[:WIDTH]")
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
           "Make only these pixels of the full-size picture, in EXR coordinates, with X1 and Y1 included")
        ->type_name("X0,Y0,X1,Y1")
        ->group("Windows");
}

} // namespace sparselens
