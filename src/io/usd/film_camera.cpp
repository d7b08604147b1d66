#include "io/usd/film_camera.h"

#include <fmt/format.h>

#include <cmath>

namespace sparselens {

namespace {

// Width of the film that the picture shows.
double shown_width(const FilmCamera &film, double picture_aspect) {
    const double by_height = film.film_height_mm * picture_aspect;
    const bool fits = std::abs(by_height / film.film_width_mm - 1) < 1e-6; // floats, and whole pixels
    if (fits || film.fit == FilmFit::by_width) return film.film_width_mm;
    if (film.fit == FilmFit::by_height) return by_height;
    return (by_height > film.film_width_mm) == (film.fit == FilmFit::expand) ? by_height : film.film_width_mm;
}

// From the world to the picture, with (0,0) and (1,1) at the corners of the display window, y down.
Imath::M44d world_to_ndc(const Camera &camera, double aspect) {
    const Imath::V2d axis = camera.principal_point.value_or(Imath::V2d(0, 0));
    const double x = 1 / *camera.field, y = -aspect / *camera.field;
    const Imath::M44d projection(x, 0, 0, 0, 0, y, 0, 0, 0.5 + axis.x, 0.5 + aspect * axis.y, 0, 1, 0, 0, 1,
                                 0);
    return *camera.world_to_camera * projection;
}

} // namespace

Camera with_film(const FilmCamera &film, Camera camera, const Windows &windows) {
    const double aspect =
        double(windows.display_width()) * double(windows.pixel_aspect) / double(windows.display_height());
    const double width = shown_width(film, aspect);
    for (const char *parameter : {"focal_length", "sensor_width", "projection"})
        camera.unsure.erase(parameter);
    camera.focal_length_mm = film.focal_length_mm;
    camera.sensor_width_mm = width;
    camera.metres_per_unit = film.metres_per_unit;
    camera.principal_point = Imath::V2d(0 - film.offset_mm.x / width, film.offset_mm.y / width);
    complete_field(camera);
    if (film.fstop) camera.fstop = film.fstop;
    if (film.focus_distance) camera.focus_distance = film.focus_distance;
    if (film.places) {
        camera.unsure.erase("view");
        camera.world_to_camera = film.world_to_camera;
    }
    camera.world_to_ndc.reset();
    if (camera.world_to_camera) camera.world_to_ndc = world_to_ndc(camera, aspect);
    camera.found = {
        fmt::format("focal length {:g} mm, film {:g} mm across the picture, scene unit {:g} m ({})",
                    film.focal_length_mm, width, film.metres_per_unit, film.name)};
    if (film.fstop) camera.found.push_back(fmt::format("f-number {:g}", *film.fstop));
    if (film.focus_distance) camera.found.push_back(fmt::format("focus distance {:g}", *film.focus_distance));
    return camera;
}

} // namespace sparselens
