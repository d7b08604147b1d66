#include "io/usd/usd_camera.h"

#include "base/error.h"
#include "io/files/file_stream.h"
#include "io/usd/usd_layer.h"
#include "io/usd/usd_transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

namespace sparselens {

namespace {

constexpr const char *flatten = "write all into one file: usdcat --flatten IN -o OUT.usda";

// UsdGeomCamera's values where a file gives none.
constexpr double default_focal = 50, default_width = 20.955, default_height = 15.2908;

FilmFit fit_of(const std::string &policy) {
    constexpr std::array names{std::pair{"cropAperture", FilmFit::crop},
                               std::pair{"adjustApertureWidth", FilmFit::by_height},
                               std::pair{"adjustApertureHeight", FilmFit::by_width},
                               std::pair{"adjustPixelAspectRatio", FilmFit::by_width}};
    for (const auto &[name, fit] : names)
        if (policy == name) return fit;
    return FilmFit::expand;
}

// The only settings, or those of several that the layer names.
const UsdPath *chosen_settings(const UsdLayer &layer, const std::vector<UsdPath> &settings) {
    if (settings.size() == 1) return &settings[0];
    const auto named =
        std::ranges::find(settings, layer.render_settings, [](const UsdPath &p) { return text_of(p); });
    return named == settings.end() ? nullptr : &*named;
}

void read_settings(UsdCameras &usd) {
    const std::vector<UsdPath> all = prims_of_type(usd.layer, "RenderSettings");
    const UsdPath *settings = chosen_settings(usd.layer, all);
    if (!settings) return;
    const UsdPlace place{usd.layer, *settings, 0};
    usd.fit = fit_of(text_value(*settings->back(), "aspectRatioConformPolicy"));
    const std::vector<double> size = numbers_at(place, "resolution", 2);
    const auto is_side = [](double v) { return v >= 1 && v <= 1 << 20 && v == std::floor(v); };
    if (!size.empty() && (!is_side(size[0]) || !is_side(size[1])))
        refuse(place, "its resolution is not a size");
    if (!size.empty()) usd.resolution = Imath::V2i(int(size[0]), int(size[1]));
    usd.pixel_aspect = number_at(place, "pixelAspectRatio").value_or(1);
    if (!(usd.pixel_aspect > 1e-3 && usd.pixel_aspect < 1e3))
        refuse(place, "its pixelAspectRatio is out of range");
}

std::string listed(const UsdCameras &usd) {
    constexpr std::size_t most_listed = 8;
    std::string text;
    for (const UsdPath &camera : usd.cameras) {
        if (&camera == &usd.cameras[0] + most_listed) return text + ", ...";
        text += (text.empty() ? "" : ", ") + text_of(camera);
    }
    return text;
}

// Rows are the right, up and backward axes of the camera in the world, and its place. USD ignores the scale of cameras.
Imath::M44d without_scale(Imath::M44d m, const UsdPlace &place) {
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
    return m;
}

Imath::M44d world_to_camera_of(const UsdPlace &place) {
    Imath::M44d axes = without_scale(local_to_world(place), place);
    for (int k = 0; k < 3; ++k) axes[2][k] = -axes[2][k]; // forward
    return axes.inverse();
}

double positive(const UsdPlace &place, const char *name, double otherwise) {
    const double value = number_at(place, name).value_or(otherwise);
    if (!(value > 1e-9 && value < 1e9))
        refuse(place, fmt::format("its {} is {:g}, not a length above 0", name, value));
    return value;
}

// A value of the lens: ours if it is there, else USD's, for which 0 means that there is no depth of field.
std::optional<double> lens_value(const UsdPlace &place, const char *ours, const char *usd) {
    std::optional<double> value = number_at(place, ours);
    if (!value) value = number_at(place, usd);
    if (value && !(*value >= 0)) refuse(place, fmt::format("its {} is {:g}, below 0", usd, *value));
    return value && *value > 0 ? value : std::nullopt;
}

} // namespace

UsdCameras::UsdCameras(const std::string &path)
    : layer(read_usd(path)), cameras(prims_of_type(layer, "Camera")) {
    if (!layer.root.composed.empty())
        throw Error(fmt::format("{}: its {} are not read; {}", layer.file, layer.root.composed, flatten));
    if (cameras.empty())
        throw Error(layer.composed.empty()
                        ? fmt::format("{}: has no camera", layer.file)
                        : fmt::format("{}: has no camera of its own, and its {} are not read; {}", layer.file,
                                      layer.composed, flatten));
    read_settings(*this);
}

const UsdPath &camera_called(const UsdCameras &usd, const std::string &name) {
    if (name.empty() && usd.cameras.size() == 1) return usd.cameras[0];
    const UsdPath *found = nullptr;
    const std::string last = name.empty() ? "center" : name;
    for (const UsdPath &camera : usd.cameras) {
        if (text_of(camera) == name) return camera;
        if (camera.back()->name != last) continue;
        if (found)
            throw UsageError(
                fmt::format("`camera_name`: {} has several of that name: {}", usd.layer.file, listed(usd)));
        found = &camera;
    }
    if (found) return *found;
    throw UsageError(name.empty() ? fmt::format("{} has several cameras: give `camera_name`, one of {}",
                                                usd.layer.file, listed(usd))
                                  : fmt::format("`camera_name`: {} has no camera '{}', but {}",
                                                usd.layer.file, name, listed(usd)));
}

const UsdPath *camera_of_file(const UsdCameras &usd, const std::string &file) {
    const std::string name = std::filesystem::path(file).filename().string();
    const auto found = std::ranges::find(usd.cameras, name.substr(0, name.find('.')),
                                         [](const UsdPath &camera) { return camera.back()->name; });
    return found == usd.cameras.end() ? nullptr : &*found;
}

bool is_animated(const UsdPath &camera) { return sample_times(camera).size() > 1; }

FilmCamera film_camera(const UsdCameras &usd, const UsdPath &camera, double time) {
    const UsdPlace place{usd.layer, camera, time};
    if (const std::string kind = text_value(*camera.back(), "projection");
        !kind.empty() && kind != "perspective")
        refuse(place, fmt::format("its projection is {}, and views need perspective", kind));
    FilmCamera film{.name = fmt::format("{}<{}>", usd.layer.file, text_of(camera)), .fit = usd.fit};
    const double mm = usd.layer.metres_per_unit * 100; // in a tenth of a scene unit
    film.metres_per_unit = usd.layer.metres_per_unit;
    film.world_to_camera = world_to_camera_of(place);
    film.focal_length_mm = mm * positive(place, "focalLength", default_focal);
    film.film_width_mm = mm * positive(place, "horizontalAperture", default_width);
    film.film_height_mm = mm * positive(place, "verticalAperture", default_height);
    film.offset_mm = {mm * number_at(place, "horizontalApertureOffset").value_or(0),
                      mm * number_at(place, "verticalApertureOffset").value_or(0)};
    film.fstop = lens_value(place, "sparselens:fStop", "fStop");
    film.focus_distance = lens_value(place, "sparselens:focusDistance", "focusDistance");
    return film;
}

Imath::V2d clipping_range(const UsdCameras &usd, const UsdPath &camera, double time) {
    const std::vector<double> range = numbers_at({usd.layer, camera, time}, "clippingRange", 2);
    return range.empty() ? Imath::V2d(1, 1e6) : Imath::V2d(range[0], range[1]);
}

std::optional<std::string> film_warning(const FilmCamera &film) {
    if (film.focal_length_mm >= 1 && film.focal_length_mm <= 3000) return {};
    const double number = film.focal_length_mm / (100 * film.metres_per_unit);
    return fmt::format(
        "{}: its focal length is {:g} mm, because USD counts in tenths of a scene unit of {:g} m; if {:g} "
        "means millimetres, give `focal_length` and `sensor_width`",
        film.name, film.focal_length_mm, film.metres_per_unit, number);
}

} // namespace sparselens
