#include "dof/lens/beyond/beyond_frame.h"

#include "base/parallel.h"
#include "deep/build.h"
#include "deep/packed/packed_rows.h"
#include "dof/facets/opaque.h"
#include "dof/lens/beyond/border_pixels.h"
#include "dof/lens/sample_colours.h"
#include "lens/reach/light_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace sparselens {

namespace {

constexpr int cell = 32;        // pixels: of highlights.cpp, in whole blocks
constexpr int along = 32;       // pixels on either side: what is around
constexpr float stands_out = 4; // times what four of five samples there stay below
constexpr int inwards = 2;      // pixels: where discs are measured a second time
constexpr double sky = std::numeric_limits<double>::infinity();

// A sample of a pixel at the border.
struct Leaving {
    std::uint32_t sample;
    double depth; // perceptive, pixels
    // Beyond the border, pixels, of the small light that it is part of.
    float extent = std::numeric_limits<float>::infinity();

    // How much of its light goes on n pixels beyond the border.
    float light(int n) const {
        const float share = extent / float(n);
        return share >= 1 ? 1 : share * share;
    }
};

// How far a disc reaches beyond the border that is so wide there and `inwards` pixels within.
float disc_beyond(int width, int inner) {
    const double half = width / 2.0, inner_half = inner / 2.0;
    // half^2 + y^2 == inner_half^2 + (y - inwards)^2
    const double y =
        ((inner_half - half) * (inner_half + half) / inwards + inwards) / 2; // of its middle, from the border
    return float(std::clamp(std::hypot(half, y) - y, 0.0, 2.0 * width));
}

struct BorderPixel {
    std::vector<Leaving> leaving; // front to back
    bool open = true;             // lets light through to infinity
};

// Reads what leaves the frame at pixels of its border.
class Border {
public:
    Border(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks)
        : ldi_(ldi), lens_(lens), light_(lens, looks, ldi.windows), alpha_(ldi.alpha()),
          brightness_(light_channels(ldi).brightness) {}

