#include "base/text.h"
#include "chain/parameter_rows.h"
#include "shutter/shutter_mean.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens::parameter_rows {

namespace {

template <std::size_t count>
bool read_whole(const std::string &text, int (&whole)[count]) {
    constexpr double most = 1 << 30;
    double numbers[count];
    if (!read_numbers(text, numbers)) return false;
    for (std::size_t i = 0; i < count; ++i) {
        if (std::trunc(numbers[i]) != numbers[i] || std::abs(numbers[i]) > most) return false;
        whole[i] = int(numbers[i]);
    }
    return true;
}

} // namespace

bool read_place(const Parameter &row, const std::string &text, double &place) {
    return read_numbers(text, {&place, 1}) && row.range.holds(place);
}
bool read_place(const Parameter &row, const std::string &text, int &place) {
    int whole[1];
    if (!read_whole(text, whole)) return false;
    place = whole[0];
    return place >= row.least && place <= row.most;
}
bool read_place(const Parameter &row, const std::string &text, PhotographBlur &place) {
    place.of_width = text.ends_with('%');
    const bool is_number =
        read_place(row, text.substr(0, text.size() - std::size_t(place.of_width)), place.value);
    if (place.of_width) place.value /= 100;
    return is_number;
}
bool read_place(const Parameter &, const std::string &text, Imath::V2d &place) {
    return read_numbers(text, {&place.x, 2}) && std::isfinite(place.x) && std::isfinite(place.y);
}
bool read_place(const Parameter &, const std::string &text, Imath::V2i &place) {
    int whole[2];
    if (!read_whole(text, whole)) return false;
    place = {whole[0], whole[1]};
    return true;
}
bool read_place(const Parameter &, const std::string &text, Imath::Box2i &place) {
    int whole[4];
    if (!read_whole(text, whole)) return false;
    place = {{whole[0], whole[1]}, {whole[2], whole[3]}};
    return !place.isEmpty();
}

std::size_t index_of(const Parameter &row, const std::string &text) {
    return std::size_t(std::ranges::find(row.words, text) - row.words.begin());
}

} // namespace sparselens::parameter_rows

