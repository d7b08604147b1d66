#include "dof/lens/beyond/frame_extension.h"

#include "base/grid.h"
#include "base/parallel.h"
#include "deep/ldi.h"
#include "deep/packed_rows.h"
#include "deep/unseen.h"
#include "dof/lens/beyond/border.h"
#include "dof/lens/sample_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace sparselens {

// Samples picked from an LDI, and how much of their light is left.
struct SampleSubset {
    std::vector<std::uint64_t> begin{0};                 // of each pixel, as Ldi::begin
    std::vector<std::uint32_t> from;                     // [new sample]
    std::vector<std::pair<std::uint32_t, float>> dimmed; // new samples

    void keep(std::uint32_t sample, float light = 1) {
        if (light < 1) dimmed.push_back({std::uint32_t(from.size()), light});
        from.push_back(sample);
    }
    void end_pixel() { begin.push_back(from.size()); }
    // Keeps all samples of `count` consecutive pixels.
    void keep_pixels(const Ldi &of, std::size_t first, std::size_t count);
};

// Puts the picked samples of `of` into `to`, which may be the same LDI. The windows of `to` do not change.
void pick(const Ldi &of, SampleSubset by, Ldi &to);

namespace {

constexpr int cell = 32; // pixels: of highlights.cpp, in whole blocks
constexpr double sky = std::numeric_limits<double>::infinity();

class Continuation {
public:
    Continuation(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks, const Imath::Box2i &frame,
                 const Imath::Box2i &known, const Imath::V2i &reach, int across, double views_radius)
        : ldi_(ldi), frame_(frame), known_(known), border_(ldi, lens, looks, across, views_radius) {
        grown_ = known;
        grown_.min.x -= reach.x;
        grown_.max.x += reach.x;
        if (known.min.y == frame.min.y) grown_.min.y -= reach.y;
        if (known.max.y == frame.max.y) grown_.max.y += reach.y;
        const Imath::V2i beyond = ldi.windows.data.min - (frame.min - reach); // whatever the band
        const auto whole = [](int of) { return pieces_of(std::max(of, 0), cell) * cell; };
        windows_ = ldi.windows;
        windows_.data.min -= Imath::V2i(whole(beyond.x), whole(beyond.y));
        windows_.data.extendBy(grown_.max);
        read_border();
    }
    void run(Ldi &to, FrameExtension &made) {
        made.known = grown_;
        made.unseen.assign(windows_.pixels(), 0);
        const auto area = [](const Imath::Box2i &box) {
            return double(box.size().x + 1) * (box.size().y + 1);
        };
        picked_.from.reserve(std::size_t(double(ldi_.samples()) * area(grown_) / area(known_))); // about
        picked_.begin.reserve(windows_.pixels() + 1);
        for (int y = windows_.data.min.y; y <= windows_.data.max.y; ++y) add_row(y, made);
        pick(ldi_, std::move(picked_), to);
        to.windows = windows_;
    }

private:
    enum Side { left, right, top, bottom };

    void read_border() {
        const Imath::V2i down(0, 1), across(1, 0);
        const Imath::V2i size = known_.size() + Imath::V2i(1);
        const Imath::Box2i &data = ldi_.windows.data;
        looked_[left] = data.min.x < frame_.min.x;
        looked_[right] = data.max.x > frame_.max.x;
        looked_[top] = data.min.y < frame_.min.y;
        looked_[bottom] = data.max.y > frame_.max.y;
        sides_[left] = border_.side(known_.min, down, -across, size.y, looked_[left]);
        sides_[right] = border_.side({known_.max.x, known_.min.y}, down, across, size.y, looked_[right]);
        sides_[top] = border_.side(known_.min, across, -down, size.x, looked_[top]);
        sides_[bottom] = border_.side({known_.min.x, known_.max.y}, across, down, size.x, looked_[bottom]);
    }
    // Samples, and how much of their light is left.
    using Pixel = std::vector<std::pair<std::uint32_t, float>>;

