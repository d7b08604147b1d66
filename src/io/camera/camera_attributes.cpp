#include "io/camera/camera_attributes.h"

#include "io/exr/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace sparselens {

namespace {

using Numbers = std::vector<double>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double number(const Numbers &v) { return v.empty() ? nan : v[0]; }
double degrees_of(const Numbers &v) { return number(v) * 180 / std::numbers::pi; }
double field_of_degrees(const Numbers &v) {
    const double angle = number(v);
    return angle > 0 && angle < 180 ? 2 * std::tan(angle * std::numbers::pi / 360) : nan;
}
// Redshift's documentation says radians, but its files hold degrees. No camera has a field of less than 3.2 degrees.
double field_of_either(const Numbers &v) {
    const double angle = number(v);
    return field_of_degrees({angle < std::numbers::pi ? angle * 180 / std::numbers::pi : angle});
}
// Redshift gives the film back in the host's unit, which is inches in Maya. No film back is under 5 mm, or over 5
// inches.
double inches_or_mm(const Numbers &v) { return number(v) < 5 ? number(v) * 25.4 : number(v); }
// Programs without a camera write 1, which means nothing.
double screen_window(const Numbers &v) { return number(v); }
double field_of_35mm(const Numbers &v) { return 36 / number(v); }

struct NumberName {
    const char *name; // a * stands for one part between slashes
    Quantity quantity;
    double (*read)(const Numbers &);
    bool exact = true;
};

constexpr std::array number_names{
    // ours, and the standard's
    NumberName{"sparselens:metresPerUnit", Quantity::metres_per_unit, number},
    NumberName{"sparselens:sensorWidth", Quantity::sensor_width, number},
    NumberName{"pinholeFocalLength", Quantity::focal_length, number},
    NumberName{"aperture", Quantity::fstop, number},
    NumberName{"focus", Quantity::focus_metres, number},
    NumberName{"aperture_blades", Quantity::blades, number},
    NumberName{"aperture_rotation", Quantity::blade_rotation, degrees_of},
    NumberName{"aperture_ratio", Quantity::squeeze, number},
    NumberName{"screenWindowWidth", Quantity::field, screen_window},
    // V-Ray: film back and focal length in mm, the field of view (degrees) of the picture's width
    NumberName{"cameraFocalLength", Quantity::focal_length,
               number}, // Arnold in Maya spells it CameraFocalLength
    NumberName{"cameraAperture", Quantity::film_back, number},
    NumberName{"cameraFov", Quantity::field, field_of_degrees},
    NumberName{"cameraFNumber", Quantity::fstop, number},
    // Arnold
    NumberName{"CameraFilmApertureHorizontal", Quantity::film_back, number},
    // Redshift
    NumberName{"rs/camera/fov", Quantity::field, field_of_either},
    NumberName{"rs/camera/aperture", Quantity::film_back, inches_or_mm},
    NumberName{"rs/camera/FStop", Quantity::fstop, number},
    NumberName{"rs/camera/DOFFocusDistance", Quantity::focus_units, number},
    // Unreal, Movie Render Queue and Movie Render Graph: texts, distances in centimetres, its scene unit
    NumberName{"unreal/camera/*/focalLength", Quantity::focal_length, number},
    NumberName{"unreal/camera/*/sensorWidth", Quantity::sensor_width, number},
    NumberName{"unreal/camera/*/fstop", Quantity::fstop, number},
    NumberName{"unreal/camera/*/focalDistance", Quantity::focus_units, number},
    NumberName{"unreal/camera/*/fov", Quantity::field, field_of_degrees},
    NumberName{"unreal/layerData/*/focalLength", Quantity::focal_length, number},
    NumberName{"unreal/layerData/*/sensorWidth", Quantity::sensor_width, number},
    NumberName{"unreal/layerData/*/fstop", Quantity::fstop, number},
    NumberName{"unreal/layerData/*/focalDistance", Quantity::focus_units, number},
    NumberName{"unreal/layerData/*/fov", Quantity::field, field_of_degrees},
    // What cameras and other programs state about themselves; used only if there is nothing better
    NumberName{"effectiveFocalLength", Quantity::focal_length, number, false},
    NumberName{"nominalFocalLength", Quantity::focal_length, number, false},
    NumberName{"Exif:FocalLength", Quantity::focal_length, number, false},
    NumberName{"Exif:FocalLengthIn35mmFilm", Quantity::field, field_of_35mm, false},
    NumberName{"FNumber", Quantity::fstop, number, false},
    NumberName{"Exif:FNumber", Quantity::fstop, number, false},
    NumberName{"Exif:SubjectDistance", Quantity::focus_metres, number, false},
    NumberName{"sensorOverallDimensions", Quantity::film_back, number, false},
};

// How the axes of the camera lie in the file: the rows are our right, up and forward in the file's axes.
const Imath::M44d looking_forward; // as in the standard
const Imath::M44d looking_backward(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
// V-Ray for Maya: y points backward and z down.
const Imath::M44d vray_maya(1, 0, 0, 0, 0, 0, -1, 0, 0, -1, 0, 0, 0, 0, 0, 1);

struct MatrixName {
    const char *name;
    enum Meaning { world_to_camera, camera_to_world, world_to_ndc, world_to_clip } meaning;
};

constexpr std::array matrix_names{
    MatrixName{"worldToCamera", MatrixName::world_to_camera}, // worldtocamera in OpenImageIO
    MatrixName{"Nl", MatrixName::world_to_camera},            // RenderMan
    MatrixName{"dtex/nl", MatrixName::world_to_camera},
    MatrixName{"cameraTransform", MatrixName::camera_to_world}, // V-Ray
    MatrixName{"rs/camera/transform", MatrixName::camera_to_world},
    MatrixName{"worldToNDC", MatrixName::world_to_ndc},
    MatrixName{"worldToScreen", MatrixName::world_to_clip}, // worldtoscreen in OpenImageIO
    MatrixName{"NP", MatrixName::world_to_clip},            // RenderMan
    MatrixName{"dtex/np", MatrixName::world_to_clip},
};

std::optional<Imath::M44d> matrix_of(const Numbers &v) {
    if (v.size() != 16 || !std::ranges::all_of(v, [](double x) { return std::isfinite(x); })) return {};
    Imath::M44d m;
    for (std::size_t i = 0; i < 16; ++i) m[int(i / 4)][int(i % 4)] = v[i];
    return m;
}

std::optional<Imath::M44d> inverse(const Imath::M44d &m) {
    try {
        return m.inverse(true);
    } catch (const std::exception &) { // Imath has its own exception for singular matrices
        return {};
    }
}

// A placement that may be stored transposed: the translation belongs in the last row.
Imath::M44d upright(const Imath::M44d &m) {
    const auto is_affine = [](const Imath::M44d &a) {
        return a[0][3] == 0 && a[1][3] == 0 && a[2][3] == 0 && a[3][3] != 0;
    };
    return !is_affine(m) && is_affine(m.transposed()) ? m.transposed() : m;
}

bool vray_was_in_maya(const std::vector<HeaderValue> &values) {
    const HeaderValue *version = find_value(values, "vrayInfo/vrayversion");
    return version && version->text.find("Maya") != std::string::npos;
}

const Imath::M44d &axes_of(const std::string &name, const std::vector<HeaderValue> &values) {
    if (name != "cameraTransform") return looking_forward;
    return vray_was_in_maya(values) ? vray_maya : looking_backward;
}

NamedMatrix read_matrix(const MatrixName &name, const HeaderValue &entry,
                        const std::vector<HeaderValue> &values) {
    using enum NamedMatrix::Kind;
    std::optional<Imath::M44d> matrix = matrix_of(entry.numbers);
    if (name.meaning == MatrixName::world_to_ndc || name.meaning == MatrixName::world_to_clip)
        return {world_to_ndc, entry.name, matrix, name.meaning == MatrixName::world_to_clip};
    if (matrix) matrix = upright(*matrix);
    if (matrix && !inverse(*matrix)) matrix.reset();
    if (name.meaning == MatrixName::world_to_camera) return {world_to_camera, entry.name, matrix, false};
    if (matrix) matrix = inverse(axes_of(name.name, values) * *matrix);
    return {world_to_camera, entry.name, matrix, true};
}

// Unreal: forward, right and up from pitch, yaw and roll (degrees) about its axes x forward, y right, z up.
std::optional<NamedMatrix> unreal_placement(const std::vector<HeaderValue> &values) {
    for (const std::string base : {"unreal/camera/", "unreal/layerData/*/"}) {
        std::array<double, 6> v{};
        std::size_t known = 0;
        for (const char *part :
             {"curPos/x", "curPos/y", "curPos/z", "curRot/pitch", "curRot/yaw", "curRot/roll"})
            if (const HeaderValue *entry = find_value(values, (base + part).c_str()))
                v[known++] = number(entry->numbers);
        if (known == 0) continue;
        NamedMatrix found{NamedMatrix::Kind::world_to_camera, base + "curPos", {}, true};
        if (known < v.size() || !std::ranges::all_of(v, [](double x) { return std::isfinite(x); }))
            return found;
        const double degree = std::numbers::pi / 180;
        const double sp = std::sin(v[3] * degree), cp = std::cos(v[3] * degree);
        const double sy = std::sin(v[4] * degree), cy = std::cos(v[4] * degree);
        const double sr = std::sin(v[5] * degree), cr = std::cos(v[5] * degree);
        const Imath::V3d forward(cp * cy, cp * sy, sp);
        const Imath::V3d right(sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, -sr * cp);
        const Imath::V3d up(-(cr * sp * cy + sr * sy), cy * sr - cr * sp * sy, cr * cp);
        found.matrix = inverse(Imath::M44d(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, forward.x,
                                           forward.y, forward.z, 0, v[0], v[1], v[2], 1));
        return found;
    }
    return {};
}

// sensorPhotositePitch (microns) times the width of sensorAcquisitionRectangle, mm.
std::optional<NamedNumber> acquired_width(const std::vector<HeaderValue> &values) {
    const HeaderValue *pitch = find_value(values, "sensorPhotositePitch"),
                      *box = find_value(values, "sensorAcquisitionRectangle");
    if (!pitch || !box) return {};
    const Numbers corners = box->numbers;
    const double photosites = corners.size() == 4 ? corners[2] - corners[0] + 1 : nan;
    return NamedNumber{Quantity::sensor_width, pitch->name, number(pitch->numbers) / 1000 * photosites, true};
}

// The screen window lies at depth 1 of the camera space, x right, y up; the optical axis meets it at (0,0).
std::optional<Imath::V2d> by_screen_window(const Imf::Header &header) {
    const Imath::V2d centre(header.screenWindowCenter());
    const double width = double(header.screenWindowWidth());
    const Imath::V2d point(-centre.x / width, centre.y / width);
    const bool sound = width > 0 && std::isfinite(point.x) && std::isfinite(point.y);
    return sound && centre != Imath::V2d(0, 0) ? std::optional(point) : std::nullopt;
}

// The standard marks panoramas. V-Ray numbers its projections; 0 is perspective.
std::string other_projection(const Imf::Header &header, const std::vector<HeaderValue> &values) {
    if (header.find("envmap") != header.end()) return "envmap says that it is a panorama";
    const HeaderValue *vray = find_value(values, "cameraProjection");
    const double kind = vray ? number(vray->numbers) : 0;
    return kind > 0 ? fmt::format("{} is {:g}, and perspective is 0", vray->name, kind) : "";
}

// The names that write_camera() uses. Other attributes in such a file were copied from the centre view, and may no
// longer be true after the options.
bool is_ours(const HeaderValue &value) {
    static constexpr std::array names{"pinholeFocalLength", "aperture",      "focus",
                                      "worldToCamera",      "worldToNDC",    "aperture_blades",
                                      "aperture_rotation",  "aperture_ratio"};
    return value.name.starts_with("sparselens:") || std::ranges::find(names, value.name) != names.end();
}

} // namespace

CameraAttributes find_camera_attributes(const Imf::Header &header) {
    std::vector<HeaderValue> values = header_values(header);
    CameraAttributes found;
    found.ours = find_value(values, "sparselens:version") != nullptr;
    if (found.ours) std::erase_if(values, [](const HeaderValue &value) { return !is_ours(value); });
    for (const NumberName &name : number_names)
        if (const HeaderValue *entry = find_value(values, name.name)) {
            const double value = name.read(entry->numbers);
            if (name.read == screen_window && value == 1) continue;
            found.numbers.push_back({name.quantity, entry->name, value, name.exact});
        }
    found.no_perspective = other_projection(header, values);
    found.principal_point = by_screen_window(header);
    if (const auto width = acquired_width(values)) found.numbers.push_back(*width);
    for (const MatrixName &name : matrix_names)
        if (const HeaderValue *entry = find_value(values, name.name))
            found.matrices.push_back(read_matrix(name, *entry, values));
    if (const auto placement = unreal_placement(values)) {
        found.matrices.push_back(*placement);
        found.numbers.push_back({Quantity::metres_per_unit, placement->name, 0.01, false});
    }
    return found;
}

} // namespace sparselens
