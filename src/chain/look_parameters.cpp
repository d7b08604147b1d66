#include "chain/parameter_rows.h"

#include <algorithm>
#include <array>

namespace sparselens {

using namespace parameter_rows;

namespace {

struct NamedControl {
    std::string_view name;
    PageControl control;
};
constexpr std::array look_controls{NamedControl{"blades", {"blades", 0, 16, 0, 3}},
                                   NamedControl{"blade-curvature", {"blade roundness", 0, 1}},
                                   NamedControl{"blade-rotation", {"blade rotation, \u00b0", -180, 180}},
                                   NamedControl{"squeeze", {"anamorphic squeeze", 0.001, 4, 1}},
                                   NamedControl{"spherical", {"soap bubbles", -1, 1}},
                                   NamedControl{"cat-eye", {"cat's eye", 0, 3}},
                                   NamedControl{"axial-chromatic", {"colour fringes, mm", -5, 5}},
                                   NamedControl{"field-curvature", {"curved focus", -1, 1}},
                                   NamedControl{"astigmatism", {"astigmatism", -1, 1}},
                                   NamedControl{"breathing", {"focus breathing", 0, 2}},
                                   NamedControl{"highlight-gain", {"brighter lights", 1, 50, 1}},
                                   NamedControl{"highlight-threshold", {"lights: above", 0, 20, 1}},
                                   NamedControl{"highlight-knee", {"lights: softness", 0.001, 20, 1}}};

Rows<GivenLooks> numbers_of(std::span<const LookNumber> table) {
    Rows<GivenLooks> rows;
    for (const LookNumber &of : table) {
        const auto found = std::ranges::find(look_controls, of.name, &NamedControl::name);
        const PageControl control = found == look_controls.end() ? PageControl{} : found->control;
        rows.push_back({on_page(number(of), control), in(&GivenLooks::values, of.value)});
    }
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
