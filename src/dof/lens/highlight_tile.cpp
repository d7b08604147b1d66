#include "dof/lens/highlight_tile.h"

#include "dof/tuning.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr double least_share = GatherTuning::cat_eye_least, few = GatherTuning::lamp_in_cells_px,
                 square_to = GatherTuning::lamp_square_to_px, point_from = GatherTuning::lamp_point_from_px;
constexpr std::size_t last = lens_tile_size - 1;

const Imath::Box2i tile({0, 0}, {int(last), int(last)});

// The pixels of the tile within `extent` of a position.
Imath::Box2i pixels_around(const Imath::V2d &place, const Imath::V2d &extent) {
    const auto pixel = [](double v) { return int(std::floor(std::clamp(v, -1.0, lens_tile_size + 1.0))); };
    const Imath::V2d low = place - extent, high = place + extent;
    return {{std::max(pixel(low.x), 0), std::max(pixel(low.y), 0)},
            {std::min(pixel(high.x), int(last)), std::min(pixel(high.y), int(last))}};
}

// How wide the square is that a sample's light comes from.
double square_of(const Lamp &lamp) {
    const double coc = std::abs(lamp.coc) + lamp.skew.length();
    return std::clamp((point_from - coc) / (point_from - square_to), 0.0, 1.0);
}

} // namespace

HighlightTile::HighlightTile(const GatherScene &scene, const CasterSets &casters)
    : scene_(scene), shadows_(scene.highlights, casters), half_extent_(aperture_.half_extent()),
      light_(sets_.size() * size * size), together_(light_.size()), whole_(sets_.size()),
      whole_together_(sets_.size()) {
    half_extent_.y *= scene.pixel_aspect();
}

bool HighlightTile::dark(int x, int y) const {
    for (std::size_t k = 0; k < sets_.size(); ++k)
        if (value(x, y, k) != 0) return false;
    return true;
}

void HighlightTile::spread(const Imath::V2i &origin, std::span<const std::uint32_t> blocks,
                           const CoarseCasters *coarse) {
    origin_ = origin;
    std::ranges::fill(light_, 0.0f);
    for (auto &left : left_by_cat_eye_) left.clear();
    if (highlights_.sample.empty()) return;
    shadows_.begin(origin, scene_.pixel_aspect(), half_extent_, coarse);
    const auto spread_all = [&](std::span<const std::uint32_t> group) {
        if (!scene_.optics->field.skews()) return spread_group(group);
        for (std::size_t n = 0; n < group.size(); ++n) spread_group(group.subspan(n, 1));
    };
    for (const std::uint32_t b : blocks) highlights_.groups.for_each(b, spread_all);
    for_each_moved(scene_, origin, spread_all);
    add_lit();
}

Lamp HighlightTile::lamp(std::uint32_t highlight) const {
    Lamp lamp = shadows_.lamp(highlight);
    lamp.skew = scene_.optics->skew(lamp.centre + Imath::V2d(held_out_.corner + origin_));
    return lamp;
}

// The pixels that the light of a highlight may reach.
Imath::Box2i HighlightTile::reach_of(const Lamp &lamp) {
    const double skew = lamp.skew.length(), beside = skew * std::max(half_extent_.x, half_extent_.y);
    const Imath::V2d disc = std::abs(lamp.coc) * half_extent_ + Imath::V2d(beside + (skew > 0 ? 1 : 0));
    const double square = square_of(lamp);
    if (!(square > 0)) return pixels_around(lamp.centre, disc);
    return pixels_around(lamp.centre, disc + (Imath::V2d(square) + cells_of(lamp).size(lamp)) * 0.5);
}

void HighlightTile::spread_group(std::span<const std::uint32_t> group) {
    reached_ = {};
    for (const std::uint32_t h : group) {
        const Imath::Box2i reach = reach_of(lamp(h));
        if (!reach.isEmpty()) reached_.extendBy(reach);
    }
    if (reached_.isEmpty()) return;
    shadows_.share(group, reached_);
    if (shadows_.dark()) return;
    for (const std::uint32_t h : group) spread_one(h);
    if (any_together_) add_group();
}

// Adds all highlights that share shadows, once for each pixel.
void HighlightTile::add_group() {
    for (std::size_t g = 0; g < sets_.size() / 4; ++g)
        for (int y = reached_.min.y; y <= reached_.max.y; ++y)
            for (int x = reached_.min.x; x <= reached_.max.x; ++x) {
                const std::size_t pixel = at(x, y, g * 4);
                store4(&light_[pixel], load4(&light_[pixel]) +
                                           shadows_.shared_lit(x, y) *
                                               (load4(&whole_together_[g * 4]) + load4(&together_[pixel])));
                store4(&together_[pixel], Float4{});
            }
    std::ranges::fill(whole_together_, 0.0f);
    any_together_ = false;
}

