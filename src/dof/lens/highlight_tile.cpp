#include "dof/lens/highlight_tile.h"

#include "lens/psf.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr double least_share = 1e-4; // what a cat-eye leaves less of is dark
constexpr float one_lamp = 1.1f;     // times as near: parts of one, at any aperture
constexpr double few = 3;            // pixels of CoC: discs that are smaller are shadowed in cells
constexpr double square_to = 1,
                 point_from =
                     2; // pixels of CoC: where light comes from a sample's square, and from its place
constexpr std::size_t last = LensTile::size - 1;

const Imath::Box2i tile({0, 0}, {int(last), int(last)});

// The pixels of the tile within `extent` of a place.
Imath::Box2i pixels_around(const Imath::V2d &place, const Imath::V2d &extent) {
    const auto pixel = [](double v) { return int(std::floor(std::clamp(v, -1.0, LensTile::size + 1.0))); };
    const Imath::V2d low = place - extent, high = place + extent;
    return {{std::max(pixel(low.x), 0), std::max(pixel(low.y), 0)},
            {std::min(pixel(high.x), int(last)), std::min(pixel(high.y), int(last))}};
}

// How wide the square is that a sample's light comes from.
double square_of(const Lamp &lamp) {
    return std::clamp((point_from - std::abs(lamp.coc)) / (point_from - square_to), 0.0, 1.0);
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
            const double square = square_of(lamp);
            const bool in_cells = std::abs(lamp.coc) < few;
            const LampCells *cells = in_cells ? &cells_of(lamp) : nullptr;
            reached_ =
                pixels_around(lamp.centre, square > 0 ? std::abs(lamp.coc) * half_extent_ +
                                                            (Imath::V2d(square) + cells->size(lamp)) * 0.5
                                                      : std::abs(lamp.coc) * half_extent_);
            if (reached_.isEmpty()) continue;
            const Screen screen = in_cells
                                      ? Screen{LampCells::middle(), cells->shadow_scale(lamp.pixel_aspect),
                                               LampCells::box(), true}
                                      : Screen{lamp.centre, Imath::V2d(lamp.coc), reached_};
            Spreading from{h, s, lamp, cast_shadows(s, lamp, screen, blocks)};
            if (square > 0) {
                spread_few(cells->shine(lamp, square, from.shadowed ? &shadow_ : nullptr, reached_), from);
                continue;
            }
            std::optional<LampLight> light;
            if (in_cells && from.shadowed) light = cells->shine(lamp, 0, &shadow_, reached_);
            from.few = light ? &*light : nullptr;
            disc ? spread_disc(from) : spread_shape(from);
        }
    }
}

const LampCells &HighlightTile::cells_of(const Lamp &lamp) {
    const bool behind = !(lamp.coc < 0);
    std::optional<LampCells> &cells = cells_[behind];
    if (shape_.cat_eye.cuts()) {
        Lamp in_picture = lamp;
        in_picture.centre += Imath::V2d(held_out_.corner + origin_);
        const LampCut cut = cut_of(shape_.cat_eye, shape_.aperture, in_picture);
        cells.emplace(shape_.aperture, behind, &cut);
    } else if (!cells) {
        cells.emplace(shape_.aperture, behind);
    }
    return *cells;
}

