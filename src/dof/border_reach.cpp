#include "dof/border_reach.h"

#include "deep/build.h"
#include "dof/lens/beyond/border.h"
#include "dof/tuning.h"
#include "lens/lamp_spread.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sparselens {

namespace {

// Needed and rendered pixels of one side of the frame.
struct Side {
    int rendered;
    double reach;
    int needed() const { return int(std::ceil(std::min(reach, 65536.0))); }
};

bool has_less(const Side &a, const Side &b) {
    const int a_lacks = std::max(a.needed() - a.rendered, 0), b_lacks = std::max(b.needed() - b.rendered, 0);
    return a_lacks != b_lacks ? a_lacks < b_lacks : a.reach < b.reach;
}

bool has_light_that_stands_out(std::vector<float> &all, const std::vector<float> &blurred) {
    if (all.empty() || blurred.empty()) return false;
    const float around = surroundings_of(all, LampTuning::one_in_border);
    return std::ranges::any_of(blurred, [&](float light) { return stands_out(light, around); });
}

} // namespace

Ldi border_of(const PackedRows &rows) { return border_of(rows, rows.windows().display); }

Ldi border_of(const PackedRows &rows, const Imath::Box2i &window) {
    const Imath::Box2i &data = rows.windows().data;
    const auto in_border = [&](const Imath::V2i &p) {
        return window.intersects(p) &&
               (p.x == window.min.x || p.x == window.max.x || p.y == window.min.y || p.y == window.max.y);
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
    const Ldi like = empty_like(pieces.front());
    Ldi border = concatenate(like, std::move(pieces));
    border.windows = rows.windows();
    return border;
}

BorderReach border_reach(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks) {
    const Imath::V2i before = ldi.windows.display.min - ldi.windows.data.min,
                     after = ldi.windows.data.max - ldi.windows.display.max;
    if (std::min({before.x, before.y, after.x, after.y}) < 0) return {};
    const std::size_t alpha = ldi.alpha();
    const auto rgb = find_rgb(ldi.channels);
    const Imath::Box2i &display = ldi.windows.display;
    const LightReach light(lens, looks, ldi.windows);
    WindowReach reach;
    std::vector<float> all, blurred; // the brightness of the samples
    for_each_border_pixel(display, [&](int x, int y) {
        const Imath::V2d at(x + 0.5, y + 0.5), shown = light.shown_at(at);
        for (const std::uint64_t i : ldi.pixel(ldi.windows.index(x, y))) {
            if (alpha != npos && ldi.values[alpha][i] < GatherTuning::border_counts) continue;
            const double coc = circle_of_confusion(lens, ldi.coc_z(i));
            const Imath::V2d spread = light.at(at, coc);
            reach.add(display, {x, y}, spread, shown);
            float brightness = 0;
            for (const std::size_t k : rgb)
                if (k != npos) brightness = std::max(brightness, ldi.values[k][i]);
            all.push_back(brightness);
            if (std::max(spread.x, spread.y) >= GatherTuning::border_least_px) blurred.push_back(brightness);
        }
    });
    const Side worst = std::max<Side>({{before.x, reach.before.x},
                                       {after.x, reach.after.x},
                                       {before.y, reach.before.y},
                                       {after.y, reach.after.y}},
                                      has_less);
    return {worst.needed(), worst.rendered, has_light_that_stands_out(all, blurred)};
}

} // namespace sparselens
