// Each case stays within its bound. If STRESS_PAGE names a file, the rows of lab/results/stress.md are appended to it
// (lab/measures/stress.sh).
#include "lab/tests/stress/stress.h"
#include "support/scratch_folder.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace sparselens::stress {

namespace {

std::ofstream open_page() {
    const char *asked = std::getenv("STRESS_PAGE");
    std::ofstream page(asked ? asked : "/dev/null", std::ios::app);
    page << std::scientific;
    page.precision(1);
    return page;
}

} // namespace

void Stress::SetUpTestSuite() {
    const std::string suite = testing::UnitTest::GetInstance()->current_test_suite()->name();
    open_page() << "\n## " << suite.substr(0, suite.find('/'))
                << "\n\n| case | what is measured | error | bound | energy | why this bound |\n|"
                   "---|---|---|---|---|---|\n";
}

std::string name_of(const testing::TestParamInfo<Case> &info) {
    std::string name = info.param.name;
    std::ranges::replace_if(
        name, [](char c) { return !std::isalnum(c); }, '_'); // GoogleTest allows no other
    return name;
}

TEST_P(Stress, StaysWithinItsBound) {
    const Case &c = GetParam();
    testing::internal::CaptureStderr();
    const Result result = c.run();
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_LE(result.error, c.limit.bound) << c.claim << ": " << c.limit.reason;
    EXPECT_LE(std::abs(result.energy.value_or(0)), energy_bound);
    std::ofstream page = open_page();
    page << c << ' ' << result.error << " | " << c.limit.bound << " | ";
    if (result.energy)
        page << *result.energy;
    else
        page << '-';
    page << " | " << c.limit.reason << " |\n";
}

TEST(StressPage, HasTheRowsOfAllCases) {
    const std::string page = contents_of(SPARSELENS_STRESS_PAGE);
    std::istringstream lines(page);
    int rows = 0, cases = 0;
    for (std::string line; std::getline(lines, line);)
        rows += line.starts_with("| ") && !line.starts_with("| case |");
    const testing::UnitTest &tests = *testing::UnitTest::GetInstance();
    for (int i = 0; i < tests.total_test_suite_count(); ++i) {
        const testing::TestSuite &suite = *tests.GetTestSuite(i);
        if (!std::string(suite.name()).ends_with("/Stress")) continue;
        cases += suite.total_test_count();
        for (int k = 0; k < suite.total_test_count(); ++k) {
            const std::string row = suite.GetTestInfo(k)->value_param();
            EXPECT_NE(page.find("\n" + row), std::string::npos) << row << ": run lab/measure stress";
        }
    }
    EXPECT_EQ(rows, cases);
    EXPECT_GE(cases, 127);
}

} // namespace sparselens::stress