// False: there are none.
bool HighlightTile::cast_shadows(std::uint32_t lamp_sample, const Lamp &lamp, const Screen &screen,
                                 std::span<const std::uint32_t> blocks) {
    const float x = samples_.x[lamp_sample], y = samples_.y[lamp_sample], depth = samples_.depth[lamp_sample];
    // What is hardly nearer moves hardly, and hides the lamp only if it lies right before it.
    const float hardly = depth + float(one_surface_px);
    constexpr float beside = 2; // pixels
    const auto is_beside = [&](float left, float right, float top, float bottom) {
        return left < x + beside && right > x - beside && top < y + beside && bottom > y - beside;
    };
    bool any = false;
    for (const std::uint32_t b : blocks) {
        const SampleBlock &block = samples_.blocks[b];
        const float nearer_than =
            is_beside(block.x_min, block.x_max, block.y_min, block.y_max) ? depth : hardly;
        if (block.depth_max <= nearer_than || !can_shadow(block, lamp, screen)) continue;
        const BlockFootprints::Block &casting = footprints_.of(b);
        const NearBounds *near = casting.nearer_than(nearer_than);
        if (!near || !can_shadow(*near, lamp, screen)) continue;
        if (!any) shadow_.begin(screen.box, screen.fine);
        any = true;
        const std::uint32_t first = name_of(b, samples_.columns);
        for (std::uint32_t i = block.begin; i < block.end; ++i)
            if (samples_.depth[i] > hardly ||
                (samples_.depth[i] > depth &&
                 is_beside(samples_.x[i], samples_.x[i], samples_.y[i], samples_.y[i])))
                cast_shadow(lamp_sample, i, casting.footprints[i - block.begin], first + i - block.begin,
                            lamp, screen);
        if (shadow_.dark()) return true; // no other shadow changes that
    }
    return any;
}

// Whether a shadow of one of its samples may reach the screen.
template <typename Bounds>
bool HighlightTile::can_shadow(const Bounds &block, const Lamp &lamp, const Screen &screen) const {
    if (double(block.coc_min) <= lamp.coc && double(block.coc_max) >= lamp.coc) return true;
    const auto reaches = [&](int axis, double low, double high) {
        const double a = shadow_magnification(lamp.coc, double(block.coc_min), screen.scale[axis]),
                     b = shadow_magnification(lamp.coc, double(block.coc_max), screen.scale[axis]);
        const double half =
            std::max(std::abs(a), std::abs(b)); // a footprint reaches less than a pixel from its sample
        low -= origin_[axis] + lamp.centre[axis];
        high -= origin_[axis] + lamp.centre[axis];
        const auto [least, most] = std::minmax({a * low, a * high, b * low, b * high});
        return !(screen.middle[axis] + most + half < screen.box.min[axis] ||
                 screen.middle[axis] + least - half > screen.box.max[axis] + 1);
    };
    return reaches(0, double(block.x_min), double(block.x_max)) &&
           reaches(1, double(block.y_min), double(block.y_max));
}

// Whether it is another highlight's, of other pixels and no nearer than a part of the same lamp would be.
bool HighlightTile::are_side_by_side(std::uint32_t lamp_sample, std::uint32_t sample) const {
    const auto same = [&](const std::vector<float> &along) {
        return std::floor(along[lamp_sample]) == std::floor(along[sample]);
    };
    return samples_.depth[sample] <= one_lamp * samples_.depth[lamp_sample] &&
           !(same(samples_.x) && same(samples_.y)) && std::ranges::binary_search(highlights_.sample, sample);
}

void HighlightTile::cast_shadow(std::uint32_t lamp_sample, std::uint32_t sample, const Footprint &footprint,
                                std::uint32_t name, const Lamp &lamp, const Screen &screen) {
    const auto coc = float(lamp.coc);
    // Along each axis from where to where. Past an edge that is more blurred than the lamp it is the other way round.
    std::array<float, 2> low{-INFINITY, -INFINITY}, high{INFINITY, INFINITY};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t axis = k / 2;
        const float m = shadow_magnification(coc, footprint.coc[k], float(screen.scale[int(axis)]));
        const float edge =
            float(screen.middle[int(axis)]) +
            m * (footprint.place[k] - float(origin_[int(axis)]) - float(lamp.centre[int(axis)]));
        const bool from_edge_on = (k % 2 == 0) == (m > 0);
        if (from_edge_on)
            low[axis] = std::max(low[axis], edge);
        else
            high[axis] = std::min(high[axis], edge);
        if (std::isnan(edge)) return; // as blurred as the lamp, and right before it
    }
    const Imath::Box2f shadow({low[0], low[1]}, {high[0], high[1]});
    if (!(high[0] > float(screen.box.min.x) && low[0] <= float(screen.box.max.x) + 1 && high[0] > low[0] &&
          high[1] > float(screen.box.min.y) && low[1] <= float(screen.box.max.y) + 1 && high[1] > low[1]))
        return;
    const bool opaque = is_opaque(samples_.alpha[sample]);
    if (!opaque && are_side_by_side(lamp_sample, sample)) return;
    shadow_.hide(shadow, opaque ? 1 : samples_.alpha[sample], name);
}

