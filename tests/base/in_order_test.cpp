#include "base/parallel.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace sparselens {
namespace {

TEST(InOrder, EveryPieceIsTakenOnceAndInOrder) {
    for (const std::size_t threads : {1u, 2u, 7u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        std::vector<std::size_t> taken;
        in_order(
            1000, [](std::size_t i) { return std::vector<std::size_t>{i}; },
            [&](std::size_t i, std::vector<std::size_t> piece) {
                EXPECT_EQ(piece, std::vector<std::size_t>{i});
                taken.push_back(i);
            });
        ASSERT_EQ(taken.size(), 1000u) << threads;
        for (std::size_t i = 0; i < taken.size(); ++i) EXPECT_EQ(taken[i], i) << threads;
    }
}

TEST(InOrder, NoPieceIsMadeOfNothing) {
    in_order(
        0, [](std::size_t i) { return i; }, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(InOrder, TheFirstFailureReachesTheCallerAndNothingIsTakenAfterIt) {
    for (int run = 0; run < 20; ++run) {
        std::size_t taken = 0;
        const auto make = [](std::size_t i) {
            if (i == 30 || i == 31 || i == 90) throw std::runtime_error(std::to_string(i));
            return i;
        };
        try {
            in_order(100, make, [&](std::size_t, std::size_t) { ++taken; });
            FAIL();
        } catch (const std::runtime_error &error) {
            EXPECT_EQ(error.what(), std::string("30"));
        }
        EXPECT_EQ(taken, 30u);
    }
}

TEST(InOrder, NoMoreAreMadeSideBySideThanAllowed) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 8);
    std::atomic<int> making = 0, most = 0;
    std::size_t taken = 0;
    const auto make = [&](std::size_t i) {
        const int now = ++making;
        for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --making;
        return i;
    };
    in_order(
        40, make, [&](std::size_t i, std::size_t) { EXPECT_EQ(i, taken++); }, 2);
    EXPECT_EQ(taken, 40u);
    EXPECT_LE(most, 2);
}

TEST(InOrder, WhatTakingThrowsReachesTheCaller) {
    const auto take = [](std::size_t i, std::size_t) {
        if (i == 5) throw std::runtime_error("taken");
    };
    EXPECT_THROW(in_order(
                     100, [](std::size_t i) { return i; }, take),
                 std::runtime_error);
}

} // namespace
} // namespace sparselens
