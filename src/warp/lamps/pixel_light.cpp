#include "warp/lamps/pixel_light.h"

#include "base/parallel.h"

namespace sparselens {

namespace {

constexpr std::size_t at_once = 4096; // pixels
bool before(const Imath::V2i &a, const Imath::V2i &b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

} // namespace

std::vector<float> PixelLight::picture() const {
    std::vector<float> light(ldi_.windows.pixels());
    parallel_ranges(light.size(), at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) light[i] = float(at(i));
    });
    return light;
}

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
