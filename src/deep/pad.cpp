#include "deep/pad.h"

#include "lens/light_reach.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {
constexpr double sharp = 0.5; // pixels; light that reaches less far is not spread (lens_gather.h)
}

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

Imath::Box2i reached_display(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks) {
    const Imath::Box2i &display = ldi.windows.display;
    const LightReach light(lens, looks, ldi.windows);
    Imath::Box2d reached;
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
        const Imath::V2d own(ldi.windows.pixel(pixel)), at = own + Imath::V2d(0.5);
        for (const std::uint64_t i : ldi.pixel(pixel)) {
            const Imath::Box2d box = light.box(at, circle_of_confusion(lens, ldi.optical_z(i)));
            const Imath::V2d reach = box.size() / 2;
            if (std::max(reach.x, reach.y) < sharp && light.magnification() == 1) continue;
            const Imath::V2d whole(std::ceil(reach.x) + 1, std::ceil(reach.y) + 1); // pixels that it touches
            const Imath::V2d middle(std::floor(box.center().x), std::floor(box.center().y));
            reached.extendBy(Imath::Box2d(middle - whole, middle + whole));
            reached.extendBy(Imath::Box2d(own - whole, own + whole)); // the light before it is magnified
        }
    }
    Imath::Box2i box;
    for (int axis = 0; axis < 2; ++axis) {
        if (reached.max[axis] < display.min[axis] || reached.min[axis] > display.max[axis]) return {};
        box.min[axis] = int(std::max(reached.min[axis], double(display.min[axis])));
        box.max[axis] = int(std::min(reached.max[axis], double(display.max[axis])));
    }
    return box;
}

} // namespace sparselens
