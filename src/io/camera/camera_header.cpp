#include "io/camera/camera_header.h"

#include "base/error.h"
#include "io/camera/camera_attributes.h"
#include "io/exr/exr_header.h"
#include "view/lens_views.h"

#include <ImfBoxAttribute.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

namespace sparselens {

namespace {

constexpr const char *projection_parameter = "projection"; // no parameter gives it

std::string text_of(double value) { return fmt::format("{:g}", value); }

// Equal within the rounding of programs.
bool agree(double a, double b) {
    return a == b || std::abs(a - b) <= 0.01 * std::max(std::abs(a), std::abs(b));
}

std::vector<Imath::V2d> read_points(const Imf::Header &header) {
    std::vector<Imath::V2d> points;
    std::istringstream in(text_attribute(header, lens_points_name));
    Imath::V2d p(0, 0);
    char comma = 0;
    while (in >> p.x >> comma >> p.y && comma == ',') points.push_back(p);
    return points;
}

void read_subpixels(const Imf::Header &header, Camera &camera) {
    if (const auto *across = header.findTypedAttribute<Imf::IntAttribute>(supersample_name)) {
        if (across->value() >= 1 && across->value() <= most_across)
            camera.supersample = across->value();
        else
            camera.unsure["supersample"] =
                fmt::format("{} is {}, not from 1 to {}", supersample_name, across->value(), most_across);
    }
    if (const auto *filter = header.findTypedAttribute<Imf::StringAttribute>(pixel_filter_name)) {
        camera.pixel_filter = pixel_filter_of(filter->value());
        if (!camera.pixel_filter)
            camera.unsure["pixel_filter"] = std::string(pixel_filter_name) + " is not a filter that is known";
    }
    if (camera.supersample && *camera.supersample > 1)
        camera.found.push_back(fmt::format("{0} x {0} pixels are one of the picture ({1})",
                                           *camera.supersample, supersample_name));
}

// Builds the camera from its attributes, and notes which attribute gave which value.
class Reader {
public:
    explicit Reader(const CameraAttributes &attributes) : has_(attributes) {}

    Camera read() {
        camera_.metres_per_unit = pick({Quantity::metres_per_unit}, "metres per unit", "scene_unit");
        camera_.fstop = pick({Quantity::fstop}, "f-number", "fstop", true);
        camera_.focus_distance =
            pick({Quantity::focus_units, Quantity::focus_metres}, "focus distance", "focus_distance", true);
        if (!has_.no_perspective.empty()) camera_.unsure[projection_parameter] = has_.no_perspective;
        read_placement();
        read_film();
        read_aperture();
        return std::move(camera_);
    }

private:
    // The value on which the attributes of these quantities agree. Hints are used only if there is nothing else.
    std::optional<double> pick(std::initializer_list<Quantity> quantities, const char *what,
                               const char *parameter, bool may_be_infinite = false);
    double in_unit(const NamedNumber &number) const {
        return number.quantity == Quantity::focus_metres ? number.value / camera_.metres_per_unit.value_or(1)
                                                         : number.value;
    }
    void read_placement();
    void read_film();
    void read_aperture();
    void read_projections();
    void say_orthographic(const NamedMatrix &matrix) {
        camera_.unsure[projection_parameter] = matrix.name + " is orthographic";
    }
    void read_principal_point();

