#include "dof/border_reach.h"

#include "deep/build.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sparselens {

namespace {

constexpr float counts = 0.5f;    // of coverage: fainter samples blur unseen
constexpr float stands_out = 4;   // times what is around it
constexpr float smallest_coc = 2; // pixels: a lamp of less is no disc
constexpr std::size_t faint = 32; // all but one of so many

// visit(x, y) for the outermost pixels of a box.
template <typename Visit>
void for_each_border_pixel(const Imath::Box2i &box, const Visit &visit) {
    for (int x = box.min.x; x <= box.max.x; ++x) {
        visit(x, box.min.y);
        if (box.max.y > box.min.y) visit(x, box.max.y);
    }
    for (int y = box.min.y + 1; y < box.max.y; ++y) {
        visit(box.min.x, y);
        if (box.max.x > box.min.x) visit(box.max.x, y);
    }
}

int least_overscan(const Windows &windows) {
    const Imath::V2i before = windows.display.min - windows.data.min,
                     after = windows.data.max - windows.display.max;
    return std::min({before.x, before.y, after.x, after.y});
}

bool has_light_that_stands_out(std::vector<float> &all, const std::vector<float> &blurred) {
    if (all.empty() || blurred.empty()) return false;
    const auto limit = all.begin() + std::ptrdiff_t(all.size() - 1 - all.size() / faint);
    std::nth_element(all.begin(), limit, all.end());
    return std::ranges::any_of(blurred, [&](float light) { return light > stands_out * *limit; });
}

} // namespace

Ldi border_of(const PackedRows &rows) {
    const Imath::Box2i &data = rows.windows().data, &display = rows.windows().display;
    const auto in_border = [&](const Imath::V2i &p) {
        return display.intersects(p) &&
               (p.x == display.min.x || p.x == display.max.x || p.y == display.min.y || p.y == display.max.y);
    };
    constexpr int rows_at_once = 16;
    std::vector<Ldi> pieces;
    for (int first = data.min.y; first <= data.max.y; first += rows_at_once) {
        const Ldi some = rows.rows(first, std::min(first + rows_at_once - 1, data.max.y));
        pieces.push_back(build_by_pixels(some, [&](std::size_t pixel, Ldi &out) {
            if (!in_border(some.windows.pixel(pixel))) return;
            for (const std::uint64_t i : some.pixel(pixel)) append(out, some, i);
        }));
    }
    Ldi border = concatenate(pieces.front(), std::move(pieces));
    border.windows = rows.windows();
    return border;
}

BorderReach border_reach(const Ldi &ldi, const ThinLens &lens) {
    BorderReach reach{.rendered = least_overscan(ldi.windows)};
    if (reach.rendered < 0) return {};
    const std::size_t alpha = ldi.alpha();
    const auto rgb = find_rgb(ldi.channels);
    double largest = 0;
    std::vector<float> all, blurred; // the brightness of the samples
    for_each_border_pixel(ldi.windows.display, [&](int x, int y) {
        for (const std::uint64_t i : ldi.pixel(ldi.windows.index(x, y))) {
            if (alpha != npos && ldi.values[alpha][i] < counts) continue;
            const double coc = std::abs(circle_of_confusion(lens, ldi.optical_z(i)));
            largest = std::max(largest, coc);
            float light = 0;
            for (const std::size_t k : rgb)
                if (k != npos) light = std::max(light, ldi.values[k][i]);
            all.push_back(light);
            if (coc >= smallest_coc) blurred.push_back(light);
        }
    });
    reach.needed = int(std::ceil(std::min(largest * std::max(1.0, lens.pixel_aspect), 65536.0)));
    reach.bright = has_light_that_stands_out(all, blurred);
    return reach;
}

} // namespace sparselens
