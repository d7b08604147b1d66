#include "io/photograph.h"

#include "base/error.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_deep_part.h"
#include "io/exr/exr_flat.h"
#include "io/exr/exr_header.h"
#include "io/files/file_stream.h"

#include <ImfChromaticitiesAttribute.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sparselens {

namespace {

// As a flat EXR would be read, with what it states about its colours.
FlatFile read_shown(const std::string &path) {
    bool floats = false;
    FlatFile file;
    file.image = read_shown_picture(path, &floats);
    const Windows &windows = file.image.windows;
    file.header = Imf::Header(windows.display, windows.data, windows.pixel_aspect);
    if (floats || holds_linear_light(path))
        set_attribute(file.header, "chromaticities", Imf::ChromaticitiesAttribute(Imf::Chromaticities()));
    else
        set_attribute(file.header, "oiio:ColorSpace", Imf::StringAttribute("srgb_texture"));
    return file;
}

void require_grey(const Image &image, const std::string &name) {
    constexpr float rounding = 0.03f; // of JPEG
    const auto r = image.plane(0);
    for (std::size_t k = 1; k < image.channels.size(); ++k)
        for (std::size_t i = 0; i < r.size(); ++i)
            if (std::abs(image.plane(k)[i] - r[i]) > rounding)
                throw Error(name +
                            ": has colours, and depth must be grey: let the estimator write it without a "
                            "colour map, white near (`depth_file`)");
}

void require_size(const Windows &depth, const std::string &name, const Windows &picture,
                  const std::string &path) {
    const auto size = [](const Windows &w) {
        return fmt::format("{}x{}", w.display_width(), w.display_height());
    };
    if (size(depth) != size(picture))
        throw Error(
            fmt::format("{}: is {} pixels large, and {} is {}: give a depth of the same size (oiiotool {} "
                        "--resize {} -o NEW)",
                        name, size(depth), path, size(picture), name, size(picture)));
}

// Gives the windows the corner and the shape of the pixels of another frame of that size: only EXR files have a corner.
void move_frame(Windows &windows, const Windows &to) {
    const Imath::V2i by = to.display.min - windows.display.min;
    for (Imath::V2i *corner : {&windows.data.min, &windows.data.max}) *corner += by;
    windows.display = to.display;
    windows.pixel_aspect = to.pixel_aspect;
}

// The depth (R) in the pixels of `data`: beyond its own, that of the nearest pixel.
Image extended(const Image &depth, const Imath::Box2i &data) {
    const Imath::Box2i &own = depth.windows.data;
    Image result({depth.windows.display, data, depth.windows.pixel_aspect}, {{"R", PixelType::float32}});
    for (int y = data.min.y; y <= data.max.y; ++y)
        for (int x = data.min.x; x <= data.max.x; ++x)
            result.at(0, x, y) =
                depth.at(0, std::clamp(x, own.min.x, own.max.x), std::clamp(y, own.min.y, own.max.y));
    return result;
}

} // namespace

bool is_photograph(const std::string &path, const PictureChoice &choice) {
    return has_shown_ending(path) || has_shown_ending(choice.depth_file);
}

LdiFile read_photograph(const std::string &path, const PictureChoice &choice) {
    if (choice.depth_file.empty())
        throw UsageError(path +
                         ": is a picture without depth: give its depth by `depth_file` (grey, white near)");
    PictureChoice colours = choice;
    colours.depth_file.clear();
    FlatFile picture = has_shown_ending(path) ? read_shown(path) : read_flat_exr(path, colours);
    const std::string &name = choice.depth_file;
    const bool shown = has_shown_ending(name);
    FlatFile depth = shown ? read_shown(name) : read_depth_file(choice);
    require_size(depth.image.windows, name, picture.image.windows, display_name(path));
    if (shown) require_grey(depth.image, name);
    move_frame(depth.image.windows, picture.image.windows);
    if (shown) depth.image = extended(depth.image, picture.image.windows.data);
    put_depth_of_file(picture, path, shown ? PictureChoice{.depth_file = name} : choice, depth);
    return {ldi_of_flat(picture.image, "Z"), picture.header, false, std::move(picture.notes),
            std::move(picture.warnings)};
}

void repair_disparities(std::span<float> depths, const std::string &name,
                        std::vector<std::string> &warnings) {
    float least = std::numeric_limits<float>::infinity(), most = -least;
    for (const float d : depths)
        if (std::isfinite(d)) least = std::min(least, d), most = std::max(most, d);
    if (!(most > least))
        throw Error(name +
                    ": its depth is the same everywhere, so that nothing can be out of focus: give another "
                    "`depth_file`");
    if (least < 0 || most > 1) {
        warnings.push_back(
            fmt::format("its depth goes from {:g} to {:g}, and is scaled to 0 to 1", least, most));
        for (float &d : depths) d = (d - least) / (most - least);
        most = 1, least = 0;
    }
    const auto below_above = [&](std::size_t n) { // the sum of the last rows' depths less that of the first
        return std::accumulate(depths.end() - std::ptrdiff_t(n), depths.end(), 0.0) -
               std::accumulate(depths.begin(), depths.begin() + std::ptrdiff_t(n), 0.0);
    };
    constexpr double clear = 0.25; // of the range: the ground is nearer than what is above it
    if (below_above(depths.size() / 4) < -clear * double(depths.size() / 4) * double(most - least))
        warnings.emplace_back(
            "its depth is darker below than above, and white must be near: if white is far, "
            "invert it (oiiotool DEPTH --invert -o NEW)");
}

Camera photograph_camera() {
    Camera camera;
    camera.focal_length_mm = camera.sensor_width_mm = 36;
    return camera;
}

} // namespace sparselens