namespace sparselens {

using namespace parameter_rows;

ParameterRows<LensValues> lens_parameters() {
    static const auto rows = [] {
        constexpr std::array on_pages{"fstop", "lens-radius", "focus-distance"};
        Rows<LensValues> all_numbers;
        for (const auto &of : lens_numbers()) {
            all_numbers.push_back({keyed(number(of)), in(of.value)});
            all_numbers.back().page = is_among(on_pages, of.name);
        }
        return all(std::move(all_numbers), "Lens");
    }();
    return rows;
}

ParameterRows<DepthOptions> depth_parameters() {
    static const auto rows = all<DepthOptions>(
        {{word("depth", {"z", "distance", "inverse", "negative", "normalized", "hyperbolic"},
               "Kind of depth. z: planar; distance: from the camera along the ray; inverse: 1 / z; negative: "
               "-z; normalized: 0 at `near` to 1 at `far` (if near is white, `near` is the larger); "
               "hyperbolic: the same, but linear in 1 / z, as in a depth buffer (default: z)"),
          in(&DepthOptions::meaning)},
         {number("near", "D",
                 "Depth of the value 0 with `depth=normalized` and hyperbolic, in scene units (default: as "
                 "the file says)",
                 at_least_0_or_inf),
          in(&DepthOptions::near)},
         {number("far", "D",
                 "Depth from which all is sky, in scene units; the depth of the value 1 with "
                 "`depth=normalized` and hyperbolic (default: 1e10)",
                 at_least_0_or_inf),
          in(&DepthOptions::far)},
         {text("depth-channel", "NAME",
               "Depth channel of the picture, or of `depth_file` (default: Z, depth.Z, *.Depth.Z or the "
               "like)"),
          in(&DepthOptions::picture, &PictureChoice::depth)}},
        "Lens", "", PythonCall::open_ldi);
    return rows;
}

ParameterRows<PictureChoice> choice_parameters() {
    static const auto rows = all<PictureChoice>(
        {{in_group("Colour", flag("unpremultiplied", "Multiply the colours of the input by its coverage A "
                                                     "(default: they are multiplied already)")),
          in(&PictureChoice::unpremultiplied)},
         {text("stereo-view", "NAME", "Stereo view to read, e.g. right (default: the file's first)"),
          in(&PictureChoice::stereo_view)},
         {text("layer", "NAME",
               "Picture to read if a file holds several, such as view layers of Blender, with its depth and "
               "passes (default: the only one)"),
          in(&PictureChoice::layer)}},
        "Lens", "", PythonCall::open_ldi);
    return rows;
}

ParameterRows<PictureChoice> kind_parameters() {
    static const auto rows = all<PictureChoice>(
        {{text("data", "LAYER,...",
               "Layers or channels to treat as data, such as positions, not as light (default: by their "
               "names; -v lists the kind of each)"),
          in(&PictureChoice::data)},
         {text("light", "LAYER,...",
               "Layers or channels to treat as light, whatever their names (default: none)"),
          in(&PictureChoice::light)}},
        "Colour", "", PythonCall::open_ldi);
    return rows;
}

ParameterRows<PictureChoice> depth_file_parameters() {
    static const auto rows =
        all<PictureChoice>({{text("depth-file", "FILE",
                                  "File with the depth of the picture: a flat EXR of the same size, or a "
                                  "grey PNG, JPEG or TIFF, which is a "
                                  "`disparity`",
                                  Form::file),
                             in(&PictureChoice::depth_file)}},
                           "Lens", "", PythonCall::open_ldi);
    return rows;
}

ParameterRows<DepthOptions> photograph_parameters() {
    static const auto rows = all<DepthOptions>(
        {{flag("disparity",
               "Read the depth as a disparity, white near, 0 to 1 or integers, as programs estimate it from "
               "a photograph (default: only if `depth_file` is not an EXR file)"),
          [](const Parameter &, const std::string &, DepthOptions &options) {
              options.meaning = DepthMeaning::disparity;
              return true;
          }}},
        "Lens", "", PythonCall::open_ldi);
    return rows;
}

ParameterRows<ColourOptions> input_colour_parameters() {
    static const auto rows = all<ColourOptions>(
        {{text("colorconfig", "FILE", "OpenColorIO configuration (default: $OCIO, else the built-in one)",
               Form::file),
          in(&ColourOptions::config)},
         {of_tools(text("colorspace", "SPACE",
                        "Colour space of the input (default: by its chromaticities or colorInteropID, else "
                        "the file rules of the configuration)")),
          in(&ColourOptions::input_space)}},
        "Colour", "", PythonCall::write);
    return rows;
}

ParameterRows<ColourOptions> output_colour_parameters() {
    static const auto rows = all<ColourOptions>(
        {{of_tools(text("output-colorspace", "SPACE",
                        "Colour space of the output (default: that of the input for EXR, else that of the "
                        "display)")),
          in(&ColourOptions::output_space)},
         {text("display", "DISPLAY", "Display for PNG, JPEG and TIFF (default: that of the configuration)"),
          in(&ColourOptions::display)},
         {text("view-transform", "VIEW", "View transform of the display (default: that of the display)"),
          in(&ColourOptions::view)}},
        "Colour", "", PythonCall::write);
    return rows;
}

ParameterRows<WindowOptions> window_parameters() {
    const Parameter filter =
        text("pixel-filter", "box|blackman-harris|gaussian[:WIDTH]",
             "Pixel filter of the picture with `supersample`, and its width in pixels, as in Cycles "
             "(default: as the file says, else box; width 1.5)",
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
               "Make only these pixels of the full-size picture, in EXR coordinates, X1 and Y1 included "
               "(default: all)",
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
                 fmt::format("Method of the gather. {} (default: {})", fmt::join(what, "; "), names.front())),
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
        {on_page(word("quality", {"draft", "normal", "final"},
                      "Quality of the blur: final takes more lens points and more time, draft less (default: "
                      "normal; of a photograph: final)")),
         [](const Parameter &row, const std::string &text, PictureRequest &request) {
             Quality &quality = request.picture.gather.lens.quality;
             const bool is_word = read_place(row, text, quality);
             request.windows.joins_subpixels = quality == Quality::draft;
             request.any_quality = false;
             return is_word;
         }},
        {whole("lens-samples", "N",
               "Number of lens points in every tile; 0: as `quality` and the picture need (default: 0)", 0,
               1 << 20),
         in(picture, gather, &GatherOptions::lens, &LensGatherOptions::lens_samples)},
        {number("layer-tolerance", "PX",
                fmt::format("Merge layers of a pixel whose circles of confusion differ by less than this, in "
                            "pixels; 0: merge none (default: {})",
                            usual.layer_tolerance),
                at_least_0),
         in(picture, &PictureOptions::layer_tolerance)},
        {keyed(
             number("grain", "F",
                    "Noise for what is blurred in a photograph, as a factor of the noise that blur took away "
                    "(default: 1)",
                    at_least_0)),
         in(&PictureRequest::grain)},
        {text("holdout", "DEEP.exr",
              "Deep EXR that hides what is behind it, but is not shown; its edges stay sharp (default: none)",
              Form::ldi),
         in(&PictureRequest::holdout)},
        {flag("holdout-defocused", "Blur the holdout like the rest of the scene (default: keep it sharp)"),
         in(picture, &PictureOptions::holdout_defocused)}};
    const Rows<PictureRequest> selective{
        {whole("layers", "K",
               fmt::format("Largest number of layers in a pixel (default: {})", usual.gather.layers), 1,
               4096),
         in(picture, gather, &GatherOptions::layers)}};
    const Rows<PictureRequest> any{
        {text("device", "", "Device for the methods lens and selective", Form::device),
         in(&PictureRequest::device)},
        {keyed(
             text("focus-pixel", "X,Y",
                  "Focus on the front surface in this pixel, in EXR coordinates; instead of `focus_distance`",
                  Form::pixel, "X,Y in whole pixels (e.g. 320,180)")),
         in(&PictureRequest::focus_pixel)},
        {or_share(keyed(on_page(number("blur", "PX|N%",
                                       "Strongest blur of a photograph with a `disparity`: the radius, in "
                                       "pixels or as a share of the picture's width, of the disc that a "
                                       "white pixel of the depth becomes when black is in focus",
                                       at_least_0)))),
         in(&PictureRequest::blur)},
        {text("shutter-curve", "box|triangle|gaussian|FILE",
              "Weights of the moments of a shutter (%s in IN). FILE: lines of a time, from 0 (opening) to 1 "
              "(closing), and a weight (default: box)",
              Form::file),
         in(&PictureRequest::shutter_curve)},
        {number("rolling-shutter", "D",
                "Part of the shutter's time for which each row is exposed, the top row first, the bottom row "
                "last (default: 1, all rows all the time)",
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
    const Parameter point =
        text("lens-point", "X,Y",
             "Show the picture through this point of the lens alone, X right and Y up of its middle, 1 at "
             "the rim. Areas that no view saw are tinted magenta; unknown areas are black",
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

namespace {

Rows<GivenLooks> numbers_of(std::span<const LookNumber> table) {
    Rows<GivenLooks> rows;
    for (const LookNumber &of : table)
        rows.push_back({on_page(number(of), of.control), in(&GivenLooks::values, of.value)});
    return rows;
}

Rows<GivenLooks> look_rows() {
    Rows<GivenLooks> numbers = numbers_of(look_numbers());
    for (Parameter &row : numbers) row.keyable = true;
    std::vector<std::string> types;
    for (const auto &type : chromatic_types()) types.emplace_back(type.first);
    Parameter tilt = text("tilt", "X,Y",
                          "Tilt of the plane of focus, in degrees; above 0 it is nearer at the right (X) and "
                          "at the top (Y) (default: 0,0)",
                          Form::pair, "two numbers between -89 and 89 degrees (e.g. 10,0)");
    const auto read_tilt = [](const Parameter &row, const std::string &text, GivenLooks &given) {
        Imath::V2d angles;
        if (!read_place(row, text, angles)) return false;
        given.values.tilt_x = angles.x;
        given.values.tilt_y = angles.y;
        return is_tilt(angles.x) && is_tilt(angles.y);
    };
    Parameter preset = text(
        "lens", "FILE", "Lens file with looks (JSON, see share/lenses); options override it (default: none)",
        Form::file);
    preset.control.label = "lens by name"; // a page knows the lenses of share/lenses alone
    const Rows<GivenLooks> lens{{preset, in(&GivenLooks::lens_file)}};
    const Rows<GivenLooks> others{
        {on_page(flag("cat-eye-darkening",
                      "Darken the picture where the cat's eye blocks light (default: keep the exposure)"),
                 {"cat's eye darkens"}),
         in(&GivenLooks::values, &LookValues::cat_eye_darkening)},
        {on_page(word("axial-chromatic-type", types,
                      "Colours that do not focus with green. red-blue: red behind and blue in front; "
                      "blue-yellow: blue in front; green-magenta: red and blue behind (default: red-blue)"),
                 {"fringe colours"}),
         in(&GivenLooks::values, &LookValues::chromatic_type)},
        {keyed(on_page(tilt, {"tilted focus, \u00b0"})), read_tilt},
        {text("aperture", "FILE",
              "Picture of the aperture (EXR, grey or RGB weights), which spans the lens from rim to rim; "
              "instead of blades",
              Form::file),
         in(&GivenLooks::aperture_file)}};
    return joined({all(joined({lens, numbers, others}), "Lens looks", "lens"),
                   all(numbers_of(highlight_numbers()), "Highlights")});
}

} // namespace

ParameterRows<GivenLooks> look_parameters() {
    static const auto rows = look_rows();
    return rows;
}

} // namespace sparselens
