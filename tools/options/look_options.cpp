#include "options/look_options.h"

#include "harness/words.h"
#include "options/lens_options.h"

#include <CLI/CLI.hpp>
#include <Imath/ImathVec.h>
#include <fmt/format.h>

#include <map>
#include <optional>

namespace sparselens {

namespace {

constexpr const char *group = "Lens looks";

std::optional<Imath::V2d> parse_degrees(const std::string &text) {
    const std::size_t comma = text.find(',');
    Imath::V2d pair(0, 0);
    const bool read = comma != std::string::npos &&
                      CLI::detail::lexical_cast(text.substr(0, comma), pair.x) &&
                      CLI::detail::lexical_cast(text.substr(comma + 1), pair.y);
    if (!read || !is_tilt(pair.x) || !is_tilt(pair.y)) return {};
    return pair;
}

} // namespace

void add_look_options(CLI::App &app, GivenLooks &given) {
    app.add_option("--lens", given.lens_file,
                   "Lens file with looks (JSON, see share/lenses); options override it")
        ->type_name("FILE")
        ->group(group);
    for (const LookNumber &number : look_numbers()) add_number(app, number, given.values)->group(group);
    app.add_flag_callback(
           "--cat-eye-darkening", [&given] { given.values.cat_eye_darkening = true; },
           "Darken the picture where the cat's eye blocks light (default: keep the exposure)")
        ->group(group);
    const auto types = chromatic_types();
    app.add_option("--axial-chromatic-type", given.values.chromatic_type,
                   "Colours that focus elsewhere than green. red-blue: red behind and blue in front; "
                   "blue-yellow: blue in front; green-magenta: red and blue behind (default: red-blue)")
        ->type_name("red-blue|blue-yellow|green-magenta")
        ->group(group)
        ->transform(words(std::map<std::string, ChromaticType>(types.begin(), types.end())));
    app.add_option_function<std::string>(
           "--tilt",
           [&given](const std::string &text) {
               const auto pair = parse_degrees(text);
               if (!pair)
                   throw CLI::ValidationError(
                       "--tilt",
                       fmt::format("must be X,Y in degrees between -89 and 89 (e.g. 10,0), not '{}'", text));
               given.values.tilt_x = pair->x;
               given.values.tilt_y = pair->y;
           },
           "Tilt of the plane of focus in degrees; above 0 it is nearer at the right (X) and at the top (Y) "
           "(default: 0,0)")
        ->type_name("X,Y")
        ->group(group);
    app.add_option(
           "--aperture", given.aperture_file,
           "Picture of the aperture (EXR, grey or RGB weights); its content spans the lens from rim to rim")
        ->type_name("FILE")
        ->group(group)
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
