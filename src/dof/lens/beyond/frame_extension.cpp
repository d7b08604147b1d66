#include "dof/lens/beyond/frame_extension.h"

#include "base/grid.h"
#include "base/light.h"
#include "deep/build.h"
#include "deep/proxy.h"
#include "deep/unseen.h"
#include "dof/lens/sample_blocks.h"
#include "dof/tuning.h"
#include "lens/lamp_spread.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace sparselens {

namespace {

constexpr int cell = GatherTuning::cell_px;
constexpr double sky = std::numeric_limits<double>::infinity();

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

// A sample that continues beyond the frame.
struct BorderSample {
    std::uint32_t sample;
    double depth; // disparity, in pixels of the lens from whose rim views looked
    int from;     // where it was seen last: pixels beyond the border
    float extent; // how far beyond that its small light reaches, pixels; infinite for all else

    // How much of its light goes on n pixels beyond the border.
    float light(int n) const {
        const float share = extent / float(n - from);
        return share >= 1 ? 1 : share * share;
    }
};

// At a pixel of the border.
struct BorderPixel {
    std::vector<BorderSample> leaving;
    bool open = true; // lets light through to infinity
    // The surface in front ends `ends` pixels beyond the border. Beyond its end, what lies behind it continues, as it
    // is `behind` pixels within the border.
    int ends = std::numeric_limits<int>::max(), behind = 0;
};

// A side of the frame.
struct FrameSide {
    Imath::V2i first, step, out; // its first pixel; from there to the next; away from the frame
    int count;                   // of pixels
    bool looked;                 // whether rim views looked past it

    // The pixel that is n pixels beyond the i-th.
    Imath::V2i pixel(int i, int n) const { return first + i * step + n * out; }
};

// Finds what leaves the frame at the pixels of its border: which samples, and how far the small lights among them
// continue.
class Border {
public:
    // As extend_beyond_frame().
    Border(const Ldi &ldi, const ThinLens &lens, int across, double views_radius)
        : ldi_(ldi), lens_(lens), across_(across), wider_(views_radius > 0 ? views_radius / lens.radius : 1),
          alpha_(ldi.alpha()), brightness_(light_channels(ldi).brightness) {}

    std::vector<BorderPixel> pixels(const FrameSide &side) const {
        // The brightness of the brightest sample of each pixel; -1: none.
        std::vector<float> bright(std::size_t(side.count), -1.0f);
        for (int i = 0; i < side.count; ++i)
            for (const std::uint64_t of : samples(side.pixel(i, 0)))
                bright[std::size_t(i)] = std::max(bright[std::size_t(i)], brightness(of));
        std::vector<BorderPixel> found(bright.size());
        for (int i = 0; i < side.count; ++i) {
            BorderPixel &pixel = found[std::size_t(i)];
            pixel.leaving = leaving(side, i,
                                    LampTuning::stands_out *
                                        level_around(bright, i, GatherTuning::border_along * across_));
            pixel.open = !closed(samples(side.pixel(i, 0)));
            if (!side.looked) find_end(pixel, side, i);
        }
        return found;
    }
    // Whether these samples of a pixel let no light through.
    bool closed(const SampleRange &range) const { return !lets_through(ldi_, alpha_, range); }
    // The samples of a pixel; none outside of the data window.
    SampleRange samples(const Imath::V2i &at) const {
        return ldi_.windows.data.intersects(at) ? ldi_.pixel(ldi_.windows.index(at)) : SampleRange{};
    }
    double depth(std::uint64_t sample) const { return disparity(lens_, double(ldi_.z[sample])); }

private:
    // How far rim views showed its surface beyond the frame, pixels.
    double shown_until(std::uint64_t sample) const { return wider_ * depth(sample); }

