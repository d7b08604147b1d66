#include "python/looks.h"

#include "base/error.h"

#include <fmt/format.h>

namespace sparselens::python {

AskedLooks look_keywords(Keywords &keywords) {
    AskedLooks asked;
    GivenLooks &given = asked.given;
    LookValues &values = given.values;
    const auto note = [&](bool is_given, const std::string &name) {
        if (is_given && asked.first.empty()) asked.first = name;
    };
    asked.first = keywords.numbers_of(look_numbers(), values);
    if (keywords.flag("cat_eye_darkening")) values.cat_eye_darkening = true;
    note(values.cat_eye_darkening.has_value(), "cat_eye_darkening");
    values.chromatic_type = keywords.word("axial_chromatic_type", chromatic_types());
    note(values.chromatic_type.has_value(), "axial_chromatic_type");
    if (const auto tilt = keywords.pair("tilt")) {
        if (!is_tilt(tilt->x) || !is_tilt(tilt->y))
            Keywords::refuse("tilt", "two numbers between -89 and 89",
                             fmt::format("({:g}, {:g})", tilt->x, tilt->y));
        values.tilt_x = tilt->x;
        values.tilt_y = tilt->y;
        note(true, "tilt");
    }
    given.lens_file = keywords.path("lens");
    note(!given.lens_file.empty(), "lens");
    given.aperture_file = keywords.path("aperture");
    note(!given.aperture_file.empty(), "aperture");
    const bool shaped = values.blades || values.curvature || values.rotation;
    if (shaped && !given.aperture_file.empty())
        throw UsageError("aperture: is given with blades; give one of the two");
    return asked;
}

} // namespace sparselens::python
