#include "host_image.h"

#include "host.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace sparselens_ofx {

OfxImageClipHandle clip_of(OfxImageEffectHandle effect, const char *name, OfxPropertySetHandle *properties) {
    OfxImageClipHandle clip = nullptr;
    if (suites().effects->clipGetHandle(effect, name, &clip, properties) != kOfxStatOK) return nullptr;
    return clip;
}

Rectangle intersection(const Rectangle &a, const Rectangle &b) {
    return {std::max(a.x1, b.x1), std::max(a.y1, b.y1), std::min(a.x2, b.x2), std::min(a.y2, b.y2)};
}

Rectangle rectangle_in(OfxPropertySetHandle set, const char *name) {
    return {whole_in(set, name, 0, 0), whole_in(set, name, 1, 0), whole_in(set, name, 2, 0),
            whole_in(set, name, 3, 0)};
}

bool is_connected(OfxImageEffectHandle effect, const char *name) {
    OfxPropertySetHandle properties = nullptr;
    return clip_of(effect, name, &properties) && whole_in(properties, kOfxImageClipPropConnected, 0, 0) != 0;
}

HostImage host_image(OfxImageEffectHandle effect, const char *name, double time) {
    const OfxImageClipHandle clip = clip_of(effect, name);
    OfxPropertySetHandle given = nullptr;
    if (!clip || suites().effects->clipGetImage(clip, time, nullptr, &given) != kOfxStatOK || !given)
        throw HostError(std::string("the host has no image of the clip ") + name);
    HostImage image;
    image.lent.reset(given, suites().effects->clipReleaseImage);
    const std::string depth = text_in(given, kOfxImageEffectPropPixelDepth);
    const std::string components = text_in(given, kOfxImageEffectPropComponents);
    const auto format = pixel_format(depth, components);
    image.data = static_cast<char *>(pointer_in(given, kOfxImagePropData));
    image.bounds = rectangle_in(given, kOfxImagePropBounds);
    image.row_bytes = whole_in(given, kOfxImagePropRowBytes, 0, 0);
    // Some hosts name another depth than that of their memory.
    if (!image.data || !format ||
        image.bounds.width() * std::int64_t(format->bytes()) > std::abs(std::int64_t{image.row_bytes}))
        throw HostError(std::string("the clip ") + name +
                        " has pixels that are unknown, or rows that are too short: " + depth + " " +
                        components);
    image.format = *format;
    image.unpremultiplied = text_in(given, kOfxImageEffectPropPreMultiplication) == kOfxImageUnPreMultiplied;
    const double aspect = number_in(given, kOfxImagePropPixelAspectRatio, 0, 1);
    if (aspect > 0) image.pixel_aspect = aspect;
    return image;
}

char *HostImage::pixel(int x, int y) const {
    return data + std::ptrdiff_t(y - bounds.y1) * row_bytes +
           std::ptrdiff_t(x - bounds.x1) * std::ptrdiff_t(format.bytes());
}

} // namespace sparselens_ofx
