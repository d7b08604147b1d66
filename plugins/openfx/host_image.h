// The image of a clip at a time. A host's rows go upwards: y is 0 at the lower edge of its picture.
#pragma once

#include "ofx.h"
#include "pixel_format.h"

#include <memory>

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

struct HostImage {
    std::shared_ptr<OfxPropertySetStruct> lent; // the host's properties, given back with the last copy
    Rectangle bounds;                           // of the pixels that are there
    PixelFormat format;
    bool unpremultiplied = false;
    double pixel_aspect = 1;
    char *data = nullptr; // of the pixel in the lower left corner of the bounds
    int row_bytes = 0;    // from a row to the one above it; below 0 where that lies before it in memory

    char *pixel(int x, int y) const; // within the bounds
};

// Throws HostError if the host has no such image, or pixels that this plug-in does not know.
HostImage host_image(OfxImageEffectHandle effect, const char *clip, double time);

// The clip of that name; null if the host has none. `properties` receives its properties.
OfxImageClipHandle clip_of(OfxImageEffectHandle effect, const char *name,
                           OfxPropertySetHandle *properties = nullptr);

bool is_connected(OfxImageEffectHandle effect, const char *clip);

} // namespace sparselens_ofx
