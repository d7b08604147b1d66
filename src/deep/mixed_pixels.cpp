#include "deep/mixed_pixels.h"

#include "base/parallel.h"
#include "view/flat_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sparselens {

namespace {
constexpr double least_contrast = 0.1; // between F and B, as a share of their own size
} // namespace

std::optional<Mix> unmix(const Imath::V3d &c, const Imath::V3d &f, const Imath::V3d &b, const MixPrior &prior,
                         double largest_residual) {
    const Imath::V3d contrast = f - b, offset = c - b;
    const double size = 0.5 * (f.dot(f) + b.dot(b)), distance = contrast.dot(contrast);
    if (distance <= least_contrast * least_contrast * size) return {};
    const double doubt = prior.weight * prior.weight * size;
    double share = std::clamp((offset.dot(contrast) + doubt * prior.share) / (distance + doubt), prior.least,
                              prior.most);
    const Imath::V3d rest = offset - share * contrast;
    const double residual = std::sqrt(rest.dot(rest) / distance);
    if (residual > largest_residual) return {};
    for (int k = 0; k < 3; ++k)
        if ((1 - share) * b[k] > c[k]) share = 1 - std::max(c[k], 0.0) / b[k];
    if (share > prior.most) return {};
    if (!(share >= least_mixed_share && share <= 1 - least_mixed_share)) return {}; // also if a colour is NaN
    return Mix{share, residual};
}

std::optional<VeilMix> unmix_veil(const Imath::V4d &c, const Imath::V4d &f, const Imath::V4d &b,
                                  double largest_residual) {
    // With a = c.alpha - m b.alpha and m = (1 - a) k: what c has more than F of that coverage is m times `contrast`.
    const Imath::V3d contrast = rgb(b) - b[3] * rgb(f), offset = rgb(c) - c[3] * rgb(f);
    const double size = 0.5 * (b[3] * b[3] * rgb(f).dot(rgb(f)) + rgb(b).dot(rgb(b))),
                 distance = contrast.dot(contrast);
    if (distance <= least_contrast * least_contrast * size) return {};
    double m = std::clamp(offset.dot(contrast) / distance, 0.0, c[3] / b[3]);
    for (int k = 0; k < 3; ++k)
        if (m * b[k] > c[k]) m = std::max(c[k], 0.0) / b[k];
    const double share = c[3] - m * b[3], density = m / (1 - share);
    if (!(share >= least_mixed_share && share <= 1 - least_mixed_share)) return {}; // also if a colour is NaN
    const double residual = (offset - m * contrast).length() / (rgb(f) - density * rgb(b)).length();
    if (!(residual <= largest_residual)) return {};
    return VeilMix{share, density, residual};
}

namespace {

constexpr double sky = 1e10;              // the depth that renderers write for sky, which a filter mixes in
constexpr double same_depth = 0.02;       // relative
constexpr int strand_steps = 4;           // of two pixels each: how far a strand may continue without a depth
constexpr double worth_of_coverage = 0.1; // against a relative difference of colours
constexpr double apart = 1.1;             // two surfaces: the ratio of their depths, at least
constexpr double least_of_step = 0.6;     // of the difference twice as far out; a slope has 0.5 of it
constexpr double clearly_mixed = 0.05;    // share of either surface in a depth, at least
constexpr double same_share = 0.15;       // largest difference of a surface's shares in depth and in colour
constexpr double largest_mix_residual =
    0.15;                            // distance of the colour from the line between the two, see unmix()
constexpr double least_mixed = 0.08; // of edges: filtered depth has 0.18 and more, other depth up to 0.04

bool shows_surface(const FlatPixels &pixels, std::size_t i) {
    return pixels.coverage(i) > 0 && std::isfinite(pixels.z[i]);
}

// The difference of two colours divided by their coverage.
double colour_difference(const FlatPixels &pixels, std::size_t a, std::size_t b) {
    return relative_difference(pixels.colour(a) / double(pixels.coverage(a)),
                               pixels.colour(b) / double(pixels.coverage(b)));
}

// The depths that the pixels around a partly covered one suggest.
struct Surroundings {
    float farthest = 0;   // depth of the pixels that cover more
    float best = 0;       // the depth of the pixel that explains it best; 0: there is none
    bool nothing = false; // whether a pixel around shows nothing
};

Surroundings look_around(const FlatPixels &pixels, int x, int y, int reach) {
    const ArrayGrid &grid = pixels.grid;
    const std::size_t own = grid.index(Position(x, y));
    const bool own_shows = shows_surface(pixels, own);
    Surroundings found;
    double least = std::numeric_limits<double>::infinity();
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, grid.height() - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, grid.width() - 1); ++u) {
            const std::size_t other = grid.index(Position(u, v));
            found.nothing = found.nothing || pixels.coverage(other) <= 0;
            if (other == own || !shows_surface(pixels, other)) continue;
            if (own_shows && !(pixels.coverage(other) > pixels.coverage(own))) continue;
            found.farthest = std::max(found.farthest, pixels.z[other]);
            const double cost = colour_difference(pixels, own, other) +
                                worth_of_coverage * (1 - double(pixels.coverage(other)));
            if (cost >= least) continue;
            least = cost;
            found.best = pixels.z[other];
        }
    return found;
}

