#include "base/parallel.h"
#include "base/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace sparselens {
namespace {

TEST(Progress, EachPercentIsSaidAtMostOnceAndTheLastIsOneHundred) {
    std::mutex guard;
    std::vector<int> said;
    Progress progress([&](const std::string &stage, int percent) {
        EXPECT_EQ(stage, "sorting");
        const std::lock_guard lock(guard);
        said.push_back(percent);
    });
    progress.start("sorting", 12'345);
    parallel_for(12'345, [&](std::size_t) { progress.advance(); });
    std::ranges::sort(said);
    ASSERT_EQ(said.size(), 101u);
    for (int percent = 0; percent <= 100; ++percent) EXPECT_EQ(said[std::size_t(percent)], percent);
}

TEST(Progress, ManyStepsAtOnceAndAnotherStage) {
    std::vector<int> said;
    Progress progress([&](const std::string &, int percent) { said.push_back(percent); });
    progress.start("one", 4);
    progress.advance(3);
    progress.advance();
    progress.start("two", 1);
    progress.advance();
    EXPECT_EQ(said, (std::vector{0, 75, 100, 0, 100}));
}

TEST(Progress, WorkEndsBetweenItsStepsWhereItsOwnerAsksForThat) {
    struct Ended {};
    bool wanted = true;
    const Progress progress({}, [&] {
        if (!wanted) throw Ended();
    });
    EXPECT_NO_THROW(progress.may_end());
    EXPECT_NO_THROW(Progress().may_end());
    wanted = false;
    EXPECT_THROW(progress.may_end(), Ended);
}

TEST(Progress, SumsTheTimesOfStepsUntilTheyAreTaken) {
    Progress progress;
    parallel_for(100, [&](std::size_t i) { progress.spent(i % 2 == 0 ? "even" : "odd", 0.5); });
    progress.spent({{"even", 3}, {"all", 1}});
    { const Timed timed(progress, "timed"); }
    auto ms = progress.take_times();
    EXPECT_GE(ms["timed"], 0);
    ms.erase("timed");
    EXPECT_EQ(ms, (std::map<std::string, double>{{"even", 28}, {"odd", 25}, {"all", 1}}));
    EXPECT_TRUE(progress.take_times().empty());
}

} // namespace
} // namespace sparselens
