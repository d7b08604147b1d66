#include "warp/lamps/pixel_light.h"

namespace sparselens {

namespace {

bool before(const Imath::V2i &a, const Imath::V2i &b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

} // namespace

std::vector<Imath::V2i> grown(std::span<const Imath::V2i> pixels, int reach) {
    std::vector<Imath::V2i> result;
    for (const Imath::V2i &p : pixels)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) result.push_back(p + Imath::V2i(x, y));
    std::sort(result.begin(), result.end(), before);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

bool is_among(std::span<const Imath::V2i> pixels, const Imath::V2i &pixel) {
    return std::binary_search(pixels.begin(), pixels.end(), pixel, before);
}

} // namespace sparselens