std::optional<float> depth_of_partly_covered(const FlatPixels &pixels, int x, int y) {
    const std::size_t own = pixels.grid.index(Position(x, y));
    const float z = pixels.z[own];
    for (const int reach : {1, 2}) {
        const Surroundings around = look_around(pixels, x, y, reach);
        if (around.best == 0) continue;
        const double of_zeros = double(pixels.coverage(own)) * double(around.best);
        const bool mixed_with_zeros =
            around.nothing && std::abs(double(z) - of_zeros) < same_depth * of_zeros;
        const bool wrong = z > far_beyond * around.farthest || mixed_with_zeros;
        if (!wrong || std::abs(z - around.best) < same_depth * around.best) return {};
        return around.best;
    }
    return {};
}

// Two pixels on opposite sides of another, of surfaces that are clearly apart, and how much of the nearer one is in
// the depth of the pixel between.
struct Sides {
    std::size_t near, far;
    double share;
};

// Whether the depth between the two sides, which differ by `width`, is a step and not part of a slope. At a step they
// differ by hardly more twice as far out; on a slope of one surface they differ by twice as much there.
bool is_step(const FlatPixels &pixels, int x, int y, const Imath::V2i &step, double width) {
    const Position a = Position(x, y) - step * 2, b = Position(x, y) + step * 2;
    if (!pixels.grid.contains(a) || !pixels.grid.contains(b)) return false;
    const auto depth = [&](const Position &at) {
        return std::min(double(pixels.z[pixels.grid.index(at)]), sky);
    };
    return width > least_of_step * std::abs(depth(a) - depth(b));
}

std::optional<Sides> sides_of(const FlatPixels &pixels, int x, int y, const Imath::V2i &step) {
    const ArrayGrid &grid = pixels.grid;
    const Position own(x, y), before = own - step, after = own + step;
    if (!grid.contains(before) || !grid.contains(after)) return {};
    Sides sides{grid.index(before), grid.index(after), 0};
    if (pixels.z[sides.near] > pixels.z[sides.far]) std::swap(sides.near, sides.far);
    const double near = pixels.z[sides.near], far = std::min(double(pixels.z[sides.far]), sky);
    if (!(far > apart * near)) return {};
    if (!pixels.opaque(sides.near) || !pixels.opaque(sides.far)) return {};
    if (!is_step(pixels, x, y, step, far - near)) return {};
    sides.share = (far - double(pixels.z[grid.index(own)])) / (far - near);
    return sides;
}

// Whether the colour is mixed in the same proportion as the depth.
bool is_mixed(const FlatPixels &pixels, std::size_t own, const Sides &sides) {
    if (!(sides.share > clearly_mixed && sides.share < 1 - clearly_mixed)) return false;
    const auto mix = unmix(pixels.colour(own), pixels.colour(sides.near), pixels.colour(sides.far),
                           sides.share < 0.5 ? mostly_b : mostly_f, largest_mix_residual);
    return mix && std::abs(mix->share - sides.share) <= same_share;
}

// What edge_at() found at an opaque pixel: whether it lies between two surfaces, whether it mixes the pixels right
// beside it, and the depth of the surface that it shows more of. A filter may be wider than a pixel, so the pixels
// right beside it may be mixed themselves. If there are several mixtures, the one whose surfaces are farthest apart
// counts.
struct Edge {
    bool parted = false, mixed = false;
    std::optional<float> depth;
};

Edge edge_at(const FlatPixels &pixels, int x, int y) {
    constexpr std::array directions{Imath::V2i(1, 0), Imath::V2i(0, 1), Imath::V2i(1, 1), Imath::V2i(1, -1)};
    const std::size_t own = pixels.grid.index(Position(x, y));
    Edge edge;
    double widest = 0;
    for (const int distance : {1, 2})
        for (const Imath::V2i &direction : directions) {
            const auto sides = sides_of(pixels, x, y, direction * distance);
            if (!sides) continue;
            edge.parted = edge.parted || distance == 1;
            if (!is_mixed(pixels, own, *sides)) continue;
            edge.mixed = edge.mixed || distance == 1;
            const double width = 1 / double(pixels.z[sides->near]) - 1 / double(pixels.z[sides->far]);
            if (width <= widest) continue;
            widest = width;
            edge.depth = pixels.z[sides->share < 0.5 ? sides->far : sides->near];
        }
    return edge;
}

// How far edge_at() looks to either side, pixels.
constexpr int reach = 2;

