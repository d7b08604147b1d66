#include "dof/lens/visibility.h"

#include "base/parallel.h"
#include "dof/facets/placed_facets.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

using namespace tile_cells;

namespace {

static_assert(size == 64); // visibility.h

// Calls visit(begin, cells) for the opaque samples of a block, a few at once. `cells`: where the lens point sees the
// samples from `begin` on.
template <typename Visit>
[[gnu::always_inline]] inline void for_opaque(const TileProjection &projection, const BlockedSamples &samples,
                                              std::span<const float> coc, const SampleBlock &block,
                                              const Visit &visit) {
    std::array<std::int32_t, 256> cells;
    for (std::uint32_t begin = block.begin; begin < block.opaque_end; begin += std::uint32_t(cells.size())) {
        const std::uint32_t some = std::min(std::uint32_t(cells.size()), block.opaque_end - begin);
        project_to_cells(projection, &samples.x[begin], &samples.y[begin], &coc[begin], some, cells.data());
        visit(begin, std::span<const std::int32_t>(cells).first(some));
    }
}

} // namespace

VisibilityPass::VisibilityPass(const GatherScene &scene, const TileTask &tile) : scene_(scene), tile_(tile) {
    seen_.origin = tile.origin;
    seen_.rows = tile.size;
    seen_.columns.fill({0, 0});
    std::fill_n(seen_.columns.begin(), tile.size, CatEye::Columns{0, tile.size});
    seen_.front.resize(count);
    seen_.filler.resize(count);
    depths_.resize(count);
    is_deep_ = is_deep();
    bounds_.set(tile.samples, scene.samples);
    filler_bounds_.set(tile.fillers, scene.fillers.samples);
    solid_bounds_.set(tile.solids, scene.solids);
    seen_.partial = partial_samples_of(scene.samples, tile);
    seen_.partial_cells.resize(seen_.partial.count());
}

// The steps of a lens point. Cracks are closed last, because finding them needs the samples and fillers of the earlier
// steps.
const Visibility &VisibilityPass::through(const LensSample &point) {
    see_columns(point);
    see_opaque(point, scene_.samples, bounds_, everywhere(), seen_.front);
    see_facets(point);
    see_solids(point);
    see_images(point);
    find_empty();
    find_cracks();
    see_fillers(point);
    find_cracks_before_others();
    close_cracks();
    project_to_cells(projection(point), seen_.partial.x.data(), seen_.partial.y.data(),
                     seen_.partial.coc.data(), std::uint32_t(seen_.partial.count()),
                     seen_.partial_cells.data());
    return seen_;
}

// Whether a lens point may see something so far behind something else that a crack can lie between.
bool VisibilityPass::is_deep() const {
    if (!tile_.facets.empty() || !tile_.solids.empty()) return true;
    float nearest = 0, farthest = std::numeric_limits<float>::infinity();
    for (const std::uint32_t b : tile_.samples) {
        const SampleBlock &block = scene_.samples.blocks[b];
        for (std::uint32_t i = block.begin; i < block.opaque_end; ++i) {
            nearest = std::max(nearest, scene_.samples.depth(i));
            farthest = std::min(farthest, scene_.samples.depth(i));
        }
    }
    return nearest > farthest + kernels::behind_crack_px;
}

TileProjection VisibilityPass::projection(const LensSample &point) const {
    return {point, float(tile_.origin.x) - (border - 1), float(tile_.origin.y) - (border - 1), stride};
}

void VisibilityPass::see_columns(const LensSample &point) {
    if (!scene_.cat_eye()) return; // all pixels see through it, as set already
    const Imath::V2i first = scene_.held_out.corner + tile_.origin;
    for (int y = 0; y < tile_.size; ++y)
        seen_.columns[std::size_t(y)] = scene_.cat_eye()->columns(point, first.x, tile_.size, first.y + y);
}

BlockBounds::Box VisibilityPass::box_of(const Cells &cells) const {
    const auto x = float(tile_.origin.x), y = float(tile_.origin.y);
    return {x + float(cells.left), x + float(cells.right), y + float(cells.top), y + float(cells.bottom)};
}

