#include "base/error.h"
#include "io/files/text_file.h"
#include "io/moment_files.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

using Weights = std::vector<double>;

TEST(ShutterCurve, OfABoxCountsAllMomentsAlike) {
    for (const int moments : {1, 3, 7, 16})
        EXPECT_EQ(moment_weights(box_shutter(), moments), Weights(std::size_t(moments), 1.0));
}

TEST(ShutterCurve, OfATriangleIsItsMeanInEachMoment) {
    EXPECT_EQ(moment_weights(triangle_shutter(), 1), Weights{0.5});
    EXPECT_EQ(moment_weights(triangle_shutter(), 4), (Weights{0.25, 0.75, 0.75, 0.25}));
    const Weights three = moment_weights(triangle_shutter(), 3); // the tip lies within the second moment
    EXPECT_NEAR(three[0], 1.0 / 3, 1e-12);
    EXPECT_NEAR(three[1], 5.0 / 6, 1e-12);
    EXPECT_NEAR(three[2], 1.0 / 3, 1e-12);
}

// The integral of the bell from 0 to t, in units of its height.
double bell(double t) {
    constexpr double deviation = 1.0 / 6;
    return deviation * std::sqrt(std::acos(-1.0) / 2) * std::erf((t - 0.5) / deviation / std::sqrt(2.0));
}

TEST(ShutterCurve, OfAGaussianIsTheErrorFunction) {
    for (const int moments : {1, 4, 9}) {
        const Weights weights = moment_weights(gaussian_shutter(), moments);
        for (int m = 0; m < moments; ++m)
            EXPECT_NEAR(weights[std::size_t(m)],
                        (bell(double(m + 1) / moments) - bell(double(m) / moments)) * moments, 1e-5);
    }
}

class ShutterFile : public testing::Test {
protected:
    ShutterCurve read(const std::string &text) {
        write_text_file(path, text);
        return shutter_curve(path);
    }
    std::string error(const std::string &text) {
        return what_of<Error>([&] { read(text); });
    }
    ScratchFolder folder;
    std::string path = folder.file("curve.txt");
};

TEST_F(ShutterFile, IsLinearBetweenItsPoints) {
    const Weights weights = moment_weights(read("# opens at once\n0 1\n0.3, 1\r\n\n0.7 0\n1 0\n"), 2);
    EXPECT_NEAR(weights[0], 0.9, 1e-12);
    EXPECT_NEAR(weights[1], 0.1, 1e-12);
}

TEST_F(ShutterFile, SaysWhatIsWrong) {
    EXPECT_EQ(error("0 1\n0.5\n1 1\n"),
              path + ": line 2 must be a time and a value of the shutter, e.g. 0.25 1");
    EXPECT_EQ(error("0 1\n1 1 1\n"),
              path + ": line 2 must be a time and a value of the shutter, e.g. 0.25 1");
    for (const char *text : {"", "0 1\n", "0.1 1\n1 1\n", "0 1\n2 1\n"})
        EXPECT_EQ(error(text),
                  path + ": its times must go from 0, when the shutter opens, to 1, when it closes");
    EXPECT_EQ(error("0 1\n0.5 1\n0.5 0\n1 1\n"), path + ": its times must ascend");
    EXPECT_EQ(error("0 1\nnan 1\n1 1\n"), path + ": its times must ascend");
    EXPECT_EQ(error("0 1\n1 -1\n"), path + ": its values must be at least 0");
    EXPECT_EQ(error("0 inf\n1 1\n"), path + ": its values must be at least 0");
    EXPECT_EQ(error("0 0\n1 0\n"), path + ": one of its values must be above 0");
}

} // namespace
} // namespace sparselens
