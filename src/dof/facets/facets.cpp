#include "dof/facets/facets.h"

#include "base/parallel.h"
#include "dof/facets/links.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// Four pixels that meet in a corner: from (x, y) to (x + 1, y + 1).
class Corner {
public:
    Corner(const Links &links, const Imath::V2i &at, float steep) : links_(links), at_(at), steep_(steep) {}

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
    Imath::V2i at_;
    float steep_;
};

// The range of the depths of a pixel's opaque samples; without samples, least > most.
struct DepthRange {
    float least = INFINITY, most = -INFINITY;
};

std::vector<DepthRange> ranges_of_row(const Links &links, const Windows &windows, int y) {
    std::vector<DepthRange> ranges(std::size_t(windows.width()));
    for (int x = 0; x < windows.width(); ++x)
        links.for_each_opaque({x, y}, [&](const LinkedSample &s) {
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
            if (most - least >= steep) Corner(links, {x, y}, steep).find(found[i / size]);
        }
    }
    std::erase_if(found, [](const auto &block) { return block.empty(); });
    return found;
}

} // namespace

FacetBlocks find_facets(const Ldi &ldi, const ThinLens &lens, double widest) {
    const Links links(ldi, lens);
    const float steep = float(steep_px / widest);
    std::vector<std::vector<std::vector<Facet>>> rows(
        std::size_t((ldi.windows.height() + FacetBlocks::size - 1) / FacetBlocks::size));
    parallel_for(rows.size(),
                 [&](std::size_t row) { rows[row] = find_in_row(links, ldi.windows, int(row), steep); });
    FacetBlocks found;
    for (auto &row : rows)
        for (auto &block : row) found.blocks.push_back(std::move(block));
    return found;
}

} // namespace sparselens
