#include "io/usd/usd_camera.h"

#include "base/error.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "io/usd/usd_script.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

namespace sparselens {

namespace {

using Json = nlohmann::json;

FilmFit fit_of(const std::string &policy) {
    constexpr std::array names{std::pair{"cropAperture", FilmFit::crop},
                               std::pair{"adjustApertureWidth", FilmFit::by_height},
                               std::pair{"adjustApertureHeight", FilmFit::by_width},
                               std::pair{"adjustPixelAspectRatio", FilmFit::by_width}};
    for (const auto &[name, fit] : names)
        if (policy == name) return fit;
    return FilmFit::expand;
}

double number_of(const Json &value) { return value.is_null() ? HUGE_VAL : value.get<double>(); }

std::vector<double> numbers_of(const Json &value) {
    std::vector<double> numbers;
    if (!value.is_array()) return {number_of(value)};
    for (const Json &each : value) numbers.push_back(number_of(each));
    return numbers;
}

double positive_of(const Json &json, const char *name) {
    const double value = number_of(json.at(name));
    if (!(value > 1e-9 && value < 1e9)) throw Error(fmt::format("{} must be above 0", name));
    return value;
}

UsdCamera camera_of(const Json &json) {
    UsdCamera camera{json.at("path"), json.value("error", "")};
    if (!camera.error.empty()) return camera;
    camera.projection = json.value("projection", "perspective");
    for (const Json &frame : json.at("frames")) {
        UsdValues &values = camera.frames[frame.at("time").get<double>()];
        for (const auto &[name, value] : frame.items()) values[name] = numbers_of(value);
    }
    if (camera.frames.empty()) throw Error(camera.path + ": has no frames");
    return camera;
}

void read_settings(const Json &json, UsdCameras &usd) {
    const std::string path = json.at("path");
    usd.fit = fit_of(json.at("aspectRatioConformPolicy"));
    const std::vector<double> size =
        json.at("resolution").is_null() ? std::vector<double>() : numbers_of(json.at("resolution"));
    const auto is_side = [](double v) { return v >= 1 && v <= 1 << 20 && v == std::floor(v); };
    if (!size.empty() && (size.size() != 2 || !std::ranges::all_of(size, is_side)))
        throw Error(path + ": its resolution is not a size");
    if (!size.empty()) usd.resolution = Imath::V2i(int(size[0]), int(size[1]));
    usd.pixel_aspect = number_of(json.at("pixelAspectRatio"));
    if (!(usd.pixel_aspect > 1e-3 && usd.pixel_aspect < 1e3))
        throw Error(path + ": its pixelAspectRatio is out of range");
}

UsdCameras cameras_of(const Json &json, const std::string &file) {
    UsdCameras usd{.file = file, .cameras = {}};
    usd.metres_per_unit = positive_of(json, "metersPerUnit");
    usd.frames_per_second = positive_of(json, "timeCodesPerSecond");
    const std::string up = json.at("upAxis");
    if (up != "Y" && up != "Z") throw Error("upAxis must be \"Y\" or \"Z\"");
    usd.up_axis = up[0];
    if (const Json &settings = json.at("settings"); !settings.is_null()) read_settings(settings, usd);
    for (const Json &camera : json.at("cameras")) usd.cameras.push_back(camera_of(camera));
    if (usd.cameras.empty()) throw Error("has no camera");
    const std::vector<std::string> lacks = json.value("warnings", std::vector<std::string>());
    if (!lacks.empty()) usd.warning = fmt::format("{}: {}", file, lacks[0]);
    if (lacks.size() > 1) usd.warning += fmt::format(" (and {} more)", lacks.size() - 1);
    return usd;
}

std::string listed(const UsdCameras &usd) {
    constexpr std::size_t most_listed = 8;
    std::string text;
    for (std::size_t i = 0; i < usd.cameras.size() && i < most_listed; ++i)
        text += (i > 0 ? ", " : "") + usd.cameras[i].path;
    return usd.cameras.size() > most_listed ? text + ", ..." : text;
}

// A camera at a time, with the words of messages.
struct Place {
    const UsdCameras &usd;
    const UsdCamera &camera;
    const UsdValues &values;
};

[[noreturn]] void refuse(const UsdCameras &usd, const UsdCamera &camera, const std::string &why) {
    throw Error(fmt::format("{}: {}: {}", usd.file, camera.path, why));
}
[[noreturn]] void refuse(const Place &place, const std::string &why) { refuse(place.usd, place.camera, why); }

Place place_at(const UsdCameras &usd, const UsdCamera &camera, double time) {
    if (!camera.error.empty()) refuse(usd, camera, camera.error);
    const auto after = camera.frames.lower_bound(time);
    if (after == camera.frames.end()) return {usd, camera, camera.frames.rbegin()->second};
    if (after != camera.frames.begin() && after->first != time)
        refuse(usd, camera,
               fmt::format("is known at frames {:g} and {:g}, but not at {:g} between",
                           std::prev(after)->first, after->first, time));
    return {usd, camera, after->second};
}

// Empty if there is none.
std::vector<double> numbers_at(const Place &place, std::string_view name, std::size_t count) {
    const auto found = place.values.find(name);
    if (found == place.values.end()) return {};
    if (found->second.size() != count)
        refuse(place, fmt::format("{} must be {} number{}", name, count, count == 1 ? "" : "s"));
    return found->second;
}

std::optional<double> number_at(const Place &place, std::string_view name) {
    const std::vector<double> v = numbers_at(place, name, 1);
    return v.empty() ? std::nullopt : std::optional(v[0]);
}

// Rows are the right, up and backward axes of the camera in the world, and its place. USD ignores the scale of cameras.
Imath::M44d without_scale(Imath::M44d m, const Place &place) {
    std::array<Imath::V3d, 3> axes;
    for (int i = 0; i < 3; ++i) {
        axes[std::size_t(i)] = Imath::V3d(m[i][0], m[i][1], m[i][2]);
        const double length = axes[std::size_t(i)].length();
        if (!(length > 1e-12 && length < 1e12)) refuse(place, "its transformation is singular");
        axes[std::size_t(i)] /= length;
        for (int k = 0; k < 3; ++k) m[i][k] = axes[std::size_t(i)][k];
    }
    const double shear = std::max(
        {std::abs(axes[0].dot(axes[1])), std::abs(axes[1].dot(axes[2])), std::abs(axes[2].dot(axes[0]))});
    if (shear > 1e-5) refuse(place, "its transformation is sheared: remove the uneven scale of its parents");
    if (axes[0].cross(axes[1]).dot(axes[2]) < 0)
        refuse(place, "its transformation is mirrored: remove the negative scale");
    if (!(m.translation().length() < 1e15)) refuse(place, "its place is out of range");
    for (int i = 0; i < 4; ++i) m[i][3] = i == 3;
    return m;
}

Imath::M44d world_to_camera_of(const Place &place) {
    const std::vector<double> v = numbers_at(place, "to_world", 16);
    if (v.empty()) refuse(place, "its to_world is missing");
    Imath::M44d axes;
    for (std::size_t i = 0; i < 16; ++i) axes[int(i / 4)][int(i % 4)] = v[i];
    axes = without_scale(axes, place);
    for (int k = 0; k < 3; ++k) axes[2][k] = -axes[2][k]; // forward
    return axes.inverse();
}

double positive(const Place &place, const char *name) {
    const std::optional<double> value = number_at(place, name);
    if (!value) refuse(place, fmt::format("its {} is missing", name));
    if (!(*value > 1e-9 && *value < 1e9))
        refuse(place, fmt::format("its {} is {:g}, not a length above 0", name, *value));
    return *value;
}

// A value of the lens: ours if it is there, else USD's, for which 0 means that there is no depth of field.
std::optional<double> lens_value(const Place &place, const char *ours, const char *usd) {
    std::optional<double> value = number_at(place, ours);
    if (!value) value = number_at(place, usd);
    if (value && !(*value >= 0)) refuse(place, fmt::format("its {} is {:g}, below 0", usd, *value));
    return value && *value > 0 ? value : std::nullopt;
}

} // namespace

bool is_camera_json(const std::string &path) { return path == "-" || path.ends_with(".json"); }

UsdCameras read_usd_cameras(const std::string &path, std::optional<double> frame) {
    const std::string file = display_name(path);
    try {
        if (is_camera_json(path)) return cameras_of(read_json_file(path), file);
        std::vector<std::string> words{"read"};
        if (frame) words.push_back(fmt::format("--frame={}", *frame));
        words.insert(words.end(), {"--", path});
        return cameras_of(Json::parse(run_usd_script(words, {}, file)), file);
    } catch (const nlohmann::json::exception &error) {
        throw Error(fmt::format("{}: has no cameras as usd_cameras.py writes them: {}", file, error.what()));
    } catch (const Error &error) {
        const std::string what = error.what();
        throw Error(what.starts_with(file) ? what : file + ": " + what);
    }
}

const UsdCamera &camera_called(const UsdCameras &usd, const std::string &name) {
    if (name.empty() && usd.cameras.size() == 1) return usd.cameras[0];
    const UsdCamera *found = nullptr;
    const std::string last = name.empty() ? "center" : name;
    for (const UsdCamera &camera : usd.cameras) {
        if (camera.path == name) return camera;
        if (camera.name() != last) continue;
        if (found)
            throw UsageError(
                fmt::format("`camera_name`: {} has several of that name: {}", usd.file, listed(usd)));
        found = &camera;
    }
    if (found) return *found;
    throw UsageError(
        name.empty()
            ? fmt::format("{} has several cameras: give `camera_name`, one of {}", usd.file, listed(usd))
            : fmt::format("`camera_name`: {} has no camera '{}', but {}", usd.file, name, listed(usd)));
}

const UsdCamera *camera_of_file(const UsdCameras &usd, const std::string &file) {
    const std::string name = std::filesystem::path(file).filename().string();
    const auto found = std::ranges::find(usd.cameras, name.substr(0, name.find('.')), &UsdCamera::name);
    return found == usd.cameras.end() ? nullptr : &*found;
}

FilmCamera film_camera(const UsdCameras &usd, const UsdCamera &camera, double time) {
    const Place place = place_at(usd, camera, time);
    if (camera.projection != "perspective")
        refuse(place, fmt::format("its projection is {}, and views need perspective", camera.projection));
    FilmCamera film{.name = fmt::format("{}<{}>", usd.file, camera.path), .fit = usd.fit};
    const double mm = usd.metres_per_unit * 100; // in a tenth of a scene unit
    film.warning = usd.warning;
    film.metres_per_unit = usd.metres_per_unit;
    film.world_to_camera = world_to_camera_of(place);
    film.focal_length_mm = mm * positive(place, "focalLength");
    film.film_width_mm = mm * positive(place, "horizontalAperture");
    film.film_height_mm = mm * positive(place, "verticalAperture");
    film.offset_mm = {mm * number_at(place, "horizontalApertureOffset").value_or(0),
                      mm * number_at(place, "verticalApertureOffset").value_or(0)};
    film.fstop = lens_value(place, "sparselens:fStop", "fStop");
    film.focus_distance = lens_value(place, "sparselens:focusDistance", "focusDistance");
    return film;
}

Imath::V2d clipping_range(const UsdCameras &usd, const UsdCamera &camera, double time) {
    const std::vector<double> range = numbers_at(place_at(usd, camera, time), "clippingRange", 2);
    return range.empty() ? Imath::V2d(1, 1e6) : Imath::V2d(range[0], range[1]);
}

std::vector<std::string> film_warnings(const FilmCamera &film, bool focal_length_given) {
    std::vector<std::string> warnings;
    if (!film.warning.empty()) warnings.push_back(film.warning);
    if (focal_length_given || (film.focal_length_mm >= 1 && film.focal_length_mm <= 3000)) return warnings;
    const double number = film.focal_length_mm / (100 * film.metres_per_unit);
    warnings.push_back(fmt::format(
        "{}: its focal length is {:g} mm, because USD counts in tenths of a scene unit of {:g} m; if {:g} "
        "means millimetres, give `focal_length` and `sensor_width`",
        film.name, film.focal_length_mm, film.metres_per_unit, number));
    return warnings;
}

} // namespace sparselens
