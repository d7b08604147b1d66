#include "harness/frame_run.h"
#include "harness/progress_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace sparselens {
namespace {

const auto no_work = [] {};
const auto no_turn = [] {};
const auto well = [](std::exception_ptr failure) { return failure ? 1 : 0; };

TEST(FrameRun, WritesAFrameWhileTheNextIsAtWork) {
    FrameRun run(false);
    std::promise<void> next_is_at_work;
    EXPECT_TRUE(run.go_on({.work = no_work,
                           .take_turn = no_turn,
                           .end =
                               [&](std::exception_ptr) {
                                   next_is_at_work.get_future().wait();
                                   return 0;
                               },
                           .aside = true}));
    bool last = false;
    EXPECT_TRUE(run.go_on({.work = [&] { next_is_at_work.set_value(); },
                           .take_turn = no_turn,
                           .end =
                               [&](std::exception_ptr) {
                                   last = true;
                                   return 0;
                               }}));
    EXPECT_TRUE(last);
    EXPECT_EQ(run.worst(), 0);
}

TEST(FrameRun, WorksOnAFrameBesideTheOneBefore) {
    std::vector<int> ended;
    FrameRun run(false);
    std::promise<void> next_has_worked;
    for (const int n : {0, 1}) {
        const auto work = [&, n] {
            n == 0 ? next_has_worked.get_future().wait() : next_has_worked.set_value();
        };
        const auto end = [&, n](std::exception_ptr) {
            ended.push_back(n);
            return 0;
        };
        EXPECT_TRUE(run.go_on({work, no_turn, end, n == 1, n == 0}));
    }
    EXPECT_EQ(ended, (std::vector{0, 1}));
}

// Otherwise it begins after the work of the frame before, and a third frame after the end of the first.
TEST(FrameRun, BeginsNoFrameTooSoon) {
    for (const bool beside : {false, true}) {
        std::atomic<int> at_work = 0, alive = 0, most_at_work = 0, most_alive = 0;
        const auto raise = [](std::atomic<int> &most, int now) {
            for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
            }
        };
        FrameRun run(false);
        for (int n = 0; n < 50; ++n) {
            const auto work = [&] {
                raise(most_at_work, ++at_work);
                raise(most_alive, ++alive);
                std::this_thread::yield();
                --at_work;
            };
            const auto end = [&](std::exception_ptr) { return --alive >= 0 ? 0 : 1; };
            EXPECT_TRUE(run.go_on({work, no_turn, end, beside, true}));
        }
        EXPECT_EQ(run.worst(), 0);
        EXPECT_LE(most_at_work, beside ? 2 : 1);
        EXPECT_LE(most_alive, 2);
    }
}

// Three frames; the second ends with a code. Returns the finished frames.
std::string finished(FrameRun &run, bool work_fails, int code, bool aside, bool beside) {
    std::string names;
    for (const char name : {'1', '2', '3'}) {
        const bool second = name == '2';
        const auto work = [fails = second && work_fails] {
            if (fails) throw std::runtime_error("it fails");
        };
        const auto end = [&names, name, code = second ? code : 0](std::exception_ptr failure) {
            if (failure) return 1;
            names += name;
            return code;
        };
        if (!run.go_on({work, no_turn, end, beside, aside && name != '3'})) break;
    }
    run.worst();
    return names;
}

TEST(FrameRun, FinishesNothingAfterAFrameThatFailed) {
    for (const auto &[aside, beside] : {std::pair(false, false), {true, false}, {true, true}}) {
        FrameRun jobs(false), writes(false), usage(true);
        EXPECT_EQ(finished(jobs, true, 0, aside, beside), "1");
        EXPECT_EQ(jobs.worst(), 1);
        EXPECT_TRUE(jobs.stopped());
        EXPECT_EQ(finished(writes, false, 1, aside, beside), "12");
        EXPECT_EQ(writes.worst(), 1);
        EXPECT_EQ(finished(usage, false, 2, aside, beside), "12"); // a usage error concerns all frames
        EXPECT_EQ(usage.worst(), 2);
    }
}

