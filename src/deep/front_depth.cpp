#include "deep/front_depth.h"

#include <limits>

namespace sparselens {

float front_depth(const Ldi &ldi, const Imath::V2i &pixel) {
    if (!ldi.windows.data.intersects(pixel)) return 0;
    const std::size_t i = ldi.windows.index(pixel.x, pixel.y);
    return ldi.begin[i] == ldi.begin[i + 1] ? 0 : ldi.z[ldi.begin[i]];
}

Image front_depth(const Ldi &ldi) {
    Image depth(ldi.windows, {{"Z", PixelType::float32}});
    for (std::size_t i = 0; i < ldi.windows.pixels(); ++i)
        depth.values[i] =
            ldi.begin[i] == ldi.begin[i + 1] ? std::numeric_limits<float>::infinity() : ldi.z[ldi.begin[i]];
    return depth;
}

} // namespace sparselens