// Finds the nearest opaque sample in each of some cells.
void VisibilityPass::see_opaque(const LensSample &point, const BlockedSamples &samples, BlockBounds &bounds,
                                const Cells &seen, std::vector<std::uint64_t> &front) const {
    std::fill(&front[at(-border, seen.top)], &front[at(-border, seen.bottom)], 0);
    const TileProjection to_cells = projection(point);
    for (const std::uint32_t b : bounds.reached(point, box_of(seen)))
        for_opaque(to_cells, samples, samples.hiding_coc(), samples.blocks[b],
                   [&](std::uint32_t begin, std::span<const std::int32_t> cells) {
                       const std::uint32_t *upper = &samples.upper[begin];
                       for (std::uint32_t i = 0; i < cells.size(); ++i) {
                           std::uint64_t &cell = front[std::size_t(cells[i])];
                           cell = std::max(cell, kernels::key_of(upper[i], begin + i));
                       }
                   });
}

// Draws facets, which close steep surfaces between their samples.
void VisibilityPass::see_facets(const LensSample &point) {
    const FacetGrid grid{float(tile_.origin.x) - (border - 1), float(tile_.origin.y) - (border - 1), stride,
                         tile_.size + 2 * (border - 1)};
    draw_facets(scene_.facets, tile_.facets, point, grid, seen_.front);
}

// Solids hide what lies behind them (fillers.h).
void VisibilityPass::see_solids(const LensSample &point) {
    if (tile_.solids.empty()) return;
    const BlockedSamples &solids = scene_.solids;
    const TileProjection to_cells = projection(point);
    for (const std::uint32_t b : solid_bounds_.reached(point, box_of(everywhere())))
        for_opaque(to_cells, solids, solids.coc, solids.blocks[b],
                   [&](std::uint32_t begin, std::span<const std::int32_t> cells) {
                       for (std::size_t i = 0; i < cells.size(); ++i) {
                           std::uint64_t &cell = seen_.front[std::size_t(cells[i])];
                           cell = cell == 0 ? 0 : std::max(cell, solids.key(begin + i));
                       }
                   });
}

// Finds the images that mirrors and glass show. An image shows only where its surface is seen.
void VisibilityPass::see_images(const LensSample &point) {
    seen_.images.clear();
    const auto shows_images = [&](std::uint32_t b) { return scene_.samples.blocks[b].shows_images; };
    if (scene_.samples.surface_coc.empty() || std::ranges::none_of(tile_.samples, shows_images)) return;
    image_.assign(count, 0);
    const TileProjection to_cells = projection(point);
    for (const std::uint32_t b : tile_.samples)
        if (shows_images(b)) find_images(to_cells, scene_.samples.blocks[b]);
    seen_.images = seen_.front;
    for (int y = 0; y < tile_.size; ++y)
        for (int x = 0; x < tile_.size; ++x) seen_.images[at(x, y)] = image_at(at(x, y));
}

void VisibilityPass::find_images(const TileProjection &projection, const SampleBlock &block) {
    const BlockedSamples &samples = scene_.samples;
    for_opaque(projection, samples, samples.coc, block,
               [&](std::uint32_t begin, std::span<const std::int32_t> cells) {
                   for (std::uint32_t i = 0; i < cells.size(); ++i) {
                       if (!samples.is_image(begin + i)) continue;
                       std::uint32_t &nearest = image_[std::size_t(cells[i])];
                       if (nearest == 0 || samples.coc[begin + i] < samples.coc[nearest - 1])
                           nearest = begin + i + 1;
                   }
               });
}

// Returns the key of the sample whose image shows in a cell; else the key of the front sample.
std::uint64_t VisibilityPass::image_at(std::size_t cell) const {
    const BlockedSamples &samples = scene_.samples;
    const std::uint64_t front = seen_.front[cell];
    if (front == 0 || !samples.is_image(std::uint32_t(front))) return front;
    const float depth = samples.depth(std::uint32_t(front));
    for (const std::size_t near : {cell, cell - 1, cell + 1, cell - stride, cell + stride}) {
        const std::uint32_t image = image_[near];
        if (image != 0 && kernels::is_in_mirror(samples.depth(image - 1), depth))
            return samples.key(image - 1);
    }
    return front;
}

void VisibilityPass::find_empty() {
    for (int y = 0; y < tile_.size; ++y) {
        const auto [begin, end] = seen_.columns[std::size_t(y)];
        const std::uint64_t within = begin < end ? ~std::uint64_t{} >> (size - (end - begin)) << begin : 0;
        seen_.empty[std::size_t(y)] = zeros_of(&seen_.front[at(0, y)]) & within;
    }
}

