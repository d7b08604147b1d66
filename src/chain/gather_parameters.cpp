#include "chain/parameter_rows.h"
#include "shutter/shutter_curve.h"

namespace sparselens {

using namespace parameter_rows;

ParameterRows<WindowOptions> window_parameters() {
    const Parameter filter =
        text("pixel-filter", "box|blackman-harris|gaussian[:WIDTH]",
             "With `supersample`, the renderer's pixel filter for the picture, and its width "
             "as in Cycles (default: as the file says, else box; width 1.5)",
             Form::text, "box, blackman-harris or gaussian, the latter two with :WIDTH in pixels if wanted");
    const auto read_filter = [](const Parameter &, const std::string &text, WindowOptions &windows) {
        windows.filter = pixel_filter_of(text);
        return windows.filter.has_value();
    };
    static const auto rows = all<WindowOptions>(
        {{word("overscan", {"grow", "keep", "crop"},
               "Pixels to make. grow: the pixels of the file, and beyond them as far as the blur reaches in "
               "the display window; keep: the pixels of the file, which cuts the blur off; crop: the pixels "
               "of the file in the display window (default: grow)"),
          in(&WindowOptions::overscan)},
         {on_page(whole("proxy", "N", "Make a picture of 1/N the size (default: 1)", 1, 1024)),
          in(&WindowOptions::proxy)},
         {whole("supersample", "N",
                "Number of pixels of the file, across and down, that make one pixel of the picture; 1: keep "
                "all pixels (default: as the file says, else 1)",
                1, most_across),
          in(&WindowOptions::supersample)},
         {filter, read_filter},
         {text("region", "X0,Y0,X1,Y1",
               "Make only these pixels of the full-size picture, in EXR coordinates, with X1 and Y1 included",
               Form::box, "X0,Y0,X1,Y1 (left, top, right and bottom, all included)"),
          in(&WindowOptions::region)}},
        "Windows");
    return rows;
}

namespace {

ParameterOf<PictureRequest> method_row() {
    std::vector<std::string> names, what;
    for (const GatherMethod &method : gather_methods()) {
        names.emplace_back(method.name);
        what.push_back(fmt::format("{}: {}", method.name, method.what));
    }
    return {word("method", names,
                 fmt::format("Gather method. {} (default: {})", fmt::join(what, "; "), names.front())),
            [](const Parameter &row, const std::string &text, PictureRequest &request) {
                const auto methods = gather_methods();
                const std::size_t i = index_of(row, text);
                if (i < methods.size()) request.picture.method = &methods[i];
                return i < methods.size();
            }};
}

constexpr NumberRange rolling_duration{"a number from 0.001 to 1",
                                       [](double v) { return v >= least_rolling_duration && v <= 1; }};

Rows<PictureRequest> gather_rows() {
    constexpr auto picture = &PictureRequest::picture;
    constexpr auto gather = &PictureOptions::gather;
    const PictureOptions usual;
    const Rows<PictureRequest> lens{
        {on_page(
             word("quality", {"draft", "normal", "final"}, "Trade of error against time (default: normal)")),
         in(picture, gather, &GatherOptions::lens, &LensGatherOptions::quality)},
        {whole("lens-samples", "N",
               "Number of lens points in every tile; 0: chosen by quality and picture (default: 0)", 0,
               1 << 20),
         in(picture, gather, &GatherOptions::lens, &LensGatherOptions::lens_samples)},
        {number("layer-tolerance", "PX",
                fmt::format("First merge layers of a pixel whose circles of confusion differ by less than "
                            "this, in pixels; 0: merge none (default: {})",
                            usual.layer_tolerance),
                at_least_0),
         in(picture, &PictureOptions::layer_tolerance)},
        {text("holdout", "DEEP.exr",
              "Deep EXR that hides what is behind it, and is not shown; it stays sharp", Form::ldi),
         in(&PictureRequest::holdout)},
        {flag("holdout-defocused", "Put the holdout out of focus, like the rest of the scene"),
         in(picture, &PictureOptions::holdout_defocused)}};
    const Rows<PictureRequest> selective{
        {whole("layers", "K",
               fmt::format("Layers kept apart in each pixel (default: {})", usual.gather.layers), 1, 4096),
         in(picture, gather, &GatherOptions::layers)}};
    const Rows<PictureRequest> any{
        {text("device", "", "Device that gathers, for the methods lens and selective", Form::device),
         in(&PictureRequest::device)},
        {keyed(text("focus-pixel", "X,Y", "Focus on the front surface in this pixel, in EXR coordinates",
                    Form::pixel, "X,Y in whole pixels (e.g. 320,180)")),
         in(&PictureRequest::focus_pixel)},
        {text("shutter-curve", "box|triangle|gaussian|FILE",
              "How the moments of a shutter count, whose LDIs IN names by %s. FILE: lines of a time, from 0 "
              "to 1, and a value (default: box)",
              Form::file),
         in(&PictureRequest::shutter_curve)},
        {number("rolling-shutter", "D",
                "Expose each row of the picture for this part of the shutter's time, the top row first, "
                "the bottom row last (default: 1, all rows for all of the time)",
                rolling_duration),
         in(&PictureRequest::rolling_shutter)},
        {text("channels", "LIST", "Channels or layers to gather, comma-separated (default: all)", Form::list),
         in(&PictureRequest::channels)}};
    return joined({{method_row()},
                   all(lens, "Method lens", "lens"),
                   all(selective, "Method selective", "selective"),
                   any});
}

Rows<PictureRequest> shown_rows() {
    const Parameter point = text(
        "lens-point", "X,Y",
        "Show what this point of the lens sees, X right and Y up of its middle, 1 at the rim. Tints areas "
        "that no view saw magenta; unknown areas are black",
        Form::pair, "X,Y at most 1 from the middle (e.g. 0.5,-0.5)");
    const auto read_point = [](const Parameter &row, const std::string &text, PictureRequest &request) {
        constexpr double most_rounded = 1.01; // the length of a rim point rounded to two digits
        Imath::V2d at;
        if (!read_place(row, text, at)) return false;
        if (at.length() > 1 && at.length() <= most_rounded) at.normalize();
        request.picture.gather.lens.point = at;
        return at.length() <= most_rounded;
    };
    const Rows<PictureRequest> show{
        {of_tools(on_page(
             word("show", {"coc", "focus", "layers", "tiles"},
                  "Write false colours instead of the picture. coc: circle of confusion; focus: what is in "
                  "focus; layers: samples per pixel; tiles: lens points per tile, with `method=lens`"))),
         [](const Parameter &row, const std::string &text, PictureRequest &request) {
             request.show = Show(index_of(row, text) + 1); // the first is the picture
             return index_of(row, text) < row.words.size();
         }}};
    return joined({all(show, ""),
                   all<PictureRequest>({{of_tools(on_page(point)), read_point}}, "Method lens", "lens")});
}

} // namespace

ParameterRows<PictureRequest> gather_parameters() {
    static const auto rows = gather_rows();
    return rows;
}
ParameterRows<PictureRequest> shown_parameters() {
    static const auto rows = shown_rows();
    return rows;
}

} // namespace sparselens
