#include "flat_source.h"

#include "describe.h"
#include "host.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace sparselens_ofx {

namespace {

// The project in pixels at the scale of the render; the picture's own pixels if the host does not say.
Rectangle project(OfxImageEffectHandle effect, const HostImage &source, double scale_x, double scale_y) {
    const OfxPropertySetHandle properties = properties_of(effect);
    const auto number = [&](const char *name, int index) { return number_in(properties, name, index, 0); };
    const double across = scale_x / source.pixel_aspect;
    const double left = number(kOfxImageEffectPropProjectOffset, 0) * across;
    const double bottom = number(kOfxImageEffectPropProjectOffset, 1) * scale_y;
    const double width = number(kOfxImageEffectPropProjectSize, 0) * across;
    const double height = number(kOfxImageEffectPropProjectSize, 1) * scale_y;
    if (!(width >= 0.5 && height >= 0.5)) return source.bounds;
    const Rectangle pixels{int(std::lround(left)), int(std::lround(bottom)), int(std::lround(left + width)),
                           int(std::lround(bottom + height))};
    return pixels.is_empty() ? source.bounds : pixels;
}

// The same pixels in EXR coordinates, whose origin is the upper left pixel of the display window.
Box in_exr(const Rectangle &pixels, const Rectangle &display) {
    return {pixels.x1 - display.x1, display.y2 - pixels.y2, pixels.x2 - 1 - display.x1,
            display.y2 - 1 - pixels.y1};
}

float depth_at(const HostImage &depth, int x, int y) {
    const Rectangle &there = depth.bounds;
    if (x < there.x1 || x >= there.x2 || y < there.y1 || y >= there.y2) return 0; // nothing
    std::array<float, 4> components{};
    read_pixel(depth.format, depth.pixel(x, y), components.data());
    return components[0];
}

} // namespace

FlatSource flat_source(OfxImageEffectHandle effect, double time, double scale_x, double scale_y) {
    const HostImage source = host_image(effect, source_clip, time);
    std::optional<HostImage> depth;
    if (is_connected(effect, depth_clip)) depth = host_image(effect, depth_clip, time);
    const Rectangle &bounds = source.bounds;
    if (bounds.is_empty() || source.format.components < 3) throw HostError("the source has no picture");
    FlatSource flat;
    flat.display = project(effect, source, scale_x, scale_y);
    flat.unpremultiplied = source.unpremultiplied && source.format.components == 4;
    auto picture = std::make_shared<FlatPicture>();
    picture->display = in_exr(flat.display, flat.display);
    picture->data = in_exr(bounds, flat.display);
    picture->pixel_aspect = source.pixel_aspect;
    picture->shown = source.format.is_whole();
    picture->channels = {"R", "G", "B", "A"};
    if (depth) picture->channels.emplace_back("Z");
    picture->pixels.reserve(picture->channels.size() * std::size_t(bounds.width()) *
                            std::size_t(bounds.height()));
    for (int y = bounds.y2 - 1; y >= bounds.y1; --y)
        for (int x = bounds.x1; x < bounds.x2; ++x) {
            std::array<float, 4> rgba{0, 0, 0, 1};
            read_pixel(source.format, source.pixel(x, y), rgba.data());
            picture->pixels.insert(picture->pixels.end(), rgba.begin(), rgba.end());
            if (depth) picture->pixels.push_back(depth_at(*depth, x, y));
        }
    flat.picture = std::move(picture);
    return flat;
}

} // namespace sparselens_ofx
