#include "deep/pad.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

Ldi padded(Ldi ldi, const Imath::Box2i &data) {
    Windows windows = ldi.windows;
    windows.data.extendBy(data);
    if (windows == ldi.windows) return ldi;
    std::vector<std::uint64_t> begin{0};
    begin.reserve(windows.pixels() + 1);
    for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
        for (int x = windows.data.min.x; x <= windows.data.max.x; ++x) {
            const bool old = ldi.windows.data.intersects(Imath::V2i(x, y));
            begin.push_back(old ? ldi.begin[ldi.windows.index(x, y) + 1] : begin.back());
        }
    ldi.begin = std::move(begin);
    ldi.windows = windows;
    return ldi;
}

Imath::V2i largest_reach(const Ldi &ldi, const ThinLens &lens) {
    double largest = 0;
    for (const float z : ldi.z) largest = std::max(largest, std::abs(circle_of_confusion(lens, z)));
    return {int(std::ceil(largest)) + 1, int(std::ceil(largest * lens.pixel_aspect)) + 1};
}

} // namespace sparselens
