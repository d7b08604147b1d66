#include "dof/lens/highlight_tile.h"

#include "lens/psf.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr double least_share = 1e-4; // what a cat-eye leaves less of is dark
constexpr std::size_t last = LensTile::size - 1;

const Imath::Box2i tile({0, 0}, {int(last), int(last)});

// The pixels of the tile within `extent` of a place.
Imath::Box2i pixels_around(const Imath::V2d &place, const Imath::V2d &extent) {
    const auto pixel = [](double v) { return int(std::floor(std::clamp(v, -1.0, LensTile::size + 1.0))); };
    const Imath::V2d low = place - extent, high = place + extent;
    return {{std::max(pixel(low.x), 0), std::max(pixel(low.y), 0)},
            {std::min(pixel(high.x), int(last)), std::min(pixel(high.y), int(last))}};
}

// Of the first sample of a block: the same wherever the tile lies, and in all frames.
std::uint32_t name_of(std::uint32_t block, int columns) {
    constexpr int blocks = LensTile::size / BlockedSamples::size;
    const int column = int(block) % columns % blocks, row = int(block) / columns % blocks;
    return std::uint32_t(row * blocks + column) << 10;
}

} // namespace

HighlightTile::HighlightTile(const Highlights &highlights, const BlockedSamples &samples,
                             const BlockFootprints &footprints, std::span<const ColourSet> sets,
                             const HighlightShape &shape, const HeldOut &held_out)
    : highlights_(highlights), samples_(samples), footprints_(footprints), sets_(sets.begin(), sets.end()),
      shape_(shape), held_out_(held_out), half_extent_(shape.aperture.half_extent()),
      light_(sets.size() * size * size) {
    half_extent_.y *= shape.pixel_aspect;
}

bool HighlightTile::dark(int x, int y) const {
    for (std::size_t k = 0; k < sets_.size(); ++k)
        if (value(x, y, k) != 0) return false;
    return true;
}

void HighlightTile::spread(const Imath::V2i &origin, std::span<const std::uint32_t> blocks) {
    origin_ = origin;
    std::ranges::fill(light_, 0.0f);
    for (auto &left : left_by_cat_eye_) left.clear();
    const bool disc = shape_.aperture.disc() && !shape_.cat_eye.cuts();
    const std::vector<std::uint32_t> &all = highlights_.sample;
    for (const std::uint32_t b : blocks) {
        const SampleBlock &block = samples_.blocks[b];
        auto h = std::uint32_t(std::ranges::lower_bound(all, block.begin) - all.begin());
        for (; h < all.size() && all[h] < block.end; ++h) {
            const std::uint32_t s = all[h];
            const Lamp lamp{Imath::V2d(double(samples_.x[s]), double(samples_.y[s])) - Imath::V2d(origin),
                            double(samples_.coc[s]), shape_.pixel_aspect};
            reached_ = pixels_around(lamp.centre, std::abs(lamp.coc) * half_extent_);
            if (reached_.isEmpty()) continue;
            const Spreading from{h, s, lamp, cast_shadows(s, lamp, blocks)};
            disc ? spread_disc(from) : spread_shape(from);
        }
    }
}

// False: there are none.
bool HighlightTile::cast_shadows(std::uint32_t lamp_sample, const Lamp &lamp,
                                 std::span<const std::uint32_t> blocks) {
    const float nearer_than = samples_.depth[lamp_sample] + float(one_surface_px);
    bool any = false;
    for (const std::uint32_t b : blocks) {
        const SampleBlock &block = samples_.blocks[b];
        if (block.depth_max <= nearer_than || !can_shadow(block, lamp)) continue;
        const BlockFootprints::Block &casting = footprints_.of(b);
        const NearBounds *near = casting.nearer_than(nearer_than);
        if (!near || !can_shadow(*near, lamp)) continue;
        if (!any) shadow_.begin(reached_);
        any = true;
        const std::uint32_t first = name_of(b, samples_.columns);
        for (std::uint32_t i = block.begin; i < block.end; ++i)
            if (samples_.depth[i] > nearer_than)
                cast_shadow(i, casting.footprints[i - block.begin], first + i - block.begin, lamp);
        if (shadow_.dark()) return true; // no other shadow changes that
    }
    return any;
}

// Whether a shadow of one of its samples may reach the pixels that the lamp does.
template <typename Bounds>
bool HighlightTile::can_shadow(const Bounds &block, const Lamp &lamp) const {
    if (double(block.coc_min) <= lamp.coc && double(block.coc_max) >= lamp.coc) return true;
    const double a = shadow_magnification(lamp.coc, double(block.coc_min)),
                 b = shadow_magnification(lamp.coc, double(block.coc_max));
    const double half =
        std::max(std::abs(a), std::abs(b)); // a footprint reaches less than a pixel from its sample
    const auto apart = [&](double low, double high, double centre, int first, int end) {
        const auto [least, most] =
            std::minmax({a * (low - centre), a * (high - centre), b * (low - centre), b * (high - centre)});
        return centre + most + half < first || centre + least - half > end;
    };
    return !apart(double(block.x_min) - origin_.x, double(block.x_max) - origin_.x, lamp.centre.x,
                  reached_.min.x, reached_.max.x + 1) &&
           !apart(double(block.y_min) - origin_.y, double(block.y_max) - origin_.y, lamp.centre.y,
                  reached_.min.y, reached_.max.y + 1);
}

