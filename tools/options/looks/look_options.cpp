#include "options/looks/look_options.h"

#include "harness/words.h"
#include "io/aperture_file.h"

#include <CLI/CLI.hpp>
#include <Imath/ImathVec.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>

namespace sparselens {

namespace {

constexpr const char *group = "Lens looks";

CLI::Validator look_validator(const LookNumber &number) {
    const auto check = [number](const std::string &text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && number.valid(value)) return {};
        return fmt::format("'{}' is not {}", text, number.range);
    };
    return CLI::Validator(check, "");
}

std::optional<Imath::V2d> parse_degrees(const std::string &text) {
    const std::size_t comma = text.find(',');
    Imath::V2d pair(0, 0);
    const bool read = comma != std::string::npos &&
                      CLI::detail::lexical_cast(text.substr(0, comma), pair.x) &&
                      CLI::detail::lexical_cast(text.substr(comma + 1), pair.y);
    if (!read || !(std::abs(pair.x) <= 89 && std::abs(pair.y) <= 89)) return {};
    return pair;
}

} // namespace

void add_look_options(CLI::App &app, LookOptions &options) {
    app.add_option("--lens", options.lens_file,
                   "Looks of a lens by name (JSON, see share/lenses); options beat them")
        ->type_name("FILE")
        ->group(group);
    for (const LookNumber &number : look_numbers())
        app.add_option(fmt::format("--{}", number.name), options.values.*number.value, number.help)
            ->type_name(number.unit)
            ->group(group)
            ->check(look_validator(number));
    app.add_flag_callback(
           "--cat-eye-darkening", [&options] { options.values.cat_eye_darkening = true; },
           "Let the light be lost that the cat's eye cuts off, rather than count what is left as the whole")
        ->group(group);
    const std::map<std::string, ChromaticType> types{{"red-blue", ChromaticType::red_blue},
                                                     {"blue-yellow", ChromaticType::blue_yellow},
                                                     {"green-magenta", ChromaticType::green_magenta}};
    app.add_option("--axial-chromatic-type", options.values.chromatic_type,
                   "Which colours come to focus elsewhere than green: red behind and blue before it; blue "
                   "before it; red "
                   "and blue behind it (default: red-blue)")
        ->type_name("red-blue|blue-yellow|green-magenta")
        ->group(group)
        ->transform(words(types));
    app.add_option_function<std::string>(
           "--tilt",
           [&options](const std::string &text) {
               const auto pair = parse_degrees(text);
               if (!pair)
                   throw CLI::ValidationError(
                       "--tilt",
                       fmt::format("must be X,Y in degrees between -89 and 89 (e.g. 10,0), not '{}'", text));
               options.values.tilt_x = pair->x;
               options.values.tilt_y = pair->y;
           },
           "Angles of the plane of focus in degrees: above 0 it is nearer to the right (X) and at the top "
           "(Y) "
           "(default: 0,0)")
        ->type_name("X,Y")
        ->group(group);
    app.add_option("--aperture", options.aperture_file,
                   "Picture of the aperture (EXR, grey or RGB weights), from rim to rim of its own content")
        ->type_name("FILE")
        ->group(group)
        ->excludes("--blades")
        ->excludes("--blade-curvature")
        ->excludes("--blade-rotation");
}

std::string first_look_option(const CLI::App &parsed) {
    for (const CLI::Option *option : parsed.get_options())
        if (option->get_group() == group && option->count() > 0) return option->get_name();
    return {};
}

LensFile read_looks(const LookOptions &options, std::optional<double> fstop) {
    LensFile lens;
    if (!options.lens_file.empty()) lens = read_lens_file(options.lens_file, fstop);
    LookValues values = options.values;
    if (!options.aperture_file.empty()) values.picture = read_aperture_picture(options.aperture_file);
    lens.values = look_values_over(values, lens.values);
    return lens;
}

} // namespace sparselens