TEST(FrameRun, SkipsBadFrames) {
    for (const auto &[aside, beside] : {std::pair(false, false), {true, false}, {true, true}}) {
        FrameRun jobs(true), writes(true);
        EXPECT_EQ(finished(jobs, true, 0, aside, beside), "13");
        EXPECT_EQ(jobs.worst(), 1);
        EXPECT_EQ(finished(writes, false, 1, aside, beside), "123");
        EXPECT_EQ(writes.worst(), 1);
        EXPECT_FALSE(writes.stopped());
    }
}

// Messages of the second frame's work come after all messages of the first, even if the work was done earlier.
TEST(FrameRun, LetsFramesSpeakInTurn) {
    std::string said;
    FrameRun run(false);
    std::promise<void> second_has_spoken;
    for (const char name : {'1', '2', '3'}) {
        const auto turn = std::make_shared<InTurn>(false);
        const auto work = [&, turn, name] {
            turn->say([&, name] { said += name; });
            if (name == '1') second_has_spoken.get_future().wait();
            turn->say([&, name] { said += name; });
            if (name == '2') second_has_spoken.set_value();
        };
        EXPECT_TRUE(run.go_on({work, [turn] { turn->come(); }, well, true, true}));
    }
    EXPECT_EQ(run.worst(), 0);
    EXPECT_EQ(said, "112233");
}

TEST(FrameNeighbours, TakeWhatTheOneBeforeKeeps) {
    const FrameNeighbours one_file({"a", "a", "b"}), nothing({"", "", ""}),
        unsaid({std::nullopt, std::nullopt});
    EXPECT_TRUE(one_file.keeps_for_next(0));
    EXPECT_FALSE(one_file.keeps_for_next(1));
    EXPECT_FALSE(one_file.keeps_for_next(2));
    EXPECT_FALSE(one_file.are_apart(0));
    EXPECT_FALSE(one_file.are_apart(1));
    EXPECT_TRUE(one_file.are_apart(2));
    EXPECT_FALSE(nothing.keeps_for_next(0));
    EXPECT_TRUE(nothing.are_apart(1));
    EXPECT_TRUE(unsaid.keeps_for_next(0));
    EXPECT_FALSE(unsaid.are_apart(1));
}

// Each frame takes 10 bytes of memory per byte of its file.
TEST(TwoAtOnce, AsLongAsBothFit) {
    const auto fits = [](const std::vector<std::uint64_t> &bytes, std::uint64_t memory) {
        TwoAtOnce two(bytes, memory);
        std::vector<bool> found;
        std::uint64_t peak = 0;
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            found.push_back(two.fit(i, peak));
            const std::uint64_t at_once = bytes[i] + (found.back() ? bytes[i - 1] : 0);
            const std::uint64_t taken = 10 * std::max<std::uint64_t>(at_once, 1);
            if (found.back()) {
                EXPECT_LE(taken, memory);
            }
            peak = std::max(peak, taken);
        }
        return found;
    };
    const std::vector<bool> alone{false, false, false, false, false}, two{false, false, true, true, true};
    EXPECT_EQ(fits({5, 5, 5, 5, 5}, 100), two);
    EXPECT_EQ(fits({5, 5, 5, 5, 5}, 99), alone);
    EXPECT_EQ(fits({0, 0, 0, 0, 0}, 20), two); // sizes are unknown through pipes
    // The second may still be running when the third is asked for, so the first is taken to have held everything: 12
    // per byte.
    EXPECT_EQ(fits({5, 6, 7, 8, 9}, 155), alone);
    EXPECT_EQ(fits({5, 6, 7, 8, 9}, 156), (std::vector<bool>{false, false, true, false, false}));
    EXPECT_EQ(fits({1, 1, 1, 50, 50, 1, 1}, 100),
              (std::vector<bool>{false, false, true, false, false, false, true}));
}

} // namespace
} // namespace sparselens
