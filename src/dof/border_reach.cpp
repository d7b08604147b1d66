#include "dof/border_reach.h"

#include "base/grid.h"
#include "deep/build.h"
#include "dof/tuning.h"
#include "lens/lamp_spread.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sparselens {

namespace {

// How far light reaches beyond the sides of a window, pixels: to the left and up, to the right and down.
struct WindowReach {
    Imath::V2d before{0, 0}, after{0, 0};

    // Adds the light of a pixel of the border, which reaches `by` pixels from where the picture shows it.
    void add(const Imath::Box2i &window, const Imath::V2i &at, const Imath::V2d &by,
             const Imath::V2d &shown) {
        const Imath::V2d beside = shown - Imath::V2d(at) - Imath::V2d(0.5);
        for (const int k : {0, 1}) {
            if (at[k] == window.min[k]) before[k] = std::max(before[k], by[k] - beside[k]);
            if (at[k] == window.max[k]) after[k] = std::max(after[k], by[k] + beside[k]);
        }
    }
};

// Calls visit(x, y) once for each of the outermost pixels of a window.
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
        for (const std::uint64_t i : ldi.pixel(ldi.windows.index(Imath::V2i(x, y)))) {
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

Imath::V2i look_beyond(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                       const Imath::Box2i &frame) {
    const LightReach light(lens, looks, ldi.windows);
    const std::size_t alpha = ldi.alpha();
    WindowReach reach;
    for_each_border_pixel(frame, [&](int x, int y) {
        const Imath::V2d at(x + 0.5, y + 0.5), shown = light.shown_at(at);
        const auto add = [&](double z) {
            reach.add(frame, {x, y}, light.at(at, circle_of_confusion(lens, z)), shown);
        };
        const bool is_there = ldi.windows.data.intersects(Imath::V2i(x, y));
        const SampleRange samples = is_there ? ldi.pixel(ldi.windows.index(Imath::V2i(x, y))) : SampleRange{};
        for (const std::uint64_t i : samples) add(ldi.coc_z(i));
        if (lets_through(ldi, alpha, samples)) add(std::numeric_limits<double>::infinity());
    });
    const Imath::V2i size = frame.size() + Imath::V2i(1);
    const int most = pieces_of(std::max(size.x, size.y), 2), step = GatherTuning::border_step;
    const auto pixels = [&](int k) {
        const double needed = std::min(std::max(reach.before[k], reach.after[k]), double(most));
        return std::min(pieces_of(int(std::ceil(needed)), step) * step, most);
    };
    return {pixels(0), pixels(1)};
}

} // namespace sparselens
