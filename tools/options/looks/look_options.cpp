#include "options/looks/look_options.h"

#include "io/aperture_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

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

} // namespace

void add_look_options(CLI::App &app, LookOptions &options) {
    for (const LookNumber &number : look_numbers())
        app.add_option(fmt::format("--{}", number.name), options.values.*number.value, number.help)
            ->type_name(number.unit)
            ->group(group)
            ->check(look_validator(number));
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

LookValues read_looks(const LookOptions &options) {
    LookValues values = options.values;
    if (!options.aperture_file.empty()) values.picture = read_aperture_picture(options.aperture_file);
    return values;
}

} // namespace sparselens
