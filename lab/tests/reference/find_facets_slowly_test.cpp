#include "dof/facets/facets.h"
#include "lab/reference/find_facets_slowly.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.625, .focal_px = 640, .focus = 5}; // R F / focus = 80 px

// Up to three surfaces, steep and flat, with steps, holes and partial samples.
Ldi random_relief(std::uint32_t seed) {
    return make_ldi(windows_of_size(40, 30), {{"Y"}, {"A"}}, [&](int x, int y) {
        std::vector<Sample> samples;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t own = seed * 100 + k * 10;
            const int cell_x = x / 9, cell_y = y / 7;
            if (random_unit(x, y, own) < 0.1 || random_unit(cell_x, cell_y, own + 1) < 0.2) continue;
            const double slope_x = 6 * random_unit(cell_x, cell_y, own + 2) - 3,
                         slope_y = 6 * random_unit(cell_x, cell_y, own + 3) - 3;
            const double depth = 20 + 40 * double(2 - k) + slope_x * (x % 9) + slope_y * (y % 7) +
                                 2 * random_unit(x, y, own + 4);
            const float alpha = random_unit(x, y, own + 5) < 0.1 ? 0.5f : 1;
            samples.push_back({lens.radius * lens.focal_px / std::max(1.0, depth), {0, alpha}});
        }
        return samples;
    });
}

TEST(Facets, AreThoseThatAreFoundSlowly) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed)
        for (const double widest : {1.0, 0.3}) {
            const Ldi ldi = random_relief(seed);
            std::vector<std::array<std::uint64_t, 3>> found, slowly = find_facets_slowly(ldi, lens, widest);
            for (const auto &block : find_facets(ldi, lens, widest).blocks)
                for (const Facet &f : block) found.push_back({f.sample[0], f.sample[1], f.sample[2]});
            for (auto *facets : {&found, &slowly}) {
                for (auto &samples : *facets) std::ranges::sort(samples);
                std::ranges::sort(*facets);
            }
            EXPECT_EQ(found, slowly) << seed;
            EXPECT_GT(found.size(), 500u) << seed; // otherwise this proves little
        }
}

} // namespace
} // namespace sparselens
