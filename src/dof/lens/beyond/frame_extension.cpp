#include "dof/lens/beyond/frame_extension.h"

#include "base/grid.h"
#include "deep/build.h"
#include "deep/proxy.h"
#include "deep/unseen.h"
#include "dof/lens/beyond/border.h"
#include "dof/lens/sample_blocks.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

constexpr int cell = 32; // pixels: of highlights.cpp, in whole blocks
constexpr double sky = std::numeric_limits<double>::infinity();

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
        const SampleRange samples = samples_at(ldi, {x, y});
        for (const std::uint64_t i : samples) add(ldi.coc_z(i));
        if (lets_through(ldi, alpha, samples)) add(sky);
    });
    const Imath::V2i size = frame.size() + Imath::V2i(1);
    const double most = std::max(size.x, size.y) / 2.0;
    const auto pixels = [&](int k) {
        return int(std::ceil(std::min(std::max(reach.before[k], reach.after[k]), most)));
    };
    return {pixels(0), pixels(1)};
}

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
