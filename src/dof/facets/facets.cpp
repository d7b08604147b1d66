#include "dof/facets/facets.h"

#include "base/parallel.h"
#include "base/subpixels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sparselens {

namespace {

// Four pixels that meet in a corner: from (x, y) to (x + 1, y + 1).
class Corner {
public:
    Corner(const Links &links, const Position &at, float steep) : links_(links), at_(at), steep_(steep) {}

    void find(std::vector<Facet> &found) const {
        links_.for_each_opaque(at_, [&](const LinkedSample &a) { add_from(a, found); });
    }

private:
    // Adds the facets that have sample `a` of the upper left pixel, and a sample beside it or below.
    void add_from(const LinkedSample &a, std::vector<Facet> &found) const {
        constexpr std::array step{Imath::V2i(1, 0), Imath::V2i(0, 1)};
        const LinkedSample right = links_.linked(a, at_, step[0]), below = links_.linked(a, at_, step[1]);
        const LinkedSample over = links_.linked(right, at_ + step[0], step[1]);
        const LinkedSample beside = links_.linked(below, at_ + step[1], step[0]);
        if (over.found() && over.sample == beside.sample) {
            add(found, a, right, over);
            add(found, a, over, below);
            return;
        }
        if (right.found() && below.found()) add(found, a, right, below);
        if (over.found()) add(found, a, right, over);
        if (beside.found()) add(found, a, beside, below);
    }

    void add(std::vector<Facet> &found, const LinkedSample &a, const LinkedSample &b,
             const LinkedSample &c) const {
        const auto [least, most] = std::minmax({a.depth, b.depth, c.depth});
        if (most - least >= steep_) found.push_back({{a.sample, b.sample, c.sample}});
    }

    const Links &links_;
    Position at_;
    float steep_;
};

// The range of the depths of a pixel's opaque samples; without samples, least > most.
struct DepthRange {
    float least = INFINITY, most = -INFINITY;
};

std::vector<DepthRange> ranges_of_row(const Links &links, const Windows &windows, int y) {
    std::vector<DepthRange> ranges(std::size_t(windows.width()));
    for (int x = 0; x < windows.width(); ++x)
        links.for_each_opaque(Position(x, y), [&](const LinkedSample &s) {
            DepthRange &range = ranges[std::size_t(x)];
            range = {std::min(range.least, s.depth), std::max(range.most, s.depth)};
        });
    return ranges;
}

// The facets of one row of blocks.
std::vector<std::vector<Facet>> find_in_row(const Links &links, const Windows &windows, int block_row,
                                            float steep) {
    constexpr int size = FacetBlocks::size;
    std::vector<std::vector<Facet>> found(std::size_t((windows.width() + size - 1) / size));
    const int end = std::min((block_row + 1) * size, windows.height() - 1);
    std::vector<DepthRange> upper = ranges_of_row(links, windows, block_row * size), lower;
    for (int y = block_row * size; y < end; ++y, upper.swap(lower)) {
        lower = ranges_of_row(links, windows, y + 1);
        for (int x = 0; x + 1 < windows.width(); ++x) {
            const std::size_t i = std::size_t(x);
            const float least =
                std::min({upper[i].least, upper[i + 1].least, lower[i].least, lower[i + 1].least});
            const float most = std::max({upper[i].most, upper[i + 1].most, lower[i].most, lower[i + 1].most});
            if (most - least >= steep) Corner(links, Position(x, y), steep).find(found[i / size]);
        }
    }
    std::erase_if(found, [](const auto &block) { return block.empty(); });
    return found;
}

} // namespace

FacetBlocks find_facets(const Ldi &ldi, const ThinLens &lens, double widest) {
    const Links links(ldi, lens);
    const float steep = float(steep_px / widest);
    const int rows = pieces_of(ldi.windows.height(), FacetBlocks::size);
    return {joined(std::size_t(rows),
                   [&](std::size_t row) { return find_in_row(links, ldi.windows, int(row), steep); })};
}

LinkedSample Links::nearest(const Position &pixel, float depth) const {
    LinkedSample found;
    for_each_opaque(pixel, [&](const LinkedSample &s) {
        if (!found.found() || std::abs(s.depth - depth) < std::abs(found.depth - depth)) found = s;
    });
    return found;
}

