#include "python/looks.h"

#include "base/error.h"
#include "io/aperture_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens::python {

AskedLooks look_keywords(Keywords &keywords) {
    AskedLooks asked;
    const auto note = [&](bool given, const std::string &name) {
        if (given && asked.first.empty()) asked.first = name;
    };
    for (const LookNumber &number : look_numbers()) {
        std::string name = number.name;
        std::ranges::replace(name, '-', '_');
        const auto value = keywords.any_number(name.c_str());
        if (value && !number.valid(*value))
            Keywords::refuse(name.c_str(), number.range, fmt::format("{:g}", *value));
        asked.values.*number.value = value;
        note(value.has_value(), name);
    }
    if (keywords.flag("cat_eye_darkening")) asked.values.cat_eye_darkening = true;
    note(asked.values.cat_eye_darkening.has_value(), "cat_eye_darkening");
    asked.values.chromatic_type = keywords.word<ChromaticType>(
        "axial_chromatic_type", {{"red-blue", ChromaticType::red_blue},
                                 {"blue-yellow", ChromaticType::blue_yellow},
                                 {"green-magenta", ChromaticType::green_magenta}});
    note(asked.values.chromatic_type.has_value(), "axial_chromatic_type");
    if (const auto tilt = keywords.pair("tilt")) {
        if (!is_tilt(tilt->x) || !is_tilt(tilt->y))
            Keywords::refuse("tilt", "two numbers between -89 and 89",
                             fmt::format("({:g}, {:g})", tilt->x, tilt->y));
        asked.values.tilt_x = tilt->x;
        asked.values.tilt_y = tilt->y;
        note(true, "tilt");
    }
    asked.lens_file = keywords.path("lens");
    note(!asked.lens_file.empty(), "lens");
    asked.aperture_file = keywords.path("aperture");
    note(!asked.aperture_file.empty(), "aperture");
    const bool shaped = asked.values.blades || asked.values.curvature || asked.values.rotation;
    if (shaped && !asked.aperture_file.empty())
        throw UsageError("aperture: is given with blades; give one of the two");
    return asked;
}

LensFile read_looks(const AskedLooks &asked, std::optional<double> fstop) {
    LensFile lens;
    if (!asked.lens_file.empty()) lens = read_lens_file(asked.lens_file, fstop);
    LookValues values = asked.values;
    if (!asked.aperture_file.empty()) values.picture = read_aperture_picture(asked.aperture_file);
    lens.values = look_values_over(values, lens.values);
    return lens;
}

} // namespace sparselens::python
