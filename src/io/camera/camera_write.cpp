#include "io/camera/camera_write.h"

#include "io/camera/camera_attributes.h"
#include "io/exr/header_values.h"

#include <ImfBoxAttribute.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>

#include <cstdio>
#include <numbers>

namespace sparselens {

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
