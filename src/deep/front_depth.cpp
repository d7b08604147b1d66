#include "deep/front_depth.h"

#include <limits>

namespace sparselens {

float front_depth(const Ldi &ldi, const Imath::V2i &pixel) {
    if (!ldi.windows.data.intersects(pixel)) return 0;
    const std::size_t i = ldi.windows.index(pixel.x, pixel.y);
    return ldi.pixel(i).empty() ? 0 : ldi.z[ldi.pixel(i).front()];
}

Image front_depth(const Ldi &ldi) {
    Image depth(ldi.windows, {{"Z", PixelType::float32, ChannelKind::data}});
    for (std::size_t i = 0; i < ldi.windows.pixels(); ++i)
        depth.values[i] =
            ldi.pixel(i).empty() ? std::numeric_limits<float>::infinity() : ldi.z[ldi.pixel(i).front()];
    return depth;
}

} // namespace sparselens
