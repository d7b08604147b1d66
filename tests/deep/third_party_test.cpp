// Deep files by others, if they are there: read, tidied, clustered, written, flattened.
#include "deep/cluster.h"
#include "deep/flatten.h"
#include "deep/tidy.h"
#include "io/exr/exr_deep.h"
#include "support/order.h"
#include "support/scratch_folder.h"
#include "support/shared_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

class ThirdParty : public testing::TestWithParam<const char *> {
protected:
    void SetUp() override {
        path = shared_file(std::string("deep/") + GetParam());
        if (path.empty()) GTEST_SKIP() << "../shared/deep/" << GetParam() << " is not there";
    }
    std::string path;
};

std::size_t most_samples(const Ldi &ldi) {
    std::uint64_t most = 0;
    for (std::size_t i = 0; i + 1 < ldi.begin.size(); ++i) most = std::max(most, ldi.pixel(i).size());
    return most;
}

// The allowed difference in half ulps of the value: one for each stored layer, and the loss by float arithmetic.
void expect_close(const Image &a, const Image &b, double half_ulps) {
    ASSERT_EQ(a.values.size(), b.values.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double bound = half_ulps * (std::abs(double(a.values[i])) * 0x1p-11 + 0x1p-25) + 1e-6;
        worst = std::max(worst, std::abs(double(a.values[i]) - double(b.values[i])) / bound);
    }
    EXPECT_LE(worst, 1);
}

TEST_P(ThirdParty, ClusteredAndWrittenItFlattensAsItDid) {
    const LdiFile file = read_ldi(path);
    const Ldi neat = tidy(file.ldi);
    EXPECT_TRUE(order_of(neat).sorted && order_of(neat).apart);
    const Image before = flatten(neat);
    const ScratchFolder folder;
    for (const int layers : {4, 2, 1}) {
        Progress silent;
        const Clustered out = cluster(neat, {.layers = layers}, silent);
        EXPECT_LE(most_samples(out.ldi), std::size_t(layers));
        expect_close(before, flatten(out.ldi), 0);
        write_ldi(folder.file("clustered.exr"), out.ldi, file.header);
        expect_close(before, flatten(read_ldi(folder.file("clustered.exr")).ldi), layers + 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Deep, ThirdParty, testing::Values("Balls.exr", "Leaves.exr", "Trunks.exr"));

} // namespace
} // namespace sparselens