    void add_row(int y, FrameExtension &made) {
        const Imath::Box2i &data = ldi_.windows.data;
        const int from = std::max(frame_.min.x, data.min.x), to = std::min(frame_.max.x, data.max.x);
        const bool in_frame =
            from <= to && y >= std::max(frame_.min.y, data.min.y) && y <= std::min(frame_.max.y, data.max.y);
        for (int x = windows_.data.min.x; x <= windows_.data.max.x; ++x)
            if (in_frame && x == from) {
                picked_.keep_pixels(ldi_, ldi_.windows.index(x, y), std::size_t(to - from + 1));
                x = to;
            } else {
                add(Imath::V2i(x, y), made);
                picked_.end_pixel();
            }
    }
    void add(const Imath::V2i &at, FrameExtension &made) {
        Pixel pixel;
        if (frame_.intersects(at) || !grown_.intersects(at)) {
            add_all(border_.samples(at), pixel);
        } else {
            const Imath::V2i nearest(std::clamp(at.x, known_.min.x, known_.max.x),
                                     std::clamp(at.y, known_.min.y, known_.max.y));
            const bool open = at.x == nearest.x || at.y == nearest.y ? go_on(at, pixel)
                                                                     : go_on_past_corner(at, nearest, pixel);
            made.unseen[windows_.index(at.x, at.y)] = !open;
            std::ranges::stable_sort(pixel, {}, [&](const auto &of) { return ldi_.z[of.first]; });
        }
        for (const auto &[sample, light] : pixel) picked_.keep(sample, light);
    }
    static void add_all(const SampleRange &samples, Pixel &to) {
        for (const std::uint64_t i : samples) to.push_back({std::uint32_t(i), 1.0f});
    }
    // Finds what lies at a pixel beside the frame. Returns whether the pixel lets light through to infinity.
    bool go_on(const Imath::V2i &at, Pixel &pixel) const {
        const bool across = at.x < known_.min.x || at.x > known_.max.x;
        const Side side =
            across ? (at.x < known_.min.x ? left : right) : (at.y < known_.min.y ? top : bottom);
        const int along = across ? at.y - known_.min.y : at.x - known_.min.x;
        const BorderPixel &border = sides_[side][std::size_t(along)];
        const int n = std::array{known_.min.x - at.x, at.x - known_.max.x, known_.min.y - at.y,
                                 at.y - known_.max.y}[side];
        if (n > border.ends) {
            const int in = (side == left || side == top ? 1 : -1) * (n + border.behind);
            const SampleRange behind = border_.samples(at + (across ? Imath::V2i(in, 0) : Imath::V2i(0, in)));
            add_all(behind, pixel);
            return !border_.closed(behind);
        }
        const SampleRange own = border_.samples(at);
        add_all(own, pixel);
        if (border_.closed(own)) return border.open;
        const double shown = looked_[side] ? n - 0.5 : sky; // views showed all that is nearer
        for (const BorderSample &l : border.leaving)
            if (l.from < n && l.depth < shown) pixel.push_back({l.sample, l.light(n)});
        return border.open;
    }
    // Samples continue if they are one surface both above or below the frame and beside it.
    bool go_on_past_corner(const Imath::V2i &at, const Imath::V2i &nearest, Pixel &pixel) const {
        Pixel above, beside;
        const bool open = go_on({nearest.x, at.y}, above);
        go_on({at.x, nearest.y}, beside);
        const SampleRange own = border_.samples(at);
        add_all(own, pixel);
        if (border_.closed(own)) return open;
        for (const auto &[sample, light] : above)
            for (const auto &[other, other_light] : beside)
                if (is_one_surface(border_.depth(sample), border_.depth(other))) {
                    pixel.push_back({sample, std::min(light, other_light)});
                    break;
                }
        return open;
    }

    const Ldi &ldi_;
    const Imath::Box2i frame_, known_;
    Border border_;
    Imath::Box2i grown_;
    Windows windows_;
    std::array<std::vector<BorderPixel>, 4> sides_; // along the sides of the known part
    std::array<bool, 4> looked_{};                  // whether rim views looked past the side
    SampleSubset picked_;
};

} // namespace

Imath::V2i look_beyond(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                       const Imath::Box2i &frame) {
    const Border border(ldi, lens, looks, 1);
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

FrameExtension extend_beyond_frame(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                                   const Imath::Box2i &frame, const Imath::Box2i &known,
                                   const Imath::V2i &reach, int across, double views_radius) {
    FrameExtension made;
    Continuation(ldi, lens, looks, frame, known, reach, across, views_radius).run(made.ldi, made);
    return made;
}

FrameExtension extend_beyond_frame(Ldi &&ldi, const ThinLens &lens, const LensLooks &looks,
                                   const Imath::Box2i &frame, const Imath::Box2i &known,
                                   const Imath::V2i &reach, int across, double views_radius) {
    FrameExtension made;
    Continuation(ldi, lens, looks, frame, known, reach, across, views_radius).run(ldi, made);
    made.ldi = std::move(ldi);
    return made;
}

namespace {

std::vector<float> picked(const std::vector<float> &of, const std::vector<std::uint32_t> &from) {
    std::vector<float> values(of.empty() ? 0 : from.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = of[from[i]];
    return values;
}

} // namespace

void SampleSubset::keep_pixels(const Ldi &of, std::size_t first, std::size_t count) {
    const std::uint64_t begin_of = of.begin[first], end_of = of.begin[first + count];
    const std::uint64_t before = from.size() - begin_of; // may wrap round
    for (std::uint64_t i = begin_of; i < end_of; ++i) from.push_back(std::uint32_t(i));
    for (std::size_t pixel = first; pixel < first + count; ++pixel)
        begin.push_back(before + of.begin[pixel + 1]);
}

void pick(const Ldi &of, SampleSubset by, Ldi &to) {
    const std::vector<std::size_t> light = light_channels(of).all;
    to.channels = of.channels;
    to.values.resize(of.values.size());
    const std::vector<const std::vector<float> *> from = arrays_of(of);
    const std::vector<std::vector<float> *> into = arrays_of(to);
    parallel_for(from.size(), [&](std::size_t k) { *into[k] = picked(*from[k], by.from); });
    for (const auto &[sample, left] : by.dimmed)
        for (const std::size_t k : light) to.values[k][sample] *= left;
    to.begin = std::move(by.begin);
}

} // namespace sparselens
