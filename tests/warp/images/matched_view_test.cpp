#include "base/numbers.h"
#include "support/views.h"
#include "warp/images/matched_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr double scale = 24;

// More than two tiles wide, at odd coordinates. Depths are of two surfaces; some pixels are empty.
View some_view() {
    Windows windows = windows_of_size(300, 250);
    windows.data = {{-5, 3}, {240, 193}};
    View view = random_view(windows, {0, 0}, 7);
    for (std::size_t i = 0; i < view.z.size(); ++i) {
        const Imath::V2i p = windows.pixel(i);
        view.z[i] = ((p.x + 5) / 9 + p.y / 7) % 2 == 0 ? 3.0f : 24.0f;
    }
    return view;
}

// Slow and simple: the mean with weights 1, 2, 1 along both axes of tone-mapped colours.
float smoothed(const Ldi &ldi, std::size_t channel, int x, int y) {
    const Imath::Box2i &data = ldi.windows.data;
    float sum = 0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const int u = std::clamp(x + dx, data.min.x, data.max.x),
                      v = std::clamp(y + dy, data.min.y, data.max.y);
            const SampleRange samples = ldi.pixel(ldi.windows.index(Imath::V2i(u, v)));
            const float value = samples.empty() ? 0 : ldi.values[channel][samples.front()];
            sum += float((2 - std::abs(dx)) * (2 - std::abs(dy))) / 16 * value / (1 + std::abs(value));
        }
    return sum;
}

// A view as it is searched, and what it was made of.
struct Matched {
    View picture = some_view();
    ViewSamples samples{picture, picture.image.channels};
    ViewMapping mapping;
    MatchedView view{{&samples, &mapping}, scale};
    const Imath::Box2i data = samples.windows.data;

    explicit Matched(const Imath::V2d &position = {0, 0}) : mapping(position, 100, samples.windows, {}, {}) {}
};

float own_depth(const Ldi &ldi, int x, int y) {
    const SampleRange samples = ldi.pixel(ldi.windows.index(Imath::V2i(x, y)));
    return samples.size() == 1 ? float(scale / double(ldi.z[samples.front()]))
                               : std::numeric_limits<float>::quiet_NaN();
}

TEST(MatchedView, PixelsAreSmoothedAndTellOneSurface) {
    const Matched matched;
    const MatchedView &view = matched.view;
    const Imath::Box2i &data = matched.data;
    const Ldi ldi = matched.samples.as_ldi();
    int known = 0;
    for (int y = data.min.y; y <= data.max.y; ++y)
        for (int x = data.min.x; x <= data.max.x; ++x) {
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_NEAR(view.at(x, y)[k], smoothed(ldi, k, x, y), 1e-6) << x << ' ' << y;
            bool one = x > data.min.x && y > data.min.y && x < data.max.x && y < data.max.y;
            for (int v = y - 1; one && v <= y + 1; ++v)
                for (int u = x - 1; one && u <= x + 1; ++u)
                    one = std::abs(own_depth(ldi, u, v) - own_depth(ldi, x, y)) <= one_mirror_px;
            ASSERT_EQ(std::isnan(view.at(x, y)[3]), !one) << x << ' ' << y;
            known += one;
        }
    EXPECT_GT(known, 500);
}

TEST(MatchedView, WhatIsForgottenIsMadeAgain) {
    Matched matched;
    MatchedView &view = matched.view;
    const Imath::V2i at = matched.data.min + Imath::V2i(1);
    EXPECT_EQ(view.bytes(), 0u);
    const MatchedView::Pixel before = view.at(at.x, at.y);
    EXPECT_GT(view.bytes(), 0u);
    view.forget_unused(); // it was used since it was made
    EXPECT_GT(view.bytes(), 0u);
    view.forget_unused();
    EXPECT_EQ(view.bytes(), 0u);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(view.at(at.x, at.y)[k], before[k]);
}

// Slow: the mean of the pixels that exist among 2 x 2, repeated beyond the border, with weights 1, 2, 1 along both
// axes.
TEST(MatchedView, OfHalfTheSizeHasMeansOfFourPixels) {
    const Matched matched({0.5, 0.25});
    const ViewSamples &samples = matched.samples;
    const MatchedView &view = matched.view, half = view.half();
    const Imath::Box2i &data = matched.data;
    const auto sharp = [&](std::size_t k, int x, int y) {
        const std::size_t i = samples.windows.index(
            Imath::V2i(std::clamp(x, data.min.x, data.max.x), std::clamp(y, data.min.y, data.max.y)));
        const float value = samples.pixel(i).empty() ? 0 : samples.value(k, i);
        return value / (1 + std::abs(value));
    };
    int known = 0;
    for (int y = 2; y <= 96; ++y)
        for (int x = -3; x <= 120; ++x) {
            ASSERT_EQ(half.contains(Imath::V2i(x, y)), y > 0);
            for (std::size_t k = 0; k < 3; ++k) {
                float sum = 0;
                for (int v = -2; v < 4; ++v)
                    for (int u = -2; u < 4; ++u)
                        sum += float((v < 0 || v > 1 ? 1 : 2) * (u < 0 || u > 1 ? 1 : 2)) / 64 *
                               sharp(k, 2 * x + u, 2 * y + v);
                ASSERT_NEAR(half.at(x, y)[k], sum, 1e-6) << x << ' ' << y;
            }
            float least = 1e9f, most = 0;
            for (int n = 0; n < 4; ++n) {
                const int u = std::clamp(2 * x + n % 2, data.min.x, data.max.x),
                          v = std::clamp(2 * y + n / 2, data.min.y, data.max.y);
                const float depth = view.depth(u, v);
                least = std::isnan(depth) ? -1e9f : std::min(least, depth), most = std::max(most, depth);
            }
            const bool one = most - least < 2 * one_mirror_px;
            ASSERT_EQ(std::isnan(half.depth(x, y)), !one) << x << ' ' << y;
            ASSERT_TRUE(!one || std::abs(half.depth(x, y) - most / 2) < 0.5f);
            known += one;
        }
    EXPECT_GT(known, 500);
    const Imath::V2d from(30.2, 20.7), at = half.in_view(from, 3), same = view.in_view(2.0 * from, 6) / 2.0;
    EXPECT_NEAR(at.x, same.x, 1e-12);
    EXPECT_NEAR(at.y, same.y, 1e-12);
    EXPECT_NE(at, from);
}

// Also at borders between tiles.
TEST(MatchedView, BetweenPixelsItIsLinear) {
    const Matched matched;
    const MatchedView &view = matched.view;
    const Imath::Box2i &data = matched.data;
    for (int y = data.min.y; y < data.max.y; ++y)
        for (int x = data.min.x; x < data.max.x; ++x) {
            MatchedView::Pixel seen;
            ASSERT_TRUE(view.at({x + 0.75, y + 1.0}, seen));
            for (std::size_t k = 0; k < 3; ++k) {
                const double upper = 0.75 * double(view.at(x, y)[k]) + 0.25 * double(view.at(x + 1, y)[k]),
                             lower = 0.75 * double(view.at(x, y + 1)[k]) +
                                     0.25 * double(view.at(x + 1, y + 1)[k]);
                ASSERT_NEAR(double(seen[k]), (upper + lower) / 2, 1e-6) << x << ' ' << y;
            }
        }
    MatchedView::Pixel seen;
    EXPECT_FALSE(view.at({data.max.x + 0.75, data.min.y + 1.0}, seen));
}

} // namespace
} // namespace sparselens