    std::vector<BorderSample> leaving(const FrameSide &side, int i, float level) const {
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
    // Whether no rim view looked farther at the surface of a sample, n pixels beyond the border; or looked only one
    // pixel farther and did not see it, because parallax may tear a surface.
    bool seen_last(std::uint64_t sample, const FrameSide &side, int i, int n) const {
        const double left = shown_until(sample) + 0.5 - n;
        return left < 1 || (left < 2 && !shows(samples(side.pixel(i, n + 1)), depth(sample)));
    }
    // The disparity of the first opaque sample of a pixel; below 0, and so behind all, if there is none.
    double front(const Imath::V2i &at) const {
        for (const std::uint64_t i : samples(at))
            if (is_opaque(alpha_at(ldi_, alpha_, i))) return depth(i);
        return -1;
    }
    // Finds how far the surface that the border cuts off continues. It is judged by other surfaces of the row that lie
    // in front of their surroundings, are as near, and are about as wide.
    void find_end(BorderPixel &of, const FrameSide &side, int i) const {
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
    // Whether any of these samples belongs to the surface at that disparity.
    bool shows(const SampleRange &range, double there) const {
        for (const std::uint64_t i : range)
            if (is_one_surface(depth(i), there)) return true;
        return false;
    }
    // The brightness of the brightest sample of the surface at that disparity.
    float light_at(const Imath::V2i &at, double there) const {
        float most = 0;
        for (const std::uint64_t i : samples(at))
            if (is_one_surface(depth(i), there)) most = std::max(most, brightness(i));
        return most;
    }
    // A sample n pixels beyond the border shows a part of a disc. Returns how far beyond the sample the disc reaches.
    float extent(const FrameSide &side, int at, int n, std::uint64_t sample, float level) const {
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
    float brightness(std::uint64_t i) const {
        float most = 0;
        for (const std::size_t k : brightness_) most = std::max(most, ldi_.values[k][i]);
        return most;
    }

    const Ldi &ldi_;
    const ThinLens &lens_;
    int across_;
    double wider_; // the radius of the lens from whose rim views looked, divided by this lens's
    std::size_t alpha_;
    std::vector<std::size_t> brightness_;
};

class Continuation {
public:
    Continuation(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &frame, const Imath::Box2i &known,
                 const Imath::V2i &reach, int across, double views_radius)
        : ldi_(ldi), frame_(frame), known_(known), border_(ldi, lens, across, views_radius),
          light_(light_channels(ldi).all) {
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
        for (const Imath::V2i &out : sides_of_pixel) add_side(out);
    }
    // Returns the samples that continue, and tells which pixels are known.
    Ldi samples(FrameExtension &made) const {
        made.known = grown_;
        made.unseen.assign(windows_.pixels(), 0);
        Ldi like = empty_like(ldi_);
        like.windows = windows_;
        return build_by_pixels(like, [&](std::size_t pixel, Ldi &out) {
            const Imath::V2i at = windows_.pixel(pixel);
            if (!frame_.intersects(at) && grown_.intersects(at)) made.unseen[pixel] = !add(at, out);
        });
    }

private:
    void add_side(const Imath::V2i &out) {
        const auto end = [&](const Imath::Box2i &of) { return std::max(of.min.dot(out), of.max.dot(out)); };
        FrameSide side{
            known_.min, {std::abs(out.y), std::abs(out.x)}, out, 0, end(ldi_.windows.data) > end(frame_)};
        if (out.x > 0) side.first.x = known_.max.x;
        if (out.y > 0) side.first.y = known_.max.y;
        side.count = (known_.size() + Imath::V2i(1)).dot(side.step);
        sides_.push_back({side, border_.pixels(side)});
    }
    // Samples, and how much of their light is left.
    using Pixel = std::vector<std::pair<std::uint64_t, float>>;

    // Adds what continues into a pixel. Returns whether it lets light through to infinity if it is empty.
    bool add(const Imath::V2i &at, Ldi &out) const {
        Pixel pixel; // its own samples come first
        const Imath::V2i nearest(std::clamp(at.x, known_.min.x, known_.max.x),
                                 std::clamp(at.y, known_.min.y, known_.max.y));
        const bool open =
            at.x == nearest.x || at.y == nearest.y ? go_on(at, pixel) : go_on_past_corner(at, nearest, pixel);
        const std::span added = std::span(pixel).subspan(border_.samples(at).size());
        std::ranges::stable_sort(added, {}, [&](const auto &of) { return ldi_.z[of.first]; });
        for (const auto &[sample, left] : added) {
            append(out, ldi_, sample);
            if (left < 1)
                for (const std::size_t k : light_) out.values[k].back() *= left;
        }
        return open;
    }
    static void add_all(const SampleRange &samples, Pixel &to) {
        for (const std::uint64_t i : samples) to.push_back({i, 1.0f});
    }
    // Finds what lies at a pixel beside the frame. Returns whether the pixel lets light through to infinity.
    bool go_on(const Imath::V2i &at, Pixel &pixel) const {
        const auto beyond = [&](const auto &of) { return (at - of.first.first).dot(of.first.out); };
        const auto &[side, pixels] = *std::ranges::max_element(sides_, {}, beyond);
        const int n = (at - side.first).dot(side.out), i = (at - side.first).dot(side.step);
        const BorderPixel &border = pixels[std::size_t(i)];
        if (n > border.ends) {
            const SampleRange behind = border_.samples(side.pixel(i, -border.behind));
            add_all(behind, pixel);
            return !border_.closed(behind);
        }
        const SampleRange own = border_.samples(at);
        add_all(own, pixel);
        if (border_.closed(own)) return border.open;
        const double shown = side.looked ? n - 0.5 : sky; // views showed all that is nearer
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
    std::vector<std::size_t> light_; // channels
    Imath::Box2i grown_;
    Windows windows_;
    std::vector<std::pair<FrameSide, std::vector<BorderPixel>>> sides_; // of the known part
};

} // namespace

FrameExtension extend_beyond_frame(Ldi ldi, const ThinLens &lens, const Imath::Box2i &frame,
                                   const Imath::Box2i &known, const Imath::V2i &reach, int across,
                                   double views_radius) {
    FrameExtension made;
    const Ldi added = Continuation(ldi, lens, frame, known, reach, across, views_radius).samples(made);
    made.ldi = padded(std::move(ldi), added.windows.data);
    insert_samples(made.ldi, added);
    return made;
}

} // namespace sparselens
