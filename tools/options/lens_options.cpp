#include "options/lens_options.h"

#include "harness/words.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>

#include <map>

namespace sparselens {

CLI::Validator number(NumberRange range) {
    const auto check = [range](const std::string &text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && range.holds(value)) return {};
        return "'" + text + "' is not " + range.words;
    };
    return CLI::Validator(check, "");
}

void add_lens_options(CLI::App &app, LensValues &options) {
    for (const NumberParameter<LensValues> &number : lens_numbers())
        add_number(app, number, options)->group("Lens");
    app.get_option("--lens-radius")->excludes("--fstop");
}

void add_subpixels_option(CLI::App &app, std::optional<int> &across) {
    app.add_option("--supersample", across,
                   "Number of pixels of the files, across and down, that make one pixel of the picture "
                   "(default: as the files say, else 1)")
        ->type_name("N")
        ->check(CLI::Range(1, most_across))
        ->group("Lens");
}

void add_depth_options(CLI::App &app, DepthOptions &options) {
    const std::map<std::string, DepthMeaning> meanings{{"z", DepthMeaning::planar},
                                                       {"distance", DepthMeaning::distance},
                                                       {"inverse", DepthMeaning::inverse},
                                                       {"negative", DepthMeaning::negative},
                                                       {"normalized", DepthMeaning::normalized},
                                                       {"hyperbolic", DepthMeaning::hyperbolic}};
    app.add_option("--depth", options.meaning,
                   "Kind of depth. z: planar; distance: from the camera along the ray; inverse: 1 / z; "
                   "negative: -z; normalized: 0 at --near to 1 at --far (if near is white, --near is the "
                   "larger); hyperbolic: the same, but linear in 1 / z, as in a depth buffer (default: z)")
        ->type_name("z|distance|inverse|negative|normalized|hyperbolic")
        ->transform(words(meanings))
        ->group("Lens");
    app.add_option(
           "--near", options.near,
           "With --depth normalized and hyperbolic, the depth of 0 (default: the near attribute of the file)")
        ->type_name("D")
        ->check(number(above_0_or_inf))
        ->group("Lens");
    app.add_option("--far", options.far,
                   "Depths beyond this are sky; with --depth normalized and hyperbolic, the depth of 1 "
                   "(default: 1e10)")
        ->type_name("D")
        ->check(number(above_0_or_inf))
        ->group("Lens");
    app.add_option(
           "--depth-channel", options.picture.depth,
           "Depth channel of the picture, or of --depth-file (default: Z, depth.Z, *.Depth.Z or the like)")
        ->type_name("NAME")
        ->group("Lens");
    add_picture_choice(app, options.picture);
}

void add_depth_file_option(CLI::App &app, std::string &file) {
    app.add_option("--depth-file", file, "File with the depth of the picture (EXR, flat, of the same size)")
        ->type_name("FILE.exr")
        ->group("Lens");
}

void add_depth_files_option(CLI::App &app, std::vector<std::string> &files) {
    app.add_option("--depth-file", files,
                   "File with the depth of a picture; give one for each picture, in their order")
        ->type_name("FILE.exr")
        ->allow_extra_args(false)
        ->group("Lens");
}

void add_picture_choice(CLI::App &app, PictureChoice &picture) {
    app.add_flag(
           "--unpremultiplied", picture.unpremultiplied,
           "Multiply the colours of the input by its coverage (A); the default expects multiplied colours")
        ->group("Colour");
    app.add_option("--stereo-view", picture.stereo_view,
                   "Stereo view to read, e.g. right (default: the file's first)")
        ->type_name("NAME")
        ->group("Lens");
    app.add_option("--layer", picture.layer,
                   "Picture to read if a file holds several, such as view layers of Blender, with its depth "
                   "and passes (default: the only one)")
        ->type_name("NAME")
        ->group("Lens");
}

namespace {

constexpr const char *looks_group = "Lens looks";

} // namespace

void add_look_options(CLI::App &app, GivenLooks &given) {
    app.add_option("--lens", given.lens_file,
                   "Lens file with looks (JSON, see share/lenses); options override it")
        ->type_name("FILE")
        ->group(looks_group);
    for (const LookNumber &number : look_numbers()) add_number(app, number, given.values)->group(looks_group);
    app.add_flag_callback(
           "--cat-eye-darkening", [&given] { given.values.cat_eye_darkening = true; },
           "Darken the picture where the cat's eye blocks light (default: keep the exposure)")
        ->group(looks_group);
    const auto types = chromatic_types();
    app.add_option("--axial-chromatic-type", given.values.chromatic_type,
                   "Colours that focus elsewhere than green. red-blue: red behind and blue in front; "
                   "blue-yellow: blue in front; green-magenta: red and blue behind (default: red-blue)")
        ->type_name("red-blue|blue-yellow|green-magenta")
        ->group(looks_group)
        ->transform(words(std::map<std::string, ChromaticType>(types.begin(), types.end())));
    app.add_option_function<std::string>(
           "--tilt",
           [&given](const std::string &text) {
               const auto pair = parse_pair(text);
               if (!pair || !is_tilt(pair->x) || !is_tilt(pair->y))
                   throw CLI::ValidationError(
                       "--tilt",
                       fmt::format("must be X,Y in degrees between -89 and 89 (e.g. 10,0), not '{}'", text));
               given.values.tilt_x = pair->x;
               given.values.tilt_y = pair->y;
           },
           "Tilt of the plane of focus in degrees; above 0 it is nearer at the right (X) and at the top (Y) "
           "(default: 0,0)")
        ->type_name("X,Y")
        ->group(looks_group);
    app.add_option(
           "--aperture", given.aperture_file,
           "Picture of the aperture (EXR, grey or RGB weights); its content spans the lens from rim to rim")
        ->type_name("FILE")
        ->group(looks_group)
        ->excludes("--blades")
        ->excludes("--blade-curvature")
        ->excludes("--blade-rotation");
}

void add_highlight_options(CLI::App &app, GivenLooks &given) {
    CLI::Option *gain = nullptr;
    for (const LookNumber &number : highlight_numbers()) {
        CLI::Option *option = add_number(app, number, given.values)->group("Highlights");
        if (gain)
            option->needs(gain);
        else
            gain = option;
    }
}

} // namespace sparselens