// Finds cracks; their cells are no longer empty.
void VisibilityPass::find_cracks() {
    cracks_.clear();
    seen_.for_each_empty([&](std::size_t cell) {
        const std::uint64_t key = torn_at(cell);
        if (key == 0) return;
        cracks_.push_back({std::uint32_t(cell), key});
        seen_.empty[std::size_t(row(cell))] ^= std::uint64_t{1} << column(cell);
    });
}

// Finds cracks in cells that are not empty: in even surfaces, cells between samples seldom stay empty, and show what is
// far behind instead.
void VisibilityPass::find_cracks_before_others() {
    if (!is_deep_) return;
    depths_of(std::span(seen_.front).first(at(-border, tile_.size + 1)), depths_.data());
    for (int y = 0; y < tile_.size; ++y) {
        const auto [begin, end] = seen_.columns[std::size_t(y)];
        for (std::uint64_t row = far_behind(&depths_[at(0, y)], stride); row != 0; row &= row - 1) {
            const int x = std::countr_zero(row);
            const std::size_t cell = at(x, y);
            if (seen_.front[cell] == 0 || x < begin || x >= end) continue;
            const std::uint64_t key = torn_at(cell);
            if (key != 0) cracks_.push_back({std::uint32_t(cell), key});
        }
    }
}

// Returns the key of the sample that shows through a crack at a cell; 0: there is no crack.
std::uint64_t VisibilityPass::torn_at(std::size_t cell) const {
    const std::uint32_t behind = kernels::behind_crack(kernels::upper_of(seen_.front[cell]));
    const BlockedSamples &samples = scene_.samples;
    const auto depth = [&](std::uint64_t key) { return samples.depth(std::uint32_t(key)); };
    std::uint64_t farthest = 0;
    for (const std::size_t step :
         {std::size_t{1}, std::size_t(stride), std::size_t(stride - 1), std::size_t(stride + 1)}) {
        const std::uint64_t one = seen_.front[cell - step], other = seen_.front[cell + step];
        if (std::min(kernels::upper_of(one), kernels::upper_of(other)) <= behind) continue;
        const std::uint32_t a = std::uint32_t(one), b = std::uint32_t(other);
        if (!kernels::is_crack(samples.x[a] - samples.x[b], samples.y[a] - samples.y[b], depth(one),
                               depth(other)))
            continue;
        const std::uint64_t farther = depth(one) <= depth(other) ? one : other;
        if (farthest == 0 || depth(farther) < depth(farthest)) farthest = farther;
    }
    return farthest;
}

// Finds the fillers of empty cells, and drops those that are hidden.
void VisibilityPass::see_fillers(const LensSample &point) {
    std::uint64_t columns = 0;
    Cells box{0, tile_.size, 0, 0};
    for (int y = 0; y < tile_.size; ++y) {
        if (seen_.empty[std::size_t(y)] == 0) continue;
        columns |= seen_.empty[std::size_t(y)];
        box.top = std::min(box.top, y);
        box.bottom = y + 1;
    }
    if (columns == 0) return;
    box.left = std::countr_zero(columns);
    box.right = size - std::countl_zero(columns);
    const BlockedSamples &fillers = scene_.fillers.samples;
    see_opaque(point, fillers, filler_bounds_, box, seen_.filler);
    seen_.for_each_empty([&](std::size_t cell) {
        std::uint64_t &filler = seen_.filler[cell];
        if (filler != 0 && hides(cell, fillers.depth(std::uint32_t(filler)))) filler = 0;
    });
}

// Whether something at this depth is behind what a cell shows, or behind a surface that is torn there.
bool VisibilityPass::hides(std::size_t cell, float depth) const {
    const std::uint32_t limit = kernels::behind_upper(depth);
    const auto front = [&](std::size_t c) { return kernels::upper_of(seen_.front[c]) > limit; };
    return front(cell) || (front(cell - 1) && front(cell + 1)) ||
           (front(cell - stride) && front(cell + stride));
}

void VisibilityPass::close_cracks() {
    for (const Crack &crack : cracks_) {
        seen_.front[crack.cell] = crack.key;
        if (!seen_.images.empty()) seen_.images[crack.cell] = crack.key;
    }
}

namespace {

using lens_kernel::border;

// Sorts by depth, the nearest first, then by index.
std::uint64_t order_key(float depth, std::uint32_t sample) {
    return (std::uint64_t(~std::bit_cast<std::uint32_t>(depth)) << 32) | sample;
}

} // namespace