// Returns the sizes of the next two steps of depth along the surface, as long as they have the sign of `expected`; else
// 0. Both are 0 if the surface goes on level, because what has the expected depth is then a layer behind it.
Links::Steps Links::steps_beyond(const LinkedSample &from, const Position &pixel, const Imath::V2i &step,
                                 float expected) const {
    Steps steps{0, 0};
    if (kernels::is_one_surface(nearest(pixel + step, from.depth).depth, from.depth, steep_px)) return steps;
    LinkedSample last = from;
    for (std::size_t n = 0; n < steps.size(); ++n) {
        const LinkedSample next = nearest(pixel + int(n + 1) * step, last.depth + expected);
        if (!next.found() || (next.depth - last.depth) * expected <= 0) break;
        expected = next.depth - last.depth;
        steps[n] = std::abs(expected);
        last = next;
    }
    return steps;
}

LinkedSample Links::linked(const LinkedSample &a, const Position &pixel, const Imath::V2i &step) const {
    if (!a.found()) return a;
    const LinkedSample b = nearest(pixel + step, a.depth);
    if (!b.found()) return b;
    if (kernels::is_one_surface(a.depth, b.depth, steep_px)) return b;
    const float difference = b.depth - a.depth;
    const Steps on = steps_beyond(b, pixel + step, step, difference);
    const Steps back = steps_beyond(a, pixel, Imath::V2i(0) - step, 0 - difference);
    const float slope =
        std::max({std::min(on[0], on[1]), std::min(back[0], back[1]), std::min(on[0], back[0])});
    return std::abs(difference) - steep_px < 2 * slope ? b : LinkedSample{};
}

namespace {

class Joining {
public:
    Joining(const Ldi &ldi, const Links &links, float apart)
        : ldi_(ldi), grid_(ldi.windows.grid()), links_(links), apart_(apart), first_(ldi.samples()) {
        std::iota(first_.begin(), first_.end(), 0u);
    }

    // `cell`: its pixels, EXR coordinates.
    void join(const Imath::Box2i &cell) {
        float least = INFINITY, most = -INFINITY;
        for_each(cell, [&](const Imath::V2i &, const LinkedSample &s) {
            least = std::min(least, s.depth);
            most = std::max(most, s.depth);
        });
        if (!(most - least > apart_)) return;
        for_each(cell, [&](const Imath::V2i &pixel, const LinkedSample &s) {
            for (const Imath::V2i &step : {Imath::V2i(1, 0), Imath::V2i(0, 1)})
                if (cell.intersects(pixel + step))
                    if (const LinkedSample next = links_.linked(s, grid_.position(pixel), step); next.found())
                        unite(s.sample, next.sample);
        });
        for_each(cell,
                 [&](const Imath::V2i &, const LinkedSample &s) { first_[s.sample] = first_of(s.sample); });
    }

    std::vector<std::uint32_t> take() { return std::move(first_); }

private:
    // Calls visit(pixel, sample).
    template <typename Visit>
    void for_each(const Imath::Box2i &cell, const Visit &visit) const {
        for (int y = cell.min.y; y <= cell.max.y; ++y)
            for (int x = cell.min.x; x <= cell.max.x; ++x) {
                const Imath::V2i pixel(x, y);
                links_.for_each_opaque(grid_.position(pixel),
                                       [&](const LinkedSample &s) { visit(pixel, s); });
            }
    }
    std::uint32_t first_of(std::uint32_t sample) const {
        while (first_[sample] != sample) sample = first_[sample];
        return sample;
    }
    bool shows_image(std::uint32_t sample) const {
        return !ldi_.image_z.empty() && ldi_.image_z[sample] != ldi_.z[sample];
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        if (shows_image(a) || shows_image(b)) return;
        const auto [least, most] = std::minmax({first_of(a), first_of(b)});
        first_[most] = least;
    }

    const Ldi &ldi_;
    Grid grid_;
    const Links &links_;
    float apart_;
    std::vector<std::uint32_t> first_;
};

} // namespace

std::vector<std::uint32_t> joined_in_cells(const Ldi &ldi, const Links &links, int across, float apart) {
    Joining joining(ldi, links, apart);
    const Imath::Box2i cells = reduced(ldi.windows.data, across);
    parallel_for(std::size_t(cells.max.y - cells.min.y + 1), [&](std::size_t row) {
        const int y = (cells.min.y + int(row)) * across;
        for (int x = cells.min.x * across; x <= cells.max.x * across; x += across)
            joining.join({{x, y}, {x + across - 1, y + across - 1}});
    });
    return joining.take();
}

} // namespace sparselens