    const CameraAttributes &has_;
    Camera camera_;
};

std::optional<double> Reader::pick(std::initializer_list<Quantity> quantities, const char *what,
                                   const char *parameter, bool may_be_infinite) {
    const NamedNumber *chosen = nullptr;
    for (const bool exact : {true, false})
        for (const NamedNumber &number : has_.numbers) {
            if (number.exact != exact || std::ranges::find(quantities, number.quantity) == quantities.end() ||
                (chosen && chosen->exact != exact))
                continue;
            const double value = in_unit(number);
            if (!(value > 0) || (std::isinf(value) && !may_be_infinite)) {
                camera_.unsure[parameter] = number.name + " is not a valid " + what;
                return {};
            }
            if (chosen && !agree(value, in_unit(*chosen))) {
                camera_.unsure[parameter] = chosen->name + " says " + text_of(in_unit(*chosen)) + ", " +
                                            number.name + " says " + text_of(value);
                return {};
            }
            if (!chosen) chosen = &number;
        }
    if (!chosen) return {};
    camera_.found.push_back(std::string(what) + " " + text_of(in_unit(*chosen)) + " (" + chosen->name + ")");
    return in_unit(*chosen);
}

// A renderer crops its film back to the shape of the picture. The field gives the visible part.
void Reader::read_film() {
    camera_.focal_length_mm = pick({Quantity::focal_length}, "focal length", "focal_length");
    camera_.sensor_width_mm = pick({Quantity::sensor_width}, "sensor width", "sensor_width");
    camera_.field = pick({Quantity::field}, "width of the picture over the focal length", "sensor_width");
    const bool field_unsure = !camera_.field && camera_.unsure.contains("sensor_width");
    read_projections();
    read_principal_point();
    if (!camera_.sensor_width_mm && !(camera_.focal_length_mm && camera_.field) && !field_unsure)
        camera_.sensor_width_mm = pick({Quantity::film_back}, "film back", "sensor_width");
    if (camera_.focal_length_mm && camera_.sensor_width_mm && camera_.field &&
        !agree(*camera_.sensor_width_mm, *camera_.focal_length_mm * *camera_.field)) {
        camera_.unsure["sensor_width"] = "it is said to be " + text_of(*camera_.sensor_width_mm) +
                                         " mm, but focal length and field of view make it " +
                                         text_of(*camera_.focal_length_mm * *camera_.field);
        camera_.sensor_width_mm.reset();
        camera_.field.reset();
    }
    complete_field(camera_);
}

// Reads what the script for Blender writes. Cycles treats one or two blades as none.
void Reader::read_aperture() {
    const auto pick_look = [&](Quantity quantity) -> std::optional<double> {
        for (const NamedNumber &number : has_.numbers)
            if (number.quantity == quantity && std::isfinite(number.value)) return number.value;
        return {};
    };
    LookValues &looks = camera_.looks;
    looks.blades = pick_look(Quantity::blades);
    if (looks.blades && (*looks.blades < 3 || *looks.blades > 16)) looks.blades = 0;
    looks.rotation = pick_look(Quantity::blade_rotation);
    looks.squeeze = pick_look(Quantity::squeeze);
    for (const LookNumber &number : look_numbers())
        if (auto &value = looks.*number.value; value && !number.range.holds(*value)) value.reset();
    if (looks.blades && *looks.blades > 0)
        camera_.found.push_back(text_of(*looks.blades) + " blades (aperture_blades)");
    if (looks.squeeze && *looks.squeeze != 1)
        camera_.found.push_back("squeeze " + text_of(*looks.squeeze) + " (aperture_ratio)");
}

void Reader::read_placement() {
    const NamedMatrix *chosen = nullptr;
    for (const NamedMatrix &matrix : has_.matrices) {
        if (matrix.kind != NamedMatrix::Kind::world_to_camera) continue;
        if (!matrix.matrix) {
            camera_.unsure["view"] = matrix.name + " is not a valid camera position";
            return;
        }
        const auto place = [](const NamedMatrix &m) { return m.matrix->inverse().translation(); };
        if (chosen && (place(matrix) - place(*chosen)).length() > 1e-3 * place(matrix).length()) {
            camera_.unsure["view"] = chosen->name + " and " + matrix.name + " give different positions";
            return;
        }
        if (!chosen) chosen = &matrix;
    }
    if (!chosen) return;
    camera_.world_to_camera = chosen->matrix;
    camera_.found.push_back("position (" + chosen->name + ")");
}

void Reader::read_projections() {
    for (const NamedMatrix &matrix : has_.matrices) {
        if (matrix.kind != NamedMatrix::Kind::world_to_ndc || !matrix.matrix || camera_.world_to_ndc)
            continue;
        if (has_.ours) {
            camera_.world_to_ndc = matrix.matrix;
            continue;
        }
        if (!camera_.world_to_camera) {
            if (is_orthographic(*matrix.matrix)) say_orthographic(matrix);
            continue;
        }
        std::optional<double> field = camera_.field;
        if (!field && camera_.focal_length_mm && camera_.sensor_width_mm)
            field = *camera_.sensor_width_mm / *camera_.focal_length_mm;
        const auto projection =
            read_projection(*matrix.matrix, *camera_.world_to_camera, {matrix.certain, field});
        if (!projection &&
            (is_orthographic(*matrix.matrix) || is_orthographic(matrix.matrix->transposed()))) {
            say_orthographic(matrix);
            return;
        }
        if (!projection || (field && !agree(*field, projection->field))) {
            camera_.unsure["sensor_width"] =
                projection ? matrix.name + " makes the picture " + text_of(projection->field) +
                                 " focal lengths wide, other attributes " + text_of(*field)
                           : matrix.name + " is not a projection of the camera at that position";
            camera_.sensor_width_mm.reset();
            camera_.field.reset();
            return;
        }
        camera_.world_to_ndc = projection->world_to_ndc;
        camera_.field = projection->field;
        camera_.found.push_back("width of the picture over the focal length " + text_of(projection->field) +
                                " (" + matrix.name + ")");
        if (projection->looks_backward)
            for (int row = 0; row < 4; ++row) (*camera_.world_to_camera)[row][2] *= -1;
    }
}

void Reader::read_principal_point() {
    std::optional<Frustum> frustum;
    if (camera_.world_to_ndc && camera_.world_to_camera)
        frustum = frustum_of(*camera_.world_to_ndc, *camera_.world_to_camera);
    camera_.principal_point = frustum ? frustum->principal_point : has_.principal_point;
    if (!camera_.principal_point) return;
    Imath::V2d &point = *camera_.principal_point;
    constexpr double rounding = 4e-6; // see framing_relative_to()
    if (point.length() < rounding)
        point = {0, 0};
    else
        camera_.found.push_back("optical axis " + text_of(point.x) + "," + text_of(point.y) +
                                " picture widths right of and below the middle (" +
                                (frustum ? "worldToNDC" : "screenWindowCenter") + ")");
}

} // namespace

Camera read_camera(const Imf::Header &header) {
    const CameraAttributes attributes = find_camera_attributes(header);
    Camera camera = Reader(attributes).read();
    camera.lens_points = read_points(header);
    read_subpixels(header, camera);
    return camera;
}

Camera read_perspective_camera(const Imf::Header &header, const std::string &name) {
    Camera camera = read_camera(header);
    if (const auto why = camera.unsure.find(projection_parameter); why != camera.unsure.end())
        throw Error(fmt::format(
            "{}: its camera has no perspective ({}): render it with a perspective camera, or remove "
            "the attribute if it is wrong",
            name, why->second));
    return camera;
}

Imath::Box2i read_picture_window(const Imf::Header &header) {
    const Imath::Box2i &data = header.dataWindow();
    const auto *a = header.findTypedAttribute<Imf::Box2iAttribute>(picture_window_name);
    if (!a || a->value().isEmpty() || !data.intersects(a->value().min) || !data.intersects(a->value().max))
        return data;
    return a->value();
}

namespace {

constexpr const char *focal_length_name = "pinholeFocalLength";     // mm
constexpr const char *sensor_width_name = "sparselens:sensorWidth"; // mm
constexpr const char *metres_per_unit_name = "sparselens:metresPerUnit";
constexpr const char *version_name = "sparselens:version";

std::string points_text(const std::vector<Imath::V2d> &points) {
    std::string text;
    for (const Imath::V2d &p : points) {
        char item[64];
        std::snprintf(item, sizeof item, "%s%.9g,%.9g", text.empty() ? "" : " ", p.x, p.y);
        text += item;
    }
    return text;
}

} // namespace

void write_camera(Imf::Header &header, const Camera &camera) {
    const auto put = [&](const char *name, const auto &value, const auto &as_attribute) {
        if (value) set_attribute(header, name, as_attribute(*value));
    };
    const auto as_float = [](double value) { return Imf::FloatAttribute(float(value)); };
    const auto as_double = [](double value) { return Imf::DoubleAttribute(value); };
    const auto as_matrix = [](const Imath::M44d &value) { return Imf::M44fAttribute(Imath::M44f(value)); };
    const double metres_per_unit = camera.metres_per_unit.value_or(1);
    put(focal_length_name, camera.focal_length_mm, as_float);
    put(sensor_width_name, camera.sensor_width_mm, as_double);
    put(metres_per_unit_name, camera.metres_per_unit, as_double);
    put("aperture", camera.fstop, as_float);
    put("focus", camera.focus_distance, [&](double units) { return as_float(units * metres_per_unit); });
    put("aperture_blades", camera.looks.blades, [](double v) { return Imf::IntAttribute(int(v)); });
    put("aperture_rotation", camera.looks.rotation,
        [&](double degrees) { return as_float(degrees * std::numbers::pi / 180); });
    put("aperture_ratio", camera.looks.squeeze, as_float);
    put("worldToCamera", camera.world_to_camera, as_matrix);
    put("worldToNDC", camera.world_to_ndc, as_matrix);
    put(supersample_name, camera.supersample, [](int across) { return Imf::IntAttribute(across); });
    put(pixel_filter_name, camera.pixel_filter,
        [](const PixelFilter &filter) { return Imf::StringAttribute(text_of(filter)); });
    if (!camera.lens_points.empty())
        set_attribute(header, lens_points_name, Imf::StringAttribute(points_text(camera.lens_points)));
    set_attribute(header, version_name, Imf::StringAttribute(SPARSELENS_VERSION));
}

void write_picture_camera(Imf::Header &header, Camera camera) {
    camera.supersample.reset();
    camera.pixel_filter.reset();
    for (const char *name : {supersample_name, pixel_filter_name, picture_window_name})
        header = without_attribute(header, name);
    write_camera(header, camera);
}

void write_picture_window(Imf::Header &header, const Imath::Box2i &window) {
    set_attribute(header, picture_window_name, Imf::Box2iAttribute(window));
}

} // namespace sparselens
