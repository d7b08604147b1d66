#include "harness/frame_run.h"

#include <gtest/gtest.h>

#include <string>

namespace sparselens {
namespace {

TEST(FrameRun, WritesAFrameWhileTheNextIsAtWork) {
    FrameRun run(false);
    std::promise<void> next_is_at_work;
    EXPECT_TRUE(run.go_on([] { return 0; },
                          [&] {
                              next_is_at_work.get_future().wait();
                              return 0;
                          },
                          true));
    bool last = false;
    const auto work = [&] {
        next_is_at_work.set_value();
        return 0;
    };
    EXPECT_TRUE(run.go_on(
        work,
        [&] {
            last = true;
            return 0;
        },
        false));
    EXPECT_TRUE(last);
    EXPECT_EQ(run.worst(), 0);
}

// Three frames; the second ends with a code. Returns which were finished.
std::string finished(FrameRun &run, int job, int finish, bool aside) {
    std::string names;
    for (const char name : {'1', '2', '3'}) {
        const bool second = name == '2';
        const bool goes_on = run.go_on([&] { return second ? job : 0; },
                                       [&names, name, code = second ? finish : 0] {
                                           names += name;
                                           return code;
                                       },
                                       aside && name != '3');
        if (!goes_on) break;
    }
    run.worst();
    return names;
}

TEST(FrameRun, FinishesNothingAfterAFrameThatFailed) {
    for (const bool aside : {false, true}) {
        FrameRun jobs(false), writes(false), usage(true);
        EXPECT_EQ(finished(jobs, 1, 0, aside), "1");
        EXPECT_EQ(jobs.worst(), 1);
        EXPECT_EQ(finished(writes, 0, 1, aside), "12");
        EXPECT_EQ(writes.worst(), 1);
        EXPECT_EQ(finished(usage, 0, 2, aside), "12"); // wrong usage is that of all frames
        EXPECT_EQ(usage.worst(), 2);
    }
}

TEST(FrameRun, SkipsBadFrames) {
    for (const bool aside : {false, true}) {
        FrameRun jobs(true), writes(true);
        EXPECT_EQ(finished(jobs, 1, 0, aside), "13");
        EXPECT_EQ(jobs.worst(), 1);
        EXPECT_EQ(finished(writes, 0, 1, aside), "123");
        EXPECT_EQ(writes.worst(), 1);
    }
}

} // namespace
} // namespace sparselens