    // How far its light reaches.
    Imath::V2d reach(const Imath::V2i &at) const {
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
    // How far right and down lies what the magnified picture shows there.
    Imath::V2d shown_beside(const Imath::V2i &at) const {
        const Imath::V2d middle = Imath::V2d(at) + Imath::V2d(0.5);
        return light_.shown_at(middle) - middle;
    }
    // All of a side: from a pixel on, along `step`; the frame lies at `in`.
    std::vector<BorderPixel> side(const Imath::V2i &first, const Imath::V2i &step, const Imath::V2i &in,
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
    // Whether samples of that pixel leave no light.
    bool closed(const SampleRange &range) const {
        double transmittance = 1;
        for (const std::uint64_t i : range)
            transmittance *= 1 - double(std::clamp(alpha_at(ldi_, alpha_, i), 0.0f, 1.0f));
        return !lets_through(transmittance);
    }
    SampleRange samples(const Imath::V2i &at) const {
        return ldi_.windows.data.intersects(at) ? ldi_.pixel(ldi_.windows.index(at.x, at.y)) : SampleRange{};
    }

private:
    static float level_around(const std::vector<float> &bright, int at) {
        std::vector<float> around;
        for (int i = std::max(at - along, 0); i <= std::min(at + along, int(bright.size()) - 1); ++i)
            if (bright[std::size_t(i)] >= 0) around.push_back(bright[std::size_t(i)]);
        if (around.empty()) return 0;
        const auto level = around.end() - 1 - std::ptrdiff_t(around.size() / 5);
        std::nth_element(around.begin(), level, around.end());
        return *level;
    }
    // Of the surface of that sample of a pixel, what rim views saw farthest beyond the frame.
    Leaving outermost(std::uint32_t sample, Imath::V2i at, const Imath::V2i &out) const {
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
    std::optional<std::uint32_t> same_surface(const SampleRange &range, double there) const {
        for (const std::uint64_t i : range)
            if (std::abs(depth(i) - there) < one_surface_px) return std::uint32_t(i);
        return {};
    }
    // How far the disc reaches of which that pixel shows a part, brighter than that level.
    static float extent_above(const std::vector<float> &bright, const std::vector<float> &inner, int at,
                              float level) {
        const int from = std::max(at - along, 0), to = std::min(at + along, int(bright.size()) - 1);
        int first = at, last = at;
        while (first > from && bright[std::size_t(first) - 1] > level) --first;
        while (last < to && bright[std::size_t(last) + 1] > level) ++last;
        int width = 0; // two pixels inwards
        for (int i = std::max(2 * first - last, from); i <= std::min(2 * last - first, to); ++i)
            width += inner[std::size_t(i)] > level;
        return disc_beyond(last - first + 1, width);
    }
    // The brightest sample of each pixel; -1: none.
    std::vector<float> brightest(const Imath::V2i &first, const Imath::V2i &step, int count) const {
        std::vector<float> bright(std::size_t(count), -1.0f);
        for (int i = 0; i < count; ++i)
            for (const std::uint64_t of : samples(first + i * step))
                bright[std::size_t(i)] = std::max(bright[std::size_t(i)], brightness(of));
        return bright;
    }
    double depth(std::uint64_t i) const { return perceptive_depth(lens_, double(ldi_.z[i])); }
    float brightness(std::uint64_t i) const {
        float most = 0;
        for (const std::size_t k : brightness_) most = std::max(most, ldi_.values[k][i]);
        return most;
    }
    const Ldi &ldi_;
    const ThinLens &lens_;
    LightReach light_;
    std::size_t alpha_;
    std::vector<std::size_t> brightness_;
};

// The LDI of picked samples, and how much of their light is left.
struct Picked {
    std::vector<std::uint64_t> begin{0};
    std::vector<std::uint32_t> from;                     // [new sample]
    std::vector<std::pair<std::uint32_t, float>> dimmed; // new samples
};

std::vector<float> picked(const std::vector<float> &of, const std::vector<std::uint32_t> &from) {
    std::vector<float> values(of.empty() ? 0 : from.size());
    parallel_ranges(values.size(), 65536, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) values[i] = of[from[i]];
    });
    return values;
}

// `to` may be the same LDI.
void pick(const Ldi &of, Picked by, Ldi &to) {
    const std::vector<std::size_t> light = light_channels(of).all;
    to.channels = of.channels;
    to.values.resize(of.values.size());
    const std::vector<const std::vector<float> *> from = arrays_of(of);
    const std::vector<std::vector<float> *> into = arrays_of(to);
    for (std::size_t k = 0; k < from.size(); ++k) *into[k] = picked(*from[k], by.from);
    for (const auto &[sample, left] : by.dimmed)
        for (const std::size_t k : light) to.values[k][sample] *= left;
    to.begin = std::move(by.begin);
}

class Continuation {
public:
    Continuation(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks, const Imath::Box2i &frame,
                 const Imath::Box2i &known, const Imath::V2i &reach)
        : ldi_(ldi), frame_(frame), known_(known), border_(ldi, lens, looks) {
        grown_ = known;
        grown_.min.x -= reach.x;
        grown_.max.x += reach.x;
        if (known.min.y == frame.min.y) grown_.min.y -= reach.y;
        if (known.max.y == frame.max.y) grown_.max.y += reach.y;
        const auto whole = [](int of) { return pieces_of(of, cell) * cell; };
        windows_ = ldi.windows;
        const Imath::V2i corner = frame.min - Imath::V2i(whole(reach.x), whole(reach.y)); // whatever the band
        windows_.data.min = {std::min(ldi.windows.data.min.x, corner.x),
                             std::min(ldi.windows.data.min.y, corner.y)};
        windows_.data.extendBy(grown_.max);
        read_border();
    }
    void run(Ldi &to, BeyondFrame &made) {
        made.known = grown_;
        made.unseen.assign(windows_.pixels(), 0);
        const auto area = [](const Imath::Box2i &box) {
            return double(box.size().x + 1) * (box.size().y + 1);
        };
        picked_.from.reserve(std::size_t(double(ldi_.samples()) * area(grown_) / area(known_))); // about
        picked_.begin.reserve(windows_.pixels() + 1);
        for (int y = windows_.data.min.y; y <= windows_.data.max.y; ++y)
            for (int x = windows_.data.min.x; x <= windows_.data.max.x; ++x) {
                add(Imath::V2i(x, y), made);
                picked_.begin.push_back(picked_.from.size());
            }
        pick(ldi_, std::move(picked_), to);
        to.windows = windows_;
    }

private:
    enum Side { left, right, top, bottom };

