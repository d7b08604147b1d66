#include "chain/parameter_rows.h"

namespace sparselens {

using namespace parameter_rows;

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
                          "Tilt of the plane of focus in degrees; above 0 it is nearer at the right (X) and "
                          "at the top (Y) (default: 0,0)",
                          Form::pair, "two numbers between -89 and 89 degrees (e.g. 10,0)");
    const auto read_tilt = [](const Parameter &row, const std::string &text, GivenLooks &given) {
        Imath::V2d angles;
        if (!read_place(row, text, angles)) return false;
        given.values.tilt_x = angles.x;
        given.values.tilt_y = angles.y;
        return is_tilt(angles.x) && is_tilt(angles.y);
    };
    Parameter preset = text("lens", "FILE",
                            "Lens file with looks (JSON, see share/lenses); options override it", Form::file);
    preset.control.label = "lens by name"; // a page knows the lenses of share/lenses alone
    const Rows<GivenLooks> lens{{preset, in(&GivenLooks::lens_file)}};
    const Rows<GivenLooks> others{
        {on_page(flag("cat-eye-darkening",
                      "Darken the picture where the cat's eye blocks light (default: keep the exposure)"),
                 {"cat's eye darkens"}),
         in(&GivenLooks::values, &LookValues::cat_eye_darkening)},
        {on_page(word("axial-chromatic-type", types,
                      "Colours that focus elsewhere than green. red-blue: red behind and blue in front; "
                      "blue-yellow: blue in front; green-magenta: red and blue behind (default: red-blue)"),
                 {"fringe colours"}),
         in(&GivenLooks::values, &LookValues::chromatic_type)},
        {keyed(on_page(tilt, {"tilted focus, \u00b0"})), read_tilt},
        {text("aperture", "FILE",
              "Picture of the aperture (EXR, grey or RGB weights); its content spans the lens from rim to "
              "rim",
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