void HighlightTile::cast_shadow(std::uint32_t sample, const Footprint &footprint, std::uint32_t name,
                                const Lamp &lamp) {
    const auto coc = float(lamp.coc);
    const std::array<float, 4> centre{float(lamp.centre.x), float(lamp.centre.x), float(lamp.centre.y),
                                      float(lamp.centre.y)},
        origin{float(origin_.x), float(origin_.x), float(origin_.y), float(origin_.y)};
    std::array<float, 4> edge;
    for (std::size_t k = 0; k < 4; ++k)
        edge[k] = centre[k] +
                  shadow_magnification(coc, footprint.coc[k]) * (footprint.place[k] - origin[k] - centre[k]);
    const auto [left, right] = std::minmax(edge[0], edge[1]);
    const auto [top, bottom] = std::minmax(edge[2], edge[3]);
    if (!(right > float(reached_.min.x) && left <= float(reached_.max.x) + 1 &&
          bottom > float(reached_.min.y) && top <= float(reached_.max.y) + 1))
        return; // no number where something is as blurred as the lamp
    const bool opaque = is_opaque(samples_.alpha[sample]);
    if (!opaque && std::ranges::binary_search(highlights_.sample, sample)) return;
    shadow_.hide({{left, top}, {right, bottom}}, opaque ? 1 : samples_.alpha[sample], name);
}

void HighlightTile::spread_disc(const Spreading &from) {
    const double squeeze = shape_.aperture.shape().squeeze;
    const PsfRows rows(
        {from.lamp.centre, std::abs(from.lamp.coc) / squeeze, from.lamp.pixel_aspect * squeeze}, tile);
    std::array<double, PsfRows::max_size + 1> weights;
    for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
        const PsfRows::Span span = rows.row(y, weights.data());
        for (int x = span.begin; x < span.end; ++x) add(from, x, y, all_colours, weights[std::size_t(x)]);
    }
}

void HighlightTile::spread_shape(const Spreading &from) {
    const bool cut = shape_.cat_eye.cuts();
    const Imath::V2i corner = held_out_.corner + origin_; // a cat-eye depends on the place in the picture
    Lamp lamp = from.lamp;
    lamp.centre += Imath::V2d(corner);
    const LampSpread spread =
        spread_lamp(shape_.aperture, lamp, {corner, corner + tile.max}, cut ? &shape_.cat_eye : nullptr);
    std::size_t i = 0;
    for (int y = spread.box.min.y - corner.y; !spread.box.isEmpty() && y <= spread.box.max.y - corner.y; ++y)
        for (int x = spread.box.min.x - corner.x; x <= spread.box.max.x - corner.x; ++x, ++i) {
            if (spread.weights[i] <= 0) continue;
            const double left = cut && !shape_.cat_eye.darkens() ? left_by_cat_eye(lamp.coc > 0, x, y) : 1;
            if (left < least_share) continue;
            if (!spread.coloured) {
                add(from, x, y, all_colours, spread.weights[i] / left);
                continue;
            }
            add(from, x, y, red, spread.colours[i][0] / left);
            add(from, x, y, green, spread.colours[i][1] / left);
            add(from, x, y, blue, spread.colours[i][2] / left);
            add(from, x, y, coverage | data, spread.weights[i] / left);
        }
}

// The share of the light that a cat-eye leaves at a pixel.
double HighlightTile::left_by_cat_eye(bool behind, int x, int y) {
    std::vector<double> &shares = left_by_cat_eye_[behind];
    const Imath::V2i corner = held_out_.corner + origin_;
    if (shares.empty())
        shares = shape_.cat_eye.shares(behind ? CatEye::Light::behind : CatEye::Light::in_front,
                                       {corner, corner + tile.max});
    return shares[std::size_t(y) * size + std::size_t(x)];
}

void HighlightTile::add(const Spreading &from, int x, int y, unsigned of, double weight) {
    float share = float(weight);
    if (from.shadowed && reached_.intersects(Imath::V2i(x, y))) share *= shadow_.lit(x, y);
    if (share <= 0) return;
    if (held_out_.by) share *= held_out_.passes(origin_ + Imath::V2i(x, y), samples_.depth[from.sample]);
    for (std::size_t g = 0; g < sets_.size() / 4; ++g) {
        std::array<float, 4> light; // a copy: the compiler need not fear that sum overlaps it
        std::copy_n(&highlights_.light.values[(g * highlights_.light.count + from.highlight) * 4], 4,
                    light.begin());
        for (std::size_t k = 0; k < 4 && of != all_colours; ++k)
            if (!(of & sets_[g * 4 + k])) light[k] = 0;
        float *sum = &light_[at(x, y, g * 4)];
        for (std::size_t k = 0; k < 4; ++k) sum[k] += share * light[k];
    }
}

} // namespace sparselens
