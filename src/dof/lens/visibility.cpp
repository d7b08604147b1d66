#include "dof/lens/visibility.h"

#include "dof/facets/placed_facets.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

using namespace tile_cells;

static_assert(size == 64); // visibility.h

VisibilityPass::VisibilityPass(const GatherScene &scene, const TileTask &tile)
    : scene_(scene), tile_(tile), samples_(scene, tile), lens_(samples_.units(), {}), fillers_(count) {
    bounds_.set(tile.samples, scene.samples, samples_.units());
    filler_bounds_.set(tile.fillers, scene.fillers.samples, samples_.units());
    solid_bounds_.set(tile.solids, scene.solids, samples_.units());
    if (!samples_.images.words.empty()) images_.resize(count);
    for (Visibility &seen : seen_) {
        seen.rows = tile.size;
        seen.columns.fill({0, 0});
        std::fill_n(seen.columns.begin(), tile.size, CatEye::Columns{0, tile.size});
        seen.front.resize(count);
        seen.partial_cells.resize(samples_.partial.placed.words.size());
    }
}

// The steps of a lens point. Cracks and fillers are shown last, because finding them needs what the earlier steps
// found.
const Visibility &VisibilityPass::through(const LensSample &point) {
    Visibility &seen = seen_[next_++ % seen_.size()];
    lens_ = WholeLens(samples_.units(), point);
    see_columns(point, seen);
    std::fill(&seen.front[at(-border, -1)], &seen.front[at(-border, tile_.size + 1)], 0);
    see_opaque(point, samples_.opaque, bounds_, everywhere(), seen.front);
    // Facets close steep surfaces between their samples.
    const FacetGrid grid{float(tile_.origin.x) - (border - 1), float(tile_.origin.y) - (border - 1), stride,
                         tile_.size + 2 * (border - 1)};
    draw_facets(scene_.facets, tile_.facets, samples_.facets, point, grid, seen.front);
    // Solids hide what lies behind them (fillers.h).
    for_reached(point, samples_.solids, solid_bounds_, everywhere(), [&](std::uint16_t at, CellWord word) {
        CellWord &cell = seen.front[at];
        cell = cell == 0 ? 0 : std::max(cell, word);
    });
    see_images(seen);
    find_cracks(seen);
    see_fillers(point, seen);
    show(seen);
    const std::uint32_t partial = samples_.partial.placed.places.count();
    project_to_cells(lens_, samples_.partial.placed.places, 0, partial, seen.partial_cells.data());
    return seen;
}

void VisibilityPass::see_columns(const LensSample &point, Visibility &seen) const {
    if (!scene_.cat_eye()) return; // all pixels see through it, as set already
    const Imath::V2i first = scene_.held_out.corner + tile_.origin;
    for (int y = 0; y < tile_.size; ++y)
        seen.columns[std::size_t(y)] = scene_.cat_eye()->columns(point, first.x, tile_.size, first.y + y);
}

BlockBounds::Box VisibilityPass::box_of(const Cells &cells) const {
    const auto x = float(tile_.origin.x), y = float(tile_.origin.y);
    return {x + float(cells.left), x + float(cells.right), y + float(cells.top), y + float(cells.bottom)};
}

// Calls visit(cell, word) for places that follow each other, a few at once.
template <typename Visit>
[[gnu::always_inline]] inline void VisibilityPass::for_cells(const PlacedWords &placed, std::uint32_t begin,
                                                             std::uint32_t end, const Visit &visit) const {
    std::array<std::uint16_t, 1024> cells;
    for (; begin < end; begin += std::uint32_t(cells.size())) {
        const std::uint32_t some = std::min(std::uint32_t(cells.size()), end - begin);
        project_to_cells(lens_, placed.places, begin, some, cells.data());
        const CellWord *words = placed.words.data() + begin;
        for (std::uint32_t i = 0; i < some; ++i) visit(cells[i], words[i]);
    }
}

// The same for the blocks that a lens point brings into a box.
template <typename Visit>
[[gnu::always_inline]] inline void VisibilityPass::for_reached(const LensSample &point,
                                                               const PlacedWords &placed, BlockBounds &bounds,
                                                               const Cells &box, const Visit &visit) const {
    const std::span<const std::uint32_t> reached = bounds.reached(point, box_of(box));
    for (std::size_t n = 0; n < reached.size();) {
        const std::uint32_t first = reached[n];
        std::uint32_t end = first;
        while (n < reached.size() && reached[n] == end) ++n, ++end;
        for_cells(placed, placed.begin[first], placed.begin[end], visit);
    }
}

// Finds the nearest opaque sample in each of some cells.
void VisibilityPass::see_opaque(const LensSample &point, const PlacedWords &placed, BlockBounds &bounds,
                                const Cells &box, std::vector<CellWord> &front) const {
    CellWord *cells = front.data();
    for_reached(point, placed, bounds, box,
                [&](std::uint16_t at, CellWord word) { cells[at] = std::max(cells[at], word); });
}

// Finds the images that mirrors and glass show. An image shows only where its surface is seen.
void VisibilityPass::see_images(Visibility &seen) {
    if (images_.empty()) return;
    std::ranges::fill(images_, 0);
    for_cells(samples_.images, 0, samples_.images.places.count(),
              [&](std::uint16_t at, CellWord word) { images_[at] = std::max(images_[at], word); });
    seen.images = seen.front;
    for (int y = 0; y < tile_.size; ++y)
        for (int x = 0; x < tile_.size; ++x) seen.images[at(x, y)] = image_at(seen, at(x, y));
}