PartialSamples partial_samples_of(const BlockedSamples &samples, const TileTask &tile) {
    float reach_x = 0, reach_y = 0, beside = border; // per pixel of CoC; and besides
    for (const LensSample &p : tile.lens) {
        reach_x = std::max(reach_x, std::abs(p.x));
        reach_y = std::max(reach_y, std::abs(p.y));
        beside = std::max({beside, border + std::abs(p.pixel_x), border + std::abs(p.pixel_y)});
    }
    const auto in_reach = [&](std::uint32_t i) {
        const float coc = std::abs(samples.coc[i]), x = samples.x[i] - float(tile.origin.x),
                    y = samples.y[i] - float(tile.origin.y);
        const float across = coc * reach_x + beside, down = coc * reach_y + beside;
        return x > -across && x < float(tile.size) + across && y > -down && y < float(tile.size) + down;
    };
    std::vector<std::uint64_t> order;
    for (const std::uint32_t b : tile.samples)
        for (std::uint32_t i = samples.blocks[b].opaque_end; i < samples.blocks[b].end; ++i)
            if (in_reach(i)) order.push_back(order_key(samples.depth(i), i));
    std::sort(order.begin(), order.end());
    PartialSamples partial;
    partial.sample.assign(order.begin(), order.end()); // the lower half
    const auto in_order = [&](auto &to, const auto &value) {
        to.resize(order.size());
        std::ranges::transform(partial.sample, to.begin(), value);
    };
    in_order(partial.x, [&](std::uint32_t i) { return samples.x[i]; });
    in_order(partial.y, [&](std::uint32_t i) { return samples.y[i]; });
    in_order(partial.coc, [&](std::uint32_t i) { return samples.coc[i]; });
    in_order(partial.depth, [&](std::uint32_t i) { return samples.depth(i); });
    in_order(partial.left, [&](std::uint32_t i) { return 1 - samples.alpha[i]; });
    in_order(partial.key, [&](std::uint32_t i) { return samples.key(i); });
    return partial;
}

namespace {

constexpr int half = 32;
constexpr std::array<std::uint32_t, half> one_bit = [] {
    std::array<std::uint32_t, half> bits{};
    for (std::size_t n = 0; n < half; ++n) bits[n] = std::uint32_t{1} << n;
    return bits;
}();

// Without a branch.
std::uint32_t bit_if(bool is_set, std::size_t n) { return (0 - std::uint32_t(is_set)) & one_bit[n]; }

[[gnu::always_inline]] inline std::uint32_t zeros_of_half(const std::uint64_t *keys) {
    std::uint32_t zeros = 0;
    for (std::size_t n = 0; n < half; ++n) zeros |= bit_if(kernels::upper_of(keys[n]) == 0, n);
    return zeros;
}

[[gnu::always_inline]] inline std::uint32_t far_behind_of_half(const float *depths, std::ptrdiff_t stride) {
    std::uint32_t far = 0;
    for (std::ptrdiff_t n = 0; n < std::ptrdiff_t(half); ++n) {
        const float *depth = depths + n;
        const float sides = std::max(std::min(depth[-1], depth[1]), std::min(depth[-stride], depth[stride])),
                    corners = std::max(std::min(depth[-stride - 1], depth[stride + 1]),
                                       std::min(depth[-stride + 1], depth[stride - 1]));
        far |= bit_if(std::max(sides, corners) > depth[0] + kernels::behind_crack_px, std::size_t(n));
    }
    return far;
}

} // namespace

FOR_PROCESSORS std::uint64_t zeros_of(const std::uint64_t *keys) {
    return std::uint64_t{zeros_of_half(keys + half)} << half | zeros_of_half(keys);
}

FOR_PROCESSORS void depths_of(std::span<const std::uint64_t> keys, float *depths) {
    const std::size_t end = keys.size(); // local copies rule out aliasing
    const std::uint64_t *key = keys.data();
    for (std::size_t i = 0; i < end; ++i) depths[i] = kernels::depth_of(kernels::upper_of(key[i]));
}

FOR_PROCESSORS std::uint64_t far_behind(const float *depths, std::ptrdiff_t pitch) {
    return std::uint64_t{far_behind_of_half(depths + half, pitch)} << half |
           far_behind_of_half(depths, pitch);
}

} // namespace sparselens