// Adds all discs that cover the whole tile and that nothing hides.
void HighlightTile::add_lit() {
    for (std::size_t g = 0; g < sets_.size() / 4; ++g) {
        const Float4 light = load4(&whole_[g * 4]);
        for (std::size_t pixel = at(0, 0, g * 4); pixel < at(0, 0, g * 4 + 4); pixel += 4)
            store4(&light_[pixel], load4(&light_[pixel]) + light);
    }
    std::ranges::fill(whole_, 0.0f);
}

void HighlightTile::spread_one(std::uint32_t highlight) {
    const Lamp lamp = this->lamp(highlight);
    const double square = square_of(lamp);
    const bool skewed = lamp.skew != Imath::V2d(0, 0), in_cells = skewed || std::abs(lamp.coc) < few;
    const LampCells *cells = in_cells ? &cells_of(lamp) : nullptr;
    const ShadowScreen screen =
        in_cells ? ShadowScreen{LampCells::middle(), cells->shadow_scale(lamp.pixel_aspect), LampCells::box(),
                                true}
                 : ShadowScreen{lamp.centre, Imath::V2d(lamp.coc), reached_};
    Spreading from{highlight, highlights_.sample[highlight], lamp, shadows_.cast(highlight, screen)};
    from.together = shadows_.only_shares();
    any_together_ = any_together_ || from.together;
    const LampShadow *shadow = in_cells && from.shadowed ? &shadows_.own() : nullptr;
    if (square > 0 || skewed) return spread_small(cells->shine(lamp, square, shadow, reached_), from);
    std::optional<LampLight> light;
    if (shadow) light = cells->shine(lamp, 0, shadow, reached_);
    from.few = light ? &*light : nullptr;
    aperture_.disc() && !cat_eye_.cuts() ? spread_disc(from) : spread_shape(from);
}

const LampCells &HighlightTile::cells_of(const Lamp &lamp) {
    const bool behind = !(lamp.coc < 0);
    std::optional<LampCells> &cells = cells_[behind];
    if (cat_eye_.cuts()) {
        Lamp in_picture = lamp;
        in_picture.centre += Imath::V2d(held_out_.corner + origin_);
        const LampCut cut = cut_of(cat_eye_, aperture_, in_picture);
        cells.emplace(aperture_, behind, &cut);
    } else if (!cells) {
        cells.emplace(aperture_, behind);
    }
    return *cells;
}

// Spreads a disc of few pixels near the focus. `light` is what is left after shadows.
void HighlightTile::spread_small(const LampLight &light, const Spreading &from) {
    const Spreading lit{from.highlight, from.sample, from.lamp};
    for (int y = light.box.min.y; y <= light.box.max.y; ++y)
        for (int x = light.box.min.x; x <= light.box.max.x; ++x) {
            const Float4 share = light.lit[light.at(x, y)];
            if (!(share[3] > 0)) continue;
            const std::array<double, 3> colours{double(share[0]), double(share[1]), double(share[2])};
            add_seen(lit, x, y, double(share[3]), aperture_.coloured() ? &colours : nullptr);
        }
}

void HighlightTile::spread_disc(const Spreading &from) {
    const double squeeze = aperture_.shape().squeeze;
    const double coc = std::abs(from.lamp.coc);
    const Psf psf{from.lamp.centre, coc / squeeze, from.lamp.pixel_aspect * squeeze};
    const LampDisc disc{from.lamp.centre, {coc / squeeze, coc * from.lamp.pixel_aspect}};
    const bool in_rows = !held_out_.by && (from.together || !from.shadowed);
    if (in_rows && disc.contains_pixels(tile)) return add_whole(from, psf.whole_weight());
    const PsfRows rows(psf, tile);
    const double inside = psf.whole_weight() * (1 - 1e-6);
    std::array<double, PsfRows::max_size + 1> weights;
    for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
        const PsfRows::Span span = rows.row(y, weights.data());
        for (int x = span.begin; x < span.end; ++x) {
            double &weight = weights[std::size_t(x)];
            if (in_rows && (weight >= inside || !from.together || waits(from, x, y, &disc))) continue;
            add(from, x, y, all_colours, weight, &disc);
            weight = 0;
        }
        if (in_rows) add_row(from, y, span.begin, span.end, weights.data());
    }
}

void HighlightTile::spread_shape(const Spreading &from) {
    const Imath::V2i corner = held_out_.corner + origin_; // a cat-eye depends on the position in the picture
    Lamp lamp = from.lamp;
    lamp.centre += Imath::V2d(corner);
    const LampCut cut = cut_of(cat_eye_, aperture_, lamp);
    const LampSpread spread =
        spread_lamp(aperture_, lamp, {corner, corner + tile.max}, cat_eye_.cuts() ? &cut : nullptr);
    std::size_t i = 0;
    for (int y = spread.box.min.y - corner.y; !spread.box.isEmpty() && y <= spread.box.max.y - corner.y; ++y)
        for (int x = spread.box.min.x - corner.x; x <= spread.box.max.x - corner.x; ++x, ++i)
            if (spread.weights[i] > 0)
                add_seen(from, x, y, spread.weights[i], spread.coloured ? &spread.colours[i] : nullptr);
}

