#include "options/picture_options.h"

#include "base/error.h"
#include "harness/words.h"

#include <cmath>

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
    if (!offset) throw UsageError("--view: '" + text + "' is not X,Y");
    return *offset;
}

void add_pixel_option(CLI::App &app, const std::string &name, std::optional<Imath::V2i> &pixel,
                      const std::string &help) {
    const auto read = [&pixel, name](const std::string &text) {
        const auto pair = parse_pair(text);
        constexpr double most = 1 << 30;
        const bool whole = pair && std::trunc(pair->x) == pair->x && std::trunc(pair->y) == pair->y;
        if (!whole || std::abs(pair->x) > most || std::abs(pair->y) > most)
            throw CLI::ValidationError(name, "'" + text + "' is not X,Y in whole pixels");
        pixel = Imath::V2i(*pair);
    };
    app.add_option_function<std::string>(name, read, help)->type_name("X,Y");
}

void add_method_option(CLI::App &app, const GatherMethod *&method) {
    std::string names;
    for (const GatherMethod &m : gather_methods()) names += (names.empty() ? "" : "|") + std::string(m.name);
    const auto read = [&method, names](const std::string &text) {
        for (const GatherMethod &m : gather_methods())
            if (text == m.name) {
                method = &m;
                return;
            }
        throw CLI::ValidationError("--method", "'" + text + "' is none of " + names);
    };
    app.add_option_function<std::string>("--method", read, "How to gather")
        ->type_name(names)
        ->default_str(gather_methods().front().name);
}

void add_type_option(CLI::App &app, bool &as_float) {
    const std::map<std::string, bool> types{{"half", false}, {"float", true}};
    app.add_option("-d", as_float, "Type of the colours written (half)")
        ->type_name("half|float")
        ->transform(words(types));
}

Image in_type(Image image, bool as_float) {
    for (Channel &channel : image.channels)
        if (as_float && channel.type == PixelType::half) channel.type = PixelType::float32;
    return image;
}

} // namespace sparselens
