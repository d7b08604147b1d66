// Loops over samples and cells, compared with plain definitions, and with themselves compiled for any processor.
#include "base/parallel.h"
#include "dof/lens/cell_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

// The same loops without vectors of newer processors, in a namespace of their own.
namespace for_any_processor {
using namespace sparselens;
}
#undef FOR_PROCESSORS
#define FOR_PROCESSORS
#define sparselens for_any_processor
#include "dof/lens/cell_rows.cpp"
#undef sparselens

namespace sparselens {
namespace {

constexpr std::ptrdiff_t stride = tile_cells::stride;
constexpr std::size_t first = std::size_t(stride) + 2; // of the 64 in the middle of three rows
constexpr CellWord mask = 0xfff;

std::vector<CellWord> random_words(std::size_t count, std::uint32_t seed, int most_code) {
    std::mt19937 random(seed);
    std::vector<CellWord> words(count);
    for (CellWord &word : words)
        word = random() % 5 == 0 ? 0 : CellWord(random() % std::uint32_t(most_code * (mask + 1)));
    return words;
}

TEST(CellRows, EmptyOnesAreThoseWhoseWordIs0) {
    const std::vector<CellWord> words = random_words(64, 3, 1000);
    const std::uint64_t zeros = zeros_of(words.data());
    for (std::size_t n = 0; n < 64; ++n) EXPECT_EQ((zeros >> n & 1) != 0, words[n] == 0) << n;
    EXPECT_EQ(zeros, for_any_processor::zeros_of(words.data()));
}

TEST(CellRows, ACrackLiesWhereBothOfTwoOppositeOnesAreNearer) {
    constexpr int step = 5;
    const std::vector<CellWord> words = random_words(3 * std::size_t(stride), 5, 4 * step);
    const std::uint64_t far = far_behind(&words[first], mask, step * (mask + 1));
    int found = 0;
    for (std::size_t n = 0; n < 64; ++n) {
        const auto code = [&](std::ptrdiff_t by) {
            return words[std::size_t(std::ptrdiff_t(first + n) + by)] / (mask + 1);
        };
        bool expected = false;
        for (const std::ptrdiff_t by : {std::ptrdiff_t{1}, stride - 1, stride, stride + 1})
            expected = expected || std::min(code(by), code(-by)) > code(0) + step;
        EXPECT_EQ((far >> n & 1) != 0, expected) << n;
        found += expected;
    }
    EXPECT_GT(found, 8);
    EXPECT_LT(found, 56);
    EXPECT_EQ(far, for_any_processor::far_behind(&words[first], mask, step * (mask + 1)));
}

TEST(CellRows, ColoursAreAddedInTheOrderOfTheLensPoints) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(0, 1);
    std::vector<float> colours(4 * (std::size_t(mask) + 1)), sums(4 * 64);
    std::ranges::generate(colours, [&] { return value(random); });
    std::ranges::generate(sums, [&] { return value(random); });
    const std::vector<CellWord> words = random_words(points_at_once * 64, 9, 1000);
    std::array<const CellWord *, points_at_once> rows;
    std::array<Float4, points_at_once> factors;
    std::vector<float> expected = sums, others = sums;
    for (std::size_t l = 0; l < points_at_once; ++l) {
        rows[l] = &words[l * 64];
        for (std::size_t k = 0; k < 4; ++k) factors[l][k] = value(random);
        for (std::size_t i = 0; i < expected.size(); ++i)
            expected[i] += factors[l][i % 4] * colours[std::size_t(rows[l][i / 4] & mask) * 4 + i % 4];
    }
    add_rows(sums.data(), rows, factors, colours.data(), mask, 64);
    EXPECT_EQ(sums, expected);
    for_any_processor::add_rows(others.data(), rows, factors, colours.data(), mask, 64);
    EXPECT_EQ(others, expected);
}

// Rounded as kernels/lens_rules.h says; also what is infinite or no number.
TEST(CellRows, PlacesAreTheSameOnEveryProcessor) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> value(-300, 300);
    std::vector<float> places(1000), cocs(places.size());
    std::ranges::generate(places, [&] { return value(random); });
    std::ranges::generate(cocs, [&] { return value(random) / 4; });
    places[0] = cocs[3] = INFINITY;
    places[1] = cocs[4] = -INFINITY;
    places[2] = cocs[5] = NAN;
    const kernels::TileUnits units{128, 1, 70, 70, 0, 0, 0};
    const std::size_t count = places.size() / 16 * 16;
    struct Whole {
        std::vector<std::int16_t> x, coc;
        std::vector<std::uint16_t> cells;
    };
    Whole here{std::vector<std::int16_t>(count), std::vector<std::int16_t>(count),
               std::vector<std::uint16_t>(count)},
        anywhere = here;
    const WholeLens lens(units, {0.7f, -0.33f, 0.24f, -0.5f, 1});
    whole_places(units, 20, places.data(), count, here.x.data());
    whole_cocs(units, cocs.data(), count, here.coc.data());
    project_to_cells(lens, here.x.data(), here.x.data(), here.coc.data(), std::uint32_t(count),
                     here.cells.data());
    for_any_processor::whole_places(units, 20, places.data(), count, anywhere.x.data());
    for_any_processor::whole_cocs(units, cocs.data(), count, anywhere.coc.data());
    for_any_processor::project_to_cells(lens, here.x.data(), here.x.data(), here.coc.data(),
                                        std::uint32_t(count), anywhere.cells.data());
    EXPECT_EQ(here.x, anywhere.x);
    EXPECT_EQ(here.coc, anywhere.coc);
    EXPECT_EQ(here.cells, anywhere.cells);
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(here.x[i], kernels::whole_place(places[i], 20, 128, 70)) << i;
        EXPECT_EQ(here.coc[i], kernels::whole_coc(cocs[i], 128, 70 * 128)) << i;
        const auto pixel = [&](int by, int shift) {
            return std::clamp((here.x[i] + kernels::moved(here.coc[i], by) + shift) >> 7, -34, 33);
        };
        EXPECT_EQ(here.cells[i],
                  tile_cells::at(32 + pixel(lens.x, lens.shift_x), 32 + pixel(lens.y, lens.shift_y)))
            << i;
    }
}

} // namespace
} // namespace sparselens