// Adds light at a pixel, divided by the share of the lens that a cat-eye leaves there. `colours`: null if all channels
// have the same weight.
void HighlightTile::add_seen(const Spreading &from, int x, int y, double weight,
                             const std::array<double, 3> *colours) {
    const bool cut = cat_eye_.cuts() && !cat_eye_.darkens();
    const auto left_of = [&](std::size_t colour) {
        return cut ? left_by_cat_eye(from.lamp.coc > 0, x, y, colour) : 1;
    };
    const double left = left_of(1);
    if (left < least_share) return;
    if (!colours) return add(from, x, y, all_colours, weight / left);
    const auto add_colour = [&](ColourSet set, std::size_t colour) {
        const double left_there = aperture_.coloured_rims() ? left_of(colour) : left;
        if (left_there >= least_share) add(from, x, y, set, (*colours)[colour] / left_there);
    };
    add_colour(red, 0);
    add_colour(green, 1);
    add_colour(blue, 2);
    add(from, x, y, coverage | data, weight / left);
}

// The share of the light that a cat-eye leaves at a pixel.
double HighlightTile::left_by_cat_eye(bool behind, int x, int y, std::size_t colour) {
    std::vector<double> &shares = left_by_cat_eye_[colour * 2 + behind];
    const Imath::V2i corner = held_out_.corner + origin_;
    if (shares.empty())
        shares = cat_eye_.shares(behind ? CatEye::Light::behind : CatEye::Light::in_front,
                                 {corner, corner + tile.max}, colour);
    return shares[std::size_t(y) * size + std::size_t(x)];
}

// Whether the light in a pixel waits for the light of its group, to be shadowed with it. At the rim of a disc that a
// shadow crosses it does not wait, because the lit share there is its own.
bool HighlightTile::waits(const Spreading &from, int x, int y, const LampDisc *disc) const {
    return from.together && reached_.intersects(Imath::V2i(x, y)) &&
           !(disc && shadows_.is_shared_crossed(x, y) && !disc->contains_pixel(x, y));
}

// Like add() for each pixel, if nothing hides the lamp or if add_group() hides it later.
void HighlightTile::add_row(const Spreading &from, int y, int begin, int end, const double *weights) {
    std::vector<float> &sums = from.together ? together_ : light_;
    for (std::size_t g = 0; g < sets_.size() / 4; ++g) {
        const Float4 light =
            load4(&highlights_.light.values[(g * highlights_.light.count + from.highlight) * 4]);
        float *sum = &sums[at(begin, y, g * 4)];
        for (int x = begin; x < end; ++x, sum += 4) store4(sum, load4(sum) + float(weights[x]) * light);
    }
}

void HighlightTile::add_whole(const Spreading &from, double weight) {
    std::vector<float> &sums = from.together ? whole_together_ : whole_;
    for (std::size_t g = 0; g < sets_.size() / 4; ++g) {
        const Float4 light =
            load4(&highlights_.light.values[(g * highlights_.light.count + from.highlight) * 4]);
        store4(&sums[g * 4], load4(&sums[g * 4]) + float(weight) * light);
    }
}

// The share of a pixel's light that nothing hides.
float HighlightTile::lit(const Spreading &from, int x, int y, const LampDisc *disc) const {
    if (!from.shadowed || !reached_.intersects(Imath::V2i(x, y))) return 1;
    if (from.few) return from.few->lit_share(x, y);
    return shadows_.lit(x, y, disc);
}

void HighlightTile::add(const Spreading &from, int x, int y, unsigned of, double weight,
                        const LampDisc *disc) {
    const bool later = waits(from, x, y, disc);
    float share = later ? float(weight) : float(weight) * lit(from, x, y, disc);
    if (share <= 0) return;
    if (held_out_.by)
        share *= held_out_.passes(origin_ + Imath::V2i(x, y), scene_.samples.depth(from.sample));
    for (std::size_t g = 0; g < sets_.size() / 4; ++g) {
        std::array<float, 4> light; // a copy, which rules out that it overlaps sum
        std::copy_n(&highlights_.light.values[(g * highlights_.light.count + from.highlight) * 4], 4,
                    light.begin());
        for (std::size_t k = 0; k < 4 && of != all_colours; ++k)
            if (!(of & sets_[g * 4 + k])) light[k] = 0;
        float *sum = &(later ? together_ : light_)[at(x, y, g * 4)];
        for (std::size_t k = 0; k < 4; ++k) sum[k] += share * light[k];
    }
}

} // namespace sparselens