// Returns the word of the sample whose image shows in a cell; else of the front sample.
CellWord VisibilityPass::image_at(const Visibility &seen, std::size_t cell) const {
    const CellWord front = seen.front[cell];
    const std::uint32_t number = samples_.number_of(front);
    if (number == 0 || !scene_.samples.is_image(samples_.shown[number].sample)) return front;
    for (const std::size_t near : {cell, cell - 1, cell + 1, cell - stride, cell + stride}) {
        const std::uint32_t image = samples_.number_of(images_[near]);
        if (image != 0 && kernels::is_in_mirror(samples_.shown[image].depth, samples_.shown[number].depth))
            return CellWord(image);
    }
    return front;
}

// Finds empty cells, and cracks. These may lie in cells that are not empty: in even surfaces, cells between samples
// seldom stay empty, and show what is far behind instead.
void VisibilityPass::find_cracks(Visibility &seen) {
    cracks_.clear();
    const CellWord step = samples_.word_of(kernels::behind_crack(1, samples_.units().codes) - 1, 0);
    for (int y = 0; y < tile_.size; ++y) {
        const auto [begin, end] = seen.columns[std::size_t(y)];
        const std::uint64_t within = begin < end ? ~std::uint64_t{} >> (size - (end - begin)) << begin : 0;
        const CellWord *words = &seen.front[at(0, y)];
        std::uint64_t empty = zeros_of(words) & within, odd = empty;
        if (samples_.is_deep) odd |= far_behind(words, samples_.number_mask(), step) & within;
        for (; odd != 0; odd &= odd - 1) {
            const std::size_t cell = at(std::countr_zero(odd), y);
            const CellWord word = torn_at(seen, cell);
            if (word == 0) continue;
            cracks_.push_back({cell, word});
            empty &= ~(odd & -odd);
        }
        seen.unknown[std::size_t(y)] = empty;
    }
}

// Returns the word of the sample that shows through a crack at a cell; 0: there is no crack.
CellWord VisibilityPass::torn_at(const Visibility &seen, std::size_t cell) const {
    const std::uint32_t behind =
        kernels::behind_crack(samples_.code_of(seen.front[cell]), samples_.units().codes);
    CellWord farthest = 0;
    float farthest_depth = 0;
    for (const std::size_t step :
         {std::size_t{1}, std::size_t(stride), std::size_t(stride - 1), std::size_t(stride + 1)}) {
        const CellWord one = seen.front[cell - step], other = seen.front[cell + step];
        if (samples_.code_of(std::min(one, other)) <= behind) continue;
        const TileSamples::Shown &a = samples_.shown[samples_.number_of(one)],
                                 &b = samples_.shown[samples_.number_of(other)];
        const float depth = std::min(a.depth, b.depth);
        if (!kernels::is_crack(a.x - b.x, a.y - b.y, a.depth, b.depth) ||
            (farthest != 0 && depth >= farthest_depth))
            continue;
        farthest = a.depth <= b.depth ? one : other;
        farthest_depth = depth;
    }
    return farthest;
}

// Finds the fillers of empty cells that are not hidden.
void VisibilityPass::see_fillers(const LensSample &point, Visibility &seen) {
    std::uint64_t columns = 0;
    Cells box{0, tile_.size, 0, 0};
    for (int y = 0; y < tile_.size; ++y) {
        if (seen.unknown[std::size_t(y)] == 0) continue;
        columns |= seen.unknown[std::size_t(y)];
        box.top = std::min(box.top, y);
        box.bottom = y + 1;
    }
    if (columns == 0) return;
    box.left = std::countr_zero(columns);
    box.right = size - std::countl_zero(columns);
    std::fill(&fillers_[at(-border, box.top)], &fillers_[at(-border, box.bottom)], 0);
    see_opaque(point, samples_.fillers, filler_bounds_, box, fillers_);
    seen.for_each_unknown([&](std::size_t cell) {
        const CellWord filler = fillers_[cell];
        if (filler == 0 || hides(seen, cell, samples_.code_of(filler))) return;
        cracks_.push_back({cell, CellWord(samples_.number_of(filler))});
        seen.unknown[std::size_t(row(cell))] ^= std::uint64_t{1} << column(cell);
    });
}

// Whether something of this depth code is behind what a cell shows, or behind a surface that is torn there.
bool VisibilityPass::hides(const Visibility &seen, std::size_t cell, std::uint32_t code) const {
    const std::uint32_t limit = kernels::behind_filler(code, samples_.units().codes);
    const auto front = [&](std::size_t c) { return samples_.code_of(seen.front[c]) > limit; };
    return front(cell) || (front(cell - 1) && front(cell + 1)) ||
           (front(cell - stride) && front(cell + stride));
}

// Puts cracks and fillers into the cells, and nothing where pixels do not see through the lens point.
void VisibilityPass::show(Visibility &seen) const {
    for (auto *words : {&seen.front, &seen.images})
        for (const Crack &crack : cracks_)
            if (!words->empty()) (*words)[crack.cell] = crack.word;
    if (!scene_.cat_eye()) return;
    for (int y = 0; y < tile_.size; ++y)
        for (int x = 0; x < tile_.size; ++x) {
            if (seen.sees_through(x, y)) continue;
            seen.unknown[std::size_t(y)] |= std::uint64_t{1} << x;
            seen.front[at(x, y)] = 0;
            if (!seen.images.empty()) seen.images[at(x, y)] = 0;
        }
}

} // namespace sparselens
