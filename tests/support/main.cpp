// The unit tests' main: as gtest's own, but each skipped test prints a line that tests/skips.sh reads, even with
// --gtest_brief.
#include <gtest/gtest.h>

#include <cstdio>

namespace {

class Skips : public testing::EmptyTestEventListener {
    void OnTestEnd(const testing::TestInfo &test) override {
        const testing::TestResult &result = *test.result();
        for (int i = 0; i < result.total_part_count(); ++i)
            if (const testing::TestPartResult &part = result.GetTestPartResult(i); part.skipped())
                std::printf("skipped: %s.%s: %s\n", test.test_suite_name(), test.name(), part.message());
    }
};

} // namespace

int main(int argc, char **argv) {
    testing::InitGoogleTest(&argc, argv);
    testing::UnitTest::GetInstance()->listeners().Append(new Skips); // which takes ownership
    return RUN_ALL_TESTS();
}