// A disc of few pixels near the focus. Nothing of its light is hidden further.
void HighlightTile::spread_few(const LampLight &light, const Spreading &from) {
    const Spreading lit{from.highlight, from.sample, from.lamp};
    for (int y = light.box.min.y; y <= light.box.max.y; ++y)
        for (int x = light.box.min.x; x <= light.box.max.x; ++x) {
            const Float4 share = light.lit[light.at(x, y)];
            if (!(share[3] > 0)) continue;
            const std::array<double, 3> colours{double(share[0]), double(share[1]), double(share[2])};
            add_seen(lit, x, y, double(share[3]), shape_.aperture.coloured() ? &colours : nullptr);
        }
}

void HighlightTile::spread_disc(const Spreading &from) {
    const double squeeze = shape_.aperture.shape().squeeze;
    const double coc = std::abs(from.lamp.coc);
    const PsfRows rows({from.lamp.centre, coc / squeeze, from.lamp.pixel_aspect * squeeze}, tile);
    const LampDisc disc{from.lamp.centre, {coc / squeeze, coc * from.lamp.pixel_aspect}};
    std::array<double, PsfRows::max_size + 1> weights;
    for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
        const PsfRows::Span span = rows.row(y, weights.data());
        for (int x = span.begin; x < span.end; ++x)
            add(from, x, y, all_colours, weights[std::size_t(x)], &disc);
    }
}

void HighlightTile::spread_shape(const Spreading &from) {
    const Imath::V2i corner = held_out_.corner + origin_; // a cat-eye depends on the place in the picture
    Lamp lamp = from.lamp;
    lamp.centre += Imath::V2d(corner);
    const LampCut cut = cut_of(shape_.cat_eye, shape_.aperture, lamp);
    const LampSpread spread = spread_lamp(shape_.aperture, lamp, {corner, corner + tile.max},
                                          shape_.cat_eye.cuts() ? &cut : nullptr);
    std::size_t i = 0;
    for (int y = spread.box.min.y - corner.y; !spread.box.isEmpty() && y <= spread.box.max.y - corner.y; ++y)
        for (int x = spread.box.min.x - corner.x; x <= spread.box.max.x - corner.x; ++x, ++i)
            if (spread.weights[i] > 0)
                add_seen(from, x, y, spread.weights[i], spread.coloured ? &spread.colours[i] : nullptr);
}

// Past a cat-eye, by the share of the light that it leaves at a pixel. `colours`: null where all have the same weight.
void HighlightTile::add_seen(const Spreading &from, int x, int y, double weight,
                             const std::array<double, 3> *colours) {
    const bool cut = shape_.cat_eye.cuts() && !shape_.cat_eye.darkens();
    const double left = cut ? left_by_cat_eye(from.lamp.coc > 0, x, y) : 1;
    if (left < least_share) return;
    if (!colours) return add(from, x, y, all_colours, weight / left);
    add(from, x, y, red, (*colours)[0] / left);
    add(from, x, y, green, (*colours)[1] / left);
    add(from, x, y, blue, (*colours)[2] / left);
    add(from, x, y, coverage | data, weight / left);
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

// The share of a pixel's light that nothing hides.
float HighlightTile::lit(const Spreading &from, int x, int y, const LampDisc *disc) const {
    if (!from.shadowed || !reached_.intersects(Imath::V2i(x, y))) return 1;
    if (from.few) return from.few->lit_share(x, y);
    return disc ? shadow_.lit(x, y, *disc) : shadow_.lit(x, y);
}

void HighlightTile::add(const Spreading &from, int x, int y, unsigned of, double weight,
                        const LampDisc *disc) {
    float share = float(weight) * lit(from, x, y, disc);
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