// For each pixel of a row: whether the pixels around it show surfaces that are apart. Most do not, and cannot be edges.
std::vector<std::uint8_t> parted_around(const FlatPixels &pixels, int y) {
    constexpr float nearly_apart = 1.09f; // below `apart`, to allow for rounding
    const ArrayGrid &grid = pixels.grid;
    const auto width = std::size_t(grid.width());
    const int first = std::max(y - reach, 0), last = std::min(y + reach, grid.height() - 1);
    // The extremes along y. Beyond both ends of the row there is nothing.
    std::vector<float> least(width + 2 * reach, std::numeric_limits<float>::infinity()),
        most(width + 2 * reach, -std::numeric_limits<float>::infinity());
    for (int other = first; other <= last; ++other) {
        const float *z = &pixels.z[grid.index(Position(0, other))];
        float *near = &least[reach], *far = &most[reach];
        for (std::size_t x = 0; x < width; ++x) {
            near[x] = z[x] < near[x] ? z[x] : near[x];
            far[x] = z[x] > far[x] ? z[x] : far[x];
        }
    }
    std::vector<std::uint8_t> parted(width);
    for (std::size_t x = 0; x < width; ++x) {
        float near = least[x], far = most[x];
        for (std::size_t i = 1; i <= 2 * reach; ++i) {
            near = least[x + i] < near ? least[x + i] : near;
            far = most[x + i] > far ? most[x + i] : far;
        }
        parted[x] = std::min(far, float(sky)) > nearly_apart * near;
    }
    return parted;
}

// A thin strand shows its depth in few of its pixels. The others, if they lie beside nothing, take their depths from
// one another, two pixels farther at a time. Returns their number.
std::size_t repair_strands(const FlatPixels &pixels, std::vector<std::size_t> lost, std::span<float> z) {
    std::size_t count = 0;
    for (int farther = 0; farther < strand_steps && !lost.empty(); ++farther) {
        std::vector<std::size_t> left;
        std::vector<std::pair<std::size_t, float>> found;
        for (const std::size_t i : lost) {
            const Position at = pixels.grid.position(i);
            const Surroundings around = look_around(pixels, at.column, at.row, 2);
            if (around.best != 0 && around.nothing)
                found.emplace_back(i, around.best);
            else
                left.push_back(i);
        }
        for (const auto &[i, depth] : found) z[i] = depth;
        count += found.size();
        lost = std::move(left);
    }
    return count;
}

// The findings in a row of pixels.
struct Row {
    std::vector<std::pair<std::size_t, float>> partly_covered, opaque; // pixels, and their new depths
    std::vector<std::size_t> lost; // partly covered, with no depth within two pixels
    std::size_t parted = 0, mixed = 0;
};

Row row_at(const FlatPixels &pixels, int y) {
    Row row;
    const std::vector<std::uint8_t> parted = parted_around(pixels, y);
    for (int x = 0; x < pixels.grid.width(); ++x) {
        const std::size_t own = pixels.grid.index(Position(x, y));
        if (pixels.coverage(own) <= 0) continue;
        if (!pixels.opaque(own)) {
            if (const auto depth = depth_of_partly_covered(pixels, x, y))
                row.partly_covered.emplace_back(own, *depth);
            else if (!std::isfinite(pixels.z[own]))
                row.lost.push_back(own);
            continue;
        }
        if (!parted[std::size_t(x)]) continue;
        const Edge edge = edge_at(pixels, x, y);
        row.parted += edge.parted;
        row.mixed += edge.mixed;
        if (edge.depth) row.opaque.emplace_back(own, *edge.depth);
    }
    return row;
}

// Replaces all depths at once, so that none is taken from a depth that was replaced before it.
RepairedEdges repair(const FlatPixels &pixels, std::span<float> z) {
    std::vector<Row> rows(std::size_t(pixels.grid.height()));
    parallel_for(rows.size(), [&](std::size_t y) { rows[y] = row_at(pixels, int(y)); });
    std::size_t count = 0, parted = 0, mixed = 0;
    std::vector<std::size_t> lost;
    const auto replace = [&](const auto &changes) {
        for (const auto &[i, depth] : changes) z[i] = depth;
        count += changes.size();
    };
    for (const Row &row : rows) {
        parted += row.parted;
        mixed += row.mixed;
        replace(row.partly_covered);
        lost.insert(lost.end(), row.lost.begin(), row.lost.end());
    }
    count += repair_strands(pixels, std::move(lost), z);
    const double usual =
        least_mixed * double(parted); // at most, and more by chance: three standard deviations
    const bool filtered = double(mixed) > usual + 3 * std::sqrt(usual);
    for (const Row &row : rows)
        if (filtered) replace(row.opaque);
    return {count, filtered};
}

} // namespace

RepairedEdges repair_edge_depths(View &view) { return repair(flat_pixels(view), view.z); }

RepairedEdges repair_edge_depths(Ldi &ldi) {
    const auto plane = [&](std::size_t k) { return std::span<const float>(ldi.values[k]); };
    return repair(flat_pixels(ldi.windows, ldi.channels, ldi.z, plane), ldi.z);
}

std::string edge_note(std::size_t repaired) {
    return repaired == 1
               ? "1 pixel on an edge takes the depth of the surface it shows"
               : fmt::format("{} pixels on edges take the depth of the surface they show", repaired);
}

} // namespace sparselens
