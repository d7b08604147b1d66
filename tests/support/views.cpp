#include "support/views.h"

#include "base/random.h"

#include <limits>

namespace sparselens {

View make_view(const Windows &windows, const Imath::V2d &position,
               const std::function<ViewPixel(int x, int y)> &pixel) {
    View view{"view", Image(windows, rgba_channels()), {}, position};
    for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
        for (int x = windows.data.min.x; x <= windows.data.max.x; ++x) {
            const ViewPixel p = pixel(x, y);
            view.z.push_back(p.z);
            const float values[] = {p.r, p.g, p.b, p.a};
            for (std::size_t k = 0; k < 4; ++k) view.image.at(k, x, y) = values[k];
        }
    return view;
}

View TwoPlanes::view(const Windows &windows, const Imath::V2d &position) const {
    return make_view(windows, position, [&](int i, int j) {
        const double x = i + 0.5, y = j + 0.5;
        const double right = focal_px * position.x,
                     down = -focal_px * position.y * double(windows.pixel_aspect);
        const std::uint32_t place = mix_bits(std::uint32_t(i), mix_bits(std::uint32_t(j)));
        const std::uint32_t camera =
            mix_bits(std::uint32_t(int(right * 1024)), mix_bits(std::uint32_t(int(down * 1024))));
        const float change = noise * float(2 * unit_interval(mix_bits(place, camera)) - 1);
        const double front_x = x + right / front_z, front_y = y + down / front_z;
        if (front_covers(front_x, front_y))
            return ViewPixel{.z = float(front_z), .r = front_red(front_x, front_y) + change};
        return ViewPixel{.z = float(back_z), .g = back_green(x + right / back_z, y + down / back_z) + change};
    });
}

std::vector<View> five_views(const TwoPlanes &scene, const Windows &windows, double radius) {
    std::vector<View> views;
    for (const Imath::V2d &u :
         {Imath::V2d(0, 0), Imath::V2d(1, 0), Imath::V2d(0, 1), Imath::V2d(-1, 0), Imath::V2d(0, -1)})
        views.push_back(scene.view(windows, radius * u));
    return views;
}

View random_view(const Windows &windows, const Imath::V2d &position, std::uint32_t seed) {
    std::uint32_t count = 0;
    const auto random = [&] { return unit_interval(mix_bits(++count, seed)); };
    return make_view(windows, position, [&](int, int) {
        ViewPixel p;
        const double kind = random();
        p.z = kind < 0.1 ? std::numeric_limits<float>::infinity() : float(1 + int(8 * random()));
        if (kind > 0.8) p.z = float(1 + 8 * random());
        p.a = random() < 0.15 ? 0 : random() < 0.5 ? 1 : float(random());
        p.r = p.a * float(random());
        p.g = p.a * float(random());
        p.b = p.a * float(random());
        return p;
    });
}

} // namespace sparselens
