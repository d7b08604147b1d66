#include "options/picture_options.h"

#include "base/error.h"
#include "harness/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

namespace sparselens {

std::optional<Imath::V2d> parse_pair(const std::string &text) {
    Imath::V2d pair(0, 0);
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, comma), pair.x) ||
        !CLI::detail::lexical_cast(text.substr(comma + 1), pair.y))
        return {};
    if (!std::isfinite(pair.x) || !std::isfinite(pair.y)) return {};
    return pair;
}

Imath::V2d view_offset(const std::string &text) {
    const auto offset = parse_pair(text);
    if (!offset) throw UsageError(fmt::format("--view: must be X,Y (e.g. 0.05,0), not '{}'", text));
    return *offset;
}

void add_pixel_option(CLI::App &app, const std::string &name, std::optional<Imath::V2i> &pixel,
                      const std::string &help) {
    const auto read = [&pixel, name](const std::string &text) {
        const auto pair = parse_pair(text);
        constexpr double most = 1 << 30;
        const bool whole = pair && std::trunc(pair->x) == pair->x && std::trunc(pair->y) == pair->y;
        if (!whole || std::abs(pair->x) > most || std::abs(pair->y) > most)
            throw CLI::ValidationError(
                name, fmt::format("must be X,Y in whole pixels (e.g. 320,180), not '{}'", text));
        pixel = Imath::V2i(*pair);
    };
    app.add_option_function<std::string>(name, read, help)->type_name("X,Y");
}

void add_method_option(CLI::App &app, const GatherMethod *&method) {
    std::vector<std::string> names;
    for (const GatherMethod &m : gather_methods()) names.emplace_back(m.name);
    const auto read = [&method, names](const std::string &text) {
        for (const GatherMethod &m : gather_methods())
            if (text == m.name) {
                method = &m;
                return;
            }
        throw CLI::ValidationError("--method",
                                   fmt::format("must be one of {}, not '{}'", fmt::join(names, ", "), text));
    };
    app.add_option_function<std::string>("--method", read,
                                         fmt::format("Gather method (default: {})", names.front()))
        ->type_name(fmt::format("{}", fmt::join(names, "|")));
}

void add_type_option(CLI::App &app, bool &as_float) {
    const std::map<std::string, bool> types{{"half", false}, {"float", true}};
    app.add_option("-d", as_float, "Type of the colour channels written (default: half)")
        ->type_name("half|float")
        ->transform(words(types));
}

Image in_type(Image image, bool as_float) {
    for (Channel &channel : image.channels)
        if (as_float && channel.type == PixelType::half) channel.type = PixelType::float32;
    return image;
}

} // namespace sparselens
