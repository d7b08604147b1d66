#include "dof/lens/beyond/border.h"

#include "deep/build.h"
#include "dof/facets/opaque.h"
#include "dof/lens/sample_colours.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr int along = 32;       // pixels on either side: what is around
constexpr float stands_out = 4; // times what four of five samples there stay below
constexpr int inwards = 2;      // pixels: where discs are measured a second time
constexpr double sky = std::numeric_limits<double>::infinity();

// How far a disc reaches beyond the border that is so wide there and `inwards` pixels within.
float disc_beyond(int width, int inner) {
    const double half = width / 2.0, inner_half = inner / 2.0;
    // half^2 + y^2 == inner_half^2 + (y - inwards)^2
    const double y =
        ((inner_half - half) * (inner_half + half) / inwards + inwards) / 2; // of its middle, from the border
    return float(std::clamp(std::hypot(half, y) - y, 0.0, 2.0 * width));
}

float level_around(const std::vector<float> &bright, int at) {
    std::vector<float> around;
    for (int i = std::max(at - along, 0); i <= std::min(at + along, int(bright.size()) - 1); ++i)
        if (bright[std::size_t(i)] >= 0) around.push_back(bright[std::size_t(i)]);
    if (around.empty()) return 0;
    const auto level = around.end() - 1 - std::ptrdiff_t(around.size() / 5);
    std::nth_element(around.begin(), level, around.end());
    return *level;
}

// How far the disc reaches of which that pixel shows a part, brighter than that level.
float extent_above(const std::vector<float> &bright, const std::vector<float> &inner, int at, float level) {
    const int from = std::max(at - along, 0), to = std::min(at + along, int(bright.size()) - 1);
    int first = at, last = at;
    while (first > from && bright[std::size_t(first) - 1] > level) --first;
    while (last < to && bright[std::size_t(last) + 1] > level) ++last;
    int width = 0; // two pixels inwards
    for (int i = std::max(2 * first - last, from); i <= std::min(2 * last - first, to); ++i)
        width += inner[std::size_t(i)] > level;
    return disc_beyond(last - first + 1, width);
}

} // namespace

Border::Border(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks)
    : ldi_(ldi), lens_(lens), light_(lens, looks, ldi.windows), alpha_(ldi.alpha()),
      brightness_(light_channels(ldi).brightness) {}

Imath::V2d Border::reach(const Imath::V2i &at) const {
    const Imath::V2d middle = Imath::V2d(at) + Imath::V2d(0.5);
    Imath::V2d most(0, 0);
    const auto add = [&](double z) {
        const Imath::V2d reach = light_.at(middle, circle_of_confusion(lens_, z));
        most = {std::max(most.x, reach.x), std::max(most.y, reach.y)};
    };
    for (const std::uint64_t i : samples(at)) add(ldi_.optical_z(i));
    if (!closed(samples(at))) add(sky);
    return most;
}

Imath::V2d Border::shown_beside(const Imath::V2i &at) const {
    const Imath::V2d middle = Imath::V2d(at) + Imath::V2d(0.5);
    return light_.shown_at(middle) - middle;
}

std::vector<BorderPixel> Border::side(const Imath::V2i &first, const Imath::V2i &step, const Imath::V2i &in,
                                      int count) const {
    const std::vector<float> bright = brightest(first, step, count),
                             inner = brightest(first + inwards * in, step, count);
    std::vector<BorderPixel> found;
    for (int i = 0; i < count; ++i) {
        const SampleRange here = samples(first + i * step);
        const float level = stands_out * level_around(bright, i);
        found.push_back({{}, !closed(here)});
        for (const std::uint64_t of : here)
            if (brightness(of) > level)
                found.back().leaving.push_back(
                    {std::uint32_t(of), depth(of), extent_above(bright, inner, i, level)});
            else
                found.back().leaving.push_back(outermost(std::uint32_t(of), first + i * step, -in));
    }
    return found;
}

bool Border::closed(const SampleRange &range) const {
    double transmittance = 1;
    for (const std::uint64_t i : range)
        transmittance *= 1 - double(std::clamp(alpha_at(ldi_, alpha_, i), 0.0f, 1.0f));
    return !lets_through(transmittance);
}

// Of the surface of that sample of a pixel, what rim views saw farthest beyond the frame.
Leaving Border::outermost(std::uint32_t sample, Imath::V2i at, const Imath::V2i &out) const {
    Leaving last{sample, depth(sample)};
    for (int n = 1; double(n) <= last.depth + 0.5; ++n) {
        const auto next = same_surface(samples(at += out), last.depth);
        if (!next || !is_opaque(alpha_at(ldi_, alpha_, *next))) break;
        last.sample = *next;
        last.depth = depth(*next);
    }
    return last;
}

// The first one of these samples that is of the surface at that perceptive depth.
std::optional<std::uint32_t> Border::same_surface(const SampleRange &range, double there) const {
    for (const std::uint64_t i : range)
        if (std::abs(depth(i) - there) < one_surface_px) return std::uint32_t(i);
    return {};
}

// The brightest sample of each pixel; -1: none.
std::vector<float> Border::brightest(const Imath::V2i &first, const Imath::V2i &step, int count) const {
    std::vector<float> bright(std::size_t(count), -1.0f);
    for (int i = 0; i < count; ++i)
        for (const std::uint64_t of : samples(first + i * step))
            bright[std::size_t(i)] = std::max(bright[std::size_t(i)], brightness(of));
    return bright;
}

float Border::brightness(std::uint64_t i) const {
    float most = 0;
    for (const std::size_t k : brightness_) most = std::max(most, ldi_.values[k][i]);
    return most;
}

} // namespace sparselens
