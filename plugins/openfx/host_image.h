// The image of a clip at a time. A host's rows go upwards: y is 0 at the lower edge of its picture.
#pragma once

#include "ofx.h"
#include "pixel_format.h"

#include <string>

namespace sparselens_ofx {

// Pixels x1 <= x < x2, y1 <= y < y2.
struct Rectangle {
    int x1 = 0, y1 = 0, x2 = 0, y2 = 0;
    int width() const { return x2 - x1; }
    int height() const { return y2 - y1; }
    bool is_empty() const { return x2 <= x1 || y2 <= y1; }
};
Rectangle intersection(const Rectangle &a, const Rectangle &b);

// The four numbers of a property.
Rectangle rectangle_in(OfxPropertySetHandle set, const char *name);

class HostImage {
public:
    // Throws HostError if the host has no such image, or pixels that this plug-in does not know.
    HostImage(OfxImageEffectHandle effect, const char *clip, double time);
    ~HostImage();
    HostImage(const HostImage &) = delete;
    HostImage &operator=(const HostImage &) = delete;

    const Rectangle &bounds() const { return bounds_; } // of the pixels that are there
    const PixelFormat &format() const { return format_; }
    bool is_unpremultiplied() const { return unpremultiplied_; }
    double pixel_aspect() const { return pixel_aspect_; }

    // A pixel within the bounds. The address of a row may lie above or below that of the next one.
    char *pixel(int x, int y) const;

private:
    OfxPropertySetHandle image_ = nullptr;
    Rectangle bounds_;
    PixelFormat format_;
    char *data_ = nullptr;
    int row_bytes_ = 0;
    bool unpremultiplied_ = false;
    double pixel_aspect_ = 1;
};

// The clip of that name; null if the host has none. `properties` receives its properties.
OfxImageClipHandle clip_of(OfxImageEffectHandle effect, const char *name,
                           OfxPropertySetHandle *properties = nullptr);

bool is_connected(OfxImageEffectHandle effect, const char *clip);

} // namespace sparselens_ofx
