#include "host_image.h"

#include "host.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

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

HostImage::HostImage(OfxImageEffectHandle effect, const char *name, double time) {
    const OfxImageClipHandle clip = clip_of(effect, name);
    if (!clip || suites().effects->clipGetImage(clip, time, nullptr, &image_) != kOfxStatOK || !image_)
        throw HostError(std::string("the host has no image of the clip ") + name);
    const std::string depth = text_in(image_, kOfxImageEffectPropPixelDepth);
    const std::string components = text_in(image_, kOfxImageEffectPropComponents);
    const auto format = pixel_format(depth, components);
    data_ = static_cast<char *>(pointer_in(image_, kOfxImagePropData));
    bounds_ = rectangle_in(image_, kOfxImagePropBounds);
    row_bytes_ = whole_in(image_, kOfxImagePropRowBytes, 0, 0);
    // Some hosts name another depth than that of their memory.
    const bool fits =
        format && bounds_.width() * std::int64_t(format->bytes()) <= std::abs(std::int64_t{row_bytes_});
    if (!data_ || !fits) {
        suites().effects->clipReleaseImage(image_);
        throw HostError(std::string("the clip ") + name +
                        " has pixels that are unknown, or rows that are too short: " + depth + " " +
                        components);
    }
    format_ = *format;
    unpremultiplied_ = text_in(image_, kOfxImageEffectPropPreMultiplication) == kOfxImageUnPreMultiplied;
    const double aspect = number_in(image_, kOfxImagePropPixelAspectRatio, 0, 1);
    if (aspect > 0) pixel_aspect_ = aspect;
}

HostImage::~HostImage() { suites().effects->clipReleaseImage(image_); }

char *HostImage::pixel(int x, int y) const {
    return data_ + std::ptrdiff_t(y - bounds_.y1) * row_bytes_ +
           std::ptrdiff_t(x - bounds_.x1) * std::ptrdiff_t(format_.bytes());
}

} // namespace sparselens_ofx