    void read_border() {
        const Imath::V2i down(0, 1), across(1, 0);
        const Imath::V2i size = known_.size() + Imath::V2i(1);
        sides_[left] = border_.side(known_.min, down, across, size.y);
        sides_[right] = border_.side({known_.max.x, known_.min.y}, down, -across, size.y);
        sides_[top] = border_.side(known_.min, across, down, size.x);
        sides_[bottom] = border_.side({known_.min.x, known_.max.y}, across, -down, size.x);
        const Imath::Box2i &data = ldi_.windows.data;
        looked_[left] = data.min.x < frame_.min.x;
        looked_[right] = data.max.x > frame_.max.x;
        looked_[top] = data.min.y < frame_.min.y;
        looked_[bottom] = data.max.y > frame_.max.y;
    }
    void keep(std::uint32_t sample, float light = 1) {
        if (light < 1) picked_.dimmed.push_back({std::uint32_t(picked_.from.size()), light});
        picked_.from.push_back(sample);
    }
    void add(const Imath::V2i &at, BeyondFrame &made) {
        const SampleRange own = border_.samples(at);
        if (frame_.intersects(at) || !grown_.intersects(at)) {
            for (const std::uint64_t i : own) keep(std::uint32_t(i));
            return;
        }
        const Imath::V2i nearest(std::clamp(at.x, known_.min.x, known_.max.x),
                                 std::clamp(at.y, known_.min.y, known_.max.y));
        const Imath::V2i n(std::abs(at.x - nearest.x), std::abs(at.y - nearest.y));
        const Side side = n.x > 0 ? (at.x < nearest.x ? left : right) : (at.y < nearest.y ? top : bottom);
        const bool corner = n.x > 0 && n.y > 0;
        const BorderPixel &border =
            sides_[side][std::size_t(n.x > 0 ? nearest.y - known_.min.y : nearest.x - known_.min.x)];
        made.unseen[windows_.index(at.x, at.y)] = !border.open;
        const double shown = corner || !looked_[side] ? sky : n.x + n.y - 0.5; // what is no farther
        std::vector<std::pair<std::uint32_t, float>> pixel;
        for (const std::uint64_t i : own) pixel.push_back({std::uint32_t(i), 1.0f});
        if (!border_.closed(own))
            for (const Leaving &l : border.leaving)
                if (l.depth < shown) pixel.push_back({l.sample, l.light(std::max(n.x, n.y))});
        std::ranges::stable_sort(pixel, {}, [&](const auto &of) { return ldi_.z[of.first]; });
        for (const auto &[sample, light] : pixel) keep(sample, light);
    }

    const Ldi &ldi_;
    const Imath::Box2i frame_, known_;
    Border border_;
    Imath::Box2i grown_;
    Windows windows_;
    std::array<std::vector<BorderPixel>, 4> sides_; // along the known part's sides
    std::array<bool, 4> looked_{};                  // past it, rim views
    Picked picked_;
};

} // namespace

Imath::V2i look_beyond(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                       const Imath::Box2i &frame) {
    const Border border(ldi, lens, looks);
    Imath::V2d reach(0, 0);
    for_each_border_pixel(frame, [&](int x, int y) {
        const Imath::V2i at(x, y);
        const Imath::V2d by = border.reach(at), beside = border.shown_beside(at);
        if (at.x == frame.min.x) reach.x = std::max(reach.x, by.x - beside.x);
        if (at.x == frame.max.x) reach.x = std::max(reach.x, by.x + beside.x);
        if (at.y == frame.min.y) reach.y = std::max(reach.y, by.y - beside.y);
        if (at.y == frame.max.y) reach.y = std::max(reach.y, by.y + beside.y);
    });
    const Imath::V2i size = frame.size() + Imath::V2i(1);
    const double most = std::max(size.x, size.y) / 2.0;
    return {int(std::ceil(std::min(reach.x, most))), int(std::ceil(std::min(reach.y, most)))};
}

BeyondFrame go_on_beyond(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                         const Imath::Box2i &frame, const Imath::Box2i &known, const Imath::V2i &reach) {
    BeyondFrame made;
    Continuation(ldi, lens, looks, frame, known, reach).run(made.ldi, made);
    return made;
}

BeyondFrame go_on_beyond(Ldi &&ldi, const ThinLens &lens, const LensLooks &looks, const Imath::Box2i &frame,
                         const Imath::Box2i &known, const Imath::V2i &reach) {
    BeyondFrame made;
    Continuation(ldi, lens, looks, frame, known, reach).run(ldi, made);
    made.ldi = std::move(ldi);
    return made;
}

} // namespace sparselens
