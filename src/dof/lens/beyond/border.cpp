#include "dof/lens/beyond/border.h"

#include "base/light.h"
#include "deep/build.h"
#include "deep/unseen.h"
#include "dof/lens/sample_blocks.h"
#include "dof/tuning.h"
#include "lens/lamp_spread.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

// How far a disc reaches beyond a line that cuts it over a length of `width`, if it is `inner` wide at a distance of
// `within` inside the line.
float disc_beyond(double width, double inner, double within) {
    const double half = width / 2, inner_half = inner / 2;
    // half^2 + y^2 == inner_half^2 + (y - within)^2
    const double y = ((inner_half - half) * (inner_half + half) / within + within) / 2; // of its middle
    return float(std::clamp(std::hypot(half, y) - y, 0.0, 2 * width));
}

float level_around(const std::vector<float> &bright, int at, int along_px) {
    std::vector<float> around;
    for (int i = std::max(at - along_px, 0); i <= std::min(at + along_px, int(bright.size()) - 1); ++i)
        if (bright[std::size_t(i)] >= 0) around.push_back(bright[std::size_t(i)]);
    return surroundings_of(around, LampTuning::one_in);
}

} // namespace

Border::Border(const Ldi &ldi, const ThinLens &lens, int across, double views_radius)
    : ldi_(ldi), lens_(lens), across_(across), wider_(views_radius > 0 ? views_radius / lens.radius : 1),
      alpha_(ldi.alpha()), brightness_(light_channels(ldi).brightness) {}

std::vector<BorderPixel> Border::pixels(const FrameSide &side) const {
    std::vector<float> bright(std::size_t(side.count),
                              -1.0f); // of the brightest sample of each pixel; -1: none
    for (int i = 0; i < side.count; ++i)
        for (const std::uint64_t of : samples(side.pixel(i, 0)))
            bright[std::size_t(i)] = std::max(bright[std::size_t(i)], brightness(of));
    std::vector<BorderPixel> found(bright.size());
    for (int i = 0; i < side.count; ++i) {
        BorderPixel &pixel = found[std::size_t(i)];
        pixel.leaving = leaving(
            side, i, LampTuning::stands_out * level_around(bright, i, GatherTuning::border_along * across_));
        pixel.open = !closed(samples(side.pixel(i, 0)));
        if (!side.looked) find_end(pixel, side, i);
    }
    return found;
}

std::vector<BorderSample> Border::leaving(const FrameSide &side, int i, float level) const {
    std::vector<BorderSample> found;
    for (int n = 0; ldi_.windows.data.intersects(side.pixel(i, n)) && (n == 0 || side.looked); ++n)
        for (const std::uint64_t of : samples(side.pixel(i, n))) {
            if (side.looked && !seen_last(of, side, i, n)) continue;
            const float reaches = brightness(of) > level ? extent(side, i, n, of, level)
                                                         : std::numeric_limits<float>::infinity();
            found.push_back({std::uint32_t(of), shown_until(of), n, reaches});
        }
    return found;
}

// Whether no rim view looked farther at the surface of a sample, n pixels beyond the border; or looked only one pixel
// farther and did not see it, because parallax may tear a surface.
bool Border::seen_last(std::uint64_t sample, const FrameSide &side, int i, int n) const {
    const double left = shown_until(sample) + 0.5 - n;
    return left < 1 || (left < 2 && !shows(samples(side.pixel(i, n + 1)), depth(sample)));
}

// The disparity of the first opaque sample of a pixel; below 0, and so behind all, if there is none.
double Border::front(const Imath::V2i &at) const {
    for (const std::uint64_t i : samples(at))
        if (is_opaque(alpha_at(ldi_, alpha_, i))) return depth(i);
    return -1;
}

// Finds how far the surface that the border cuts off continues. It is judged by other surfaces of the row that lie in
// front of their surroundings, are as near, and are about as wide.
void Border::find_end(BorderPixel &of, const FrameSide &side, int i) const {
    const double cut = front(side.pixel(i, 0));
    if (cut < 0) return;
    const int inwards = GatherTuning::border_inwards * across_;
    int width = 0, least = inwards;
    double last = cut;
    bool nearer = true; // whether the current surface is nearer than the one before it
    for (int from = 0, n = 1; n < inwards && ldi_.windows.data.intersects(side.pixel(i, -n)); ++n) {
        const double here = front(side.pixel(i, -n));
        if (!is_one_surface(here, last)) {
            const bool ends = nearer && here < last;
            if (from == 0 && !ends) return;
            if (from == 0)
                width = n;
            else if (ends && is_one_surface(last, cut) && n - from >= width - across_)
                least = std::min(least, n - from);
            nearer = here > last;
            from = n;
        }
        last = here;
    }
    if (least == inwards) return;
    of.ends = std::max(least - width, 0);
    of.behind = width;
}

bool Border::closed(const SampleRange &range) const { return !lets_through(ldi_, alpha_, range); }

// Whether any of these samples belongs to the surface at that disparity.
bool Border::shows(const SampleRange &range, double there) const {
    for (const std::uint64_t i : range)
        if (is_one_surface(depth(i), there)) return true;
    return false;
}

// The brightness of the brightest sample of the surface at that disparity.
float Border::light_at(const Imath::V2i &at, double there) const {
    float most = 0;
    for (const std::uint64_t i : samples(at))
        if (is_one_surface(depth(i), there)) most = std::max(most, brightness(i));
    return most;
}

// How far a disc reaches of which a sample, n pixels beyond the border, shows a part.
float Border::extent(const FrameSide &side, int at, int n, std::uint64_t sample, float level) const {
    const double there = depth(sample);
    const auto light = [&](int i, int row) {
        const float value = i < 0 || i >= side.count ? 0 : light_at(side.pixel(i, row), there);
        return value > level ? value : 0;
    };
    int first = at, last = at;
    const int along = GatherTuning::border_along * across_;
    while (first > at - along && light(first - 1, n) > 0) --first;
    while (last < at + along && light(last + 1, n) > 0) ++last;
    float most = 0;
    for (int i = first; i <= last; ++i) most = std::max(most, light(i, n));
    const auto width = [&](int row) { // the width if all of it were as bright
        double sum = 0;
        for (int i = 2 * first - last; i <= 2 * last - first; ++i)
            sum += double(std::min(light(i, row) / most, 1.0f));
        return sum;
    };
    const double here = width(n);
    for (const int within : {2 * across_, across_})
        if (const double inner = width(n - within); inner > 0) return disc_beyond(here, inner, within);
    return disc_beyond(here, 0, 0.5 * across_);
}

float Border::brightness(std::uint64_t i) const {
    float most = 0;
    for (const std::size_t k : brightness_) most = std::max(most, ldi_.values[k][i]);
    return most;
}

void WindowReach::add(const Imath::Box2i &window, const Imath::V2i &at, const Imath::V2d &by,
                      const Imath::V2d &shown) {
    const Imath::V2d beside = shown - Imath::V2d(at) - Imath::V2d(0.5);
    for (const int k : {0, 1}) {
        if (at[k] == window.min[k]) before[k] = std::max(before[k], by[k] - beside[k]);
        if (at[k] == window.max[k]) after[k] = std::max(after[k], by[k] + beside[k]);
    }
}

} // namespace sparselens
