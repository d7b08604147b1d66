#include "options/parameter_options.h"

#include "harness/one_line.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sparselens {

CLI::Validator number(NumberRange range) {
    const auto check = [range](const std::string &text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && range.holds(value)) return {};
        return "'" + text + "' is not " + range.words;
    };
    return CLI::Validator(check, "");
}

void add_parameter(CLI::App &app, const Parameter &row, std::function<bool(const std::string &)> put) {
    if (row.form == ParameterForm::device) return;
    const std::string name = "--" + row.name, help = with_options(row.help);
    const auto read = [&row, name, put](const std::string &text) {
        if (!put(text))
            throw CLI::ValidationError(name, fmt::format("must be {}, not '{}'", row.wanted, text));
    };
    CLI::Option *option = row.form == ParameterForm::flag
                              ? app.add_flag_callback(
                                    name, [put] { put(""); }, help)
                              : app.add_option_function<std::string>(name, read, help)->type_name(row.unit);
    if (row.form == ParameterForm::number) option->check(number(row.range));
    if (row.form == ParameterForm::whole) option->check(CLI::Range(row.least, row.most));
    if (*row.group != '\0') option->group(row.group);
    for (const Parameter *other : picture_parameters())
        if (CLI::Option *there = app.get_option_no_throw("--" + other->name)) {
            if (exclude(row.name, other->name)) option->excludes(there);
            if (needs(row.name, other->name)) option->needs(there);
        }
}

void add_depth_options(CLI::App &app, DepthOptions &options) {
    add_parameters(app, depth_parameters(), options);
    add_parameters(app, choice_parameters(), options.picture);
}

void add_depth_files_option(CLI::App &app, std::vector<std::string> &files) {
    app.add_option("--depth-file", files,
                   "File with the depth of a picture; give one for each picture, in their order")
        ->type_name("FILE.exr")
        ->allow_extra_args(false)
        ->group("Lens");
}

void add_subpixels_option(CLI::App &app, std::optional<int> &across) {
    app.add_option("--supersample", across,
                   "Number of pixels of the files, across and down, that make one pixel of the picture "
                   "(default: as the files say, else 1)")
        ->type_name("N")
        ->check(CLI::Range(1, most_across))
        ->group("Lens");
}

} // namespace sparselens
