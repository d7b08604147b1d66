#include "base/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace sparselens {
namespace {

TEST(Parallel, EveryPieceRunsOnce) {
    std::vector<int> runs(10'007);
    parallel_for(runs.size(), [&](std::size_t i) { ++runs[i]; });
    EXPECT_EQ(runs, std::vector<int>(runs.size(), 1));
}

TEST(Parallel, RunsCoverTheRangeInPiecesOfTheGrain) {
    std::vector<std::size_t> length(100);
    parallel_ranges(100, 32, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) length[i] += end - begin;
    });
    for (std::size_t i = 0; i < 96; ++i) EXPECT_EQ(length[i], 32u) << i;
    for (std::size_t i = 96; i < 100; ++i) EXPECT_EQ(length[i], 4u) << i;
    parallel_ranges(0, 32, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(Parallel, WhatAPieceThrowsReachesTheCaller) {
    const auto work = [](std::size_t i) {
        if (i == 77) throw std::runtime_error("piece 77");
    };
    EXPECT_THROW(parallel_for(1000, work), std::runtime_error);
}

} // namespace
} // namespace sparselens
