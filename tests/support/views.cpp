#include "support/views.h"

#include "base/numbers.h"

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

namespace {

// Where the centre view shows the point at depth z on the ray of the view's pixel. The ray starts at the view's camera
// and passes through its picture plane, which is focal_px times zoom away and shifted by the view's principal point.
Imath::V2d followed(const Imath::V2d &pixel, double z, const Windows &windows, double focal_px,
                    const Imath::V2d &position, const Framing &framing) {
    const Imath::V2d middle =
        (Imath::V2d(windows.display.min) + Imath::V2d(windows.display.max) + Imath::V2d(1)) / 2;
    const double width = windows.display_width(), focal = focal_px * framing.zoom;
    const Imath::V2d aspect(1, double(windows.pixel_aspect));
    const Imath::V2d off = (pixel - middle) / aspect - width * framing.principal_point;
    const Imath::V2d point =
        Imath::V2d(position.x, -position.y) + off / focal * (z - framing.forward); // y down
    return middle + focal_px * point / z * aspect;
}

} // namespace

View TwoPlanes::view(const Windows &windows, const Imath::V2d &position, const Framing &framing) const {
    View view = make_view(windows, position, [&](int i, int j) {
        const double right = focal_px * position.x,
                     down = -focal_px * position.y * double(windows.pixel_aspect);
        const std::uint32_t place = mix_bits(std::uint32_t(i), mix_bits(std::uint32_t(j)));
        const std::uint32_t camera =
            mix_bits(std::uint32_t(int(right * 1024)), mix_bits(std::uint32_t(int(down * 1024))));
        const float change = noise * float(2 * unit_interval(mix_bits(place, camera)) - 1);
        const auto at = [&](double z) {
            return followed({i + 0.5, j + 0.5}, z, windows, focal_px, position, framing);
        };
        const Imath::V2d front = at(front_z), back = at(back_z);
        if (front_covers(front.x, front.y))
            return ViewPixel{.z = float(front_z), .r = front_red(front.x, front.y) + change};
        return ViewPixel{.z = float(back_z), .g = back_green(back.x, back.y) + change};
    });
    view.framing = framing;
    return view;
}

std::vector<View> five_views(const std::function<View(const Imath::V2d &u)> &view_from) {
    std::vector<View> views;
    for (const Imath::V2d &u : {Imath::V2d(0, 0), {1, 0}, {0, 1}, {-1, 0}, {0, -1}})
        views.push_back(view_from(u));
    return views;
}

std::vector<View> five_views(const TwoPlanes &scene, const Windows &windows, double radius) {
    return five_views([&](const Imath::V2d &u) { return scene.view(windows, radius * u); });
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
