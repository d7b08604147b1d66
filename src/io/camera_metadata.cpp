#include "io/camera_metadata.h"

#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <cmath>
#include <cstdio>
#include <sstream>

namespace sparselens {

namespace {

constexpr const char *focal_length_name = "pinholeFocalLength";     // mm
constexpr const char *sensor_width_name = "sparselens:sensorWidth"; // mm
constexpr const char *metres_per_unit_name = "sparselens:metresPerUnit";
constexpr const char *lens_points_name = "sparselens:lensPoints"; // "x,y x,y ...", scene units
constexpr const char *version_name = "sparselens:version";

// A number above 0 (infinity where it can be meant) or nothing: a header may hold anything.
std::optional<double> positive(std::optional<double> value, bool infinity_allowed = false) {
    if (!value || !(*value > 0)) return {};
    if (std::isinf(*value) && !infinity_allowed) return {};
    return value;
}

std::optional<double> number(const Imf::Header &header, const char *name) {
    if (const auto *a = header.findTypedAttribute<Imf::FloatAttribute>(name)) return double(a->value());
    if (const auto *a = header.findTypedAttribute<Imf::DoubleAttribute>(name)) return a->value();
    return {};
}

// Distances are computed with, so they keep more than a float's digits where they are ours.
void put(Imf::Header &header, const char *name, const std::optional<double> &value) {
    if (value) header.insert(name, Imf::DoubleAttribute(*value));
}

std::optional<Imath::M44d> matrix(const Imf::Header &header, const char *name) {
    if (const auto *a = header.findTypedAttribute<Imf::M44fAttribute>(name)) return Imath::M44d(a->value());
    if (const auto *a = header.findTypedAttribute<Imf::M44dAttribute>(name)) return a->value();
    return {};
}

std::vector<Imath::V2d> read_points(const Imf::Header &header) {
    std::vector<Imath::V2d> points;
    const auto *text = header.findTypedAttribute<Imf::StringAttribute>(lens_points_name);
    std::istringstream in(text ? text->value() : std::string());
    Imath::V2d p(0, 0);
    char comma = 0;
    while (in >> p.x >> comma >> p.y && comma == ',') points.push_back(p);
    return points;
}

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

Camera read_camera(const Imf::Header &header) {
    Camera camera;
    camera.focal_length_mm = positive(number(header, focal_length_name));
    camera.sensor_width_mm = positive(number(header, sensor_width_name));
    camera.metres_per_unit = positive(number(header, metres_per_unit_name));
    if (Imf::hasAperture(header)) camera.fstop = positive(double(Imf::aperture(header)), true);
    if (Imf::hasFocus(header)) {
        camera.focus_distance = positive(double(Imf::focus(header)), true);
        if (camera.focus_distance) *camera.focus_distance /= camera.metres_per_unit.value_or(1);
    }
    camera.world_to_camera = matrix(header, "worldToCamera");
    camera.world_to_ndc = matrix(header, "worldToNDC");
    camera.lens_points = read_points(header);
    return camera;
}

void write_camera(Imf::Header &header, const Camera &camera) {
    if (camera.focal_length_mm)
        header.insert(focal_length_name, Imf::FloatAttribute(float(*camera.focal_length_mm)));
    put(header, sensor_width_name, camera.sensor_width_mm);
    put(header, metres_per_unit_name, camera.metres_per_unit);
    if (camera.fstop) Imf::addAperture(header, float(*camera.fstop));
    if (camera.focus_distance)
        Imf::addFocus(header, float(*camera.focus_distance * camera.metres_per_unit.value_or(1)));
    if (camera.world_to_camera) Imf::addWorldToCamera(header, Imath::M44f(*camera.world_to_camera));
    if (camera.world_to_ndc) Imf::addWorldToNDC(header, Imath::M44f(*camera.world_to_ndc));
    if (!camera.lens_points.empty())
        header.insert(lens_points_name, Imf::StringAttribute(points_text(camera.lens_points)));
    header.insert(version_name, Imf::StringAttribute(SPARSELENS_VERSION));
}

} // namespace sparselens
