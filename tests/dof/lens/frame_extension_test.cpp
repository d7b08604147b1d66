// Continuation beyond the frame: by hand on a row of pixels, compared with a slow version of the rule, and through a
// lens, compared with the convolution of a shape that continues for ever.
#include "base/grid.h"
#include "dof/border_reach.h"
#include "dof/gather_picture.h"
#include "dof/lens/beyond/frame_extension.h"
#include "lens/lens_points.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};  // CoC up to 7.7 px behind focus
const ThinLens strong{.radius = 0.3, .focal_px = 640, .focus = 6}; // up to 32 px
const std::vector<Channel> grey{{"Y"}}, grey_alpha{{"Y"}, {"A"}}, coloured{{"R"}, {"A"}};

double infinite_coc(const ThinLens &of) { return of.radius * of.focal_px / of.focus; }
double near_of(const ThinLens &of, double c) { return infinite_coc(of) - c; } // disparity

// A row with one sample per pixel at these CoCs, none where it is NAN. The value is the column.
Ldi row_of(const std::vector<double> &cocs) {
    return make_ldi(windows_of_size(int(cocs.size()), 1), grey, [&](int x, int) {
        const double c = cocs[std::size_t(x)];
        return std::isnan(c) ? std::vector<Sample>{} : std::vector<Sample>{{depth_of(lens, c), {float(x)}}};
    });
}

constexpr float unknown = -1, nothing = -2;

// The values of the front samples of a row, `first` to `last` pixels beyond the frame.
std::vector<float> values(const FrameExtension &of, int first, int last) {
    std::vector<float> found;
    for (int x = first; x <= last; ++x) {
        if (!of.ldi.windows.data.intersects(Imath::V2i(x, 0))) {
            found.push_back(unknown);
            continue;
        }
        const std::size_t pixel = of.ldi.windows.index(Imath::V2i(x, 0));
        const SampleRange samples = of.ldi.pixel(pixel);
        found.push_back(!samples.empty() ? of.ldi.values[0][samples.front()]
                        : of.unseen[pixel] || !of.known.intersects(Imath::V2i(x, 0)) ? unknown
                                                                                     : nothing);
    }
    return found;
}

FrameExtension beyond(const Ldi &ldi, const Imath::Box2i &frame) {
    return extend_beyond_frame(ldi, lens, frame, frame, look_beyond(ldi, lens, {}, frame));
}

TEST(FrameExtension, WhatLeavesItGoesOnAsFarAsTheLensSees) {
    std::vector<double> cocs(20, 5);
    cocs.front() = 1.4;
    cocs.back() = -2.9;
    const Ldi ldi = row_of(cocs);
    const FrameExtension all = beyond(ldi, ldi.windows.data);
    // The lens sees 3 pixels far, which are rounded up to 8.
    EXPECT_EQ(values(all, -9, 1), (std::vector<float>{unknown, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(values(all, 18, 22), (std::vector<float>{18, 19, 19, 19, 19}));
    cocs.front() = cocs.back() = NAN;
    const Ldi empty = row_of(cocs);
    EXPECT_EQ(values(beyond(empty, empty.windows.data), -9, 1),
              (std::vector<float>{unknown, nothing, nothing, nothing, nothing, nothing, nothing, nothing,
                                  nothing, nothing, 1})); // up to 8 pixels away
}

// Rim views saw surfaces 5 pixels near up to five pixels beyond the frame, so they would have shown the rest of it.
TEST(FrameExtension, WhatViewsWouldHaveShownIsNotMadeUp) {
    const double near = infinite_coc(lens) - 5, far = infinite_coc(lens) - 1.2; // CoCs 2.7 and 6.5
    const auto beside = [&](double last, const std::vector<double> &seen) {
        std::vector<double> cocs(20, far);
        cocs[19] = last;
        cocs.insert(cocs.end(), seen.begin(), seen.end());
        return values(beyond(row_of(cocs), {{0, 0}, {19, 0}}), 19, 26);
    };
    // A surface 1.2 pixels near was shown at the first pixel; from the second on it fills what the views left open. A
    // nearer surface ends where the views showed its end, whether it left the frame or not.
    const std::vector<double> ends{near, near, NAN, NAN, NAN};
    EXPECT_EQ(beside(far, ends), (std::vector<float>{19, 20, 21, 19, 19, 19, 19, 19}));
    EXPECT_EQ(beside(near, ends),
              (std::vector<float>{19, 20, 21, unknown, unknown, unknown, unknown, unknown}));
    // It continues from where they could look no farther, or from one pixel before, where parallax tears it.
    EXPECT_EQ(beside(far, {NAN, NAN, NAN, near, near}),
              (std::vector<float>{19, unknown, 19, 19, 23, 24, 24, 24}));
    EXPECT_EQ(beside(far, {NAN, NAN, NAN, near, NAN}),
              (std::vector<float>{19, unknown, 19, 19, 23, 19, 23, 23}));
}

// The same views through a lens of half their aperture: they showed as much, and each surface continues once, from its
// end.
TEST(FrameExtension, AStoppedDownLensGoesOnFromWhatWiderViewsShowed) {
    const double near = infinite_coc(lens) - 5, far = infinite_coc(lens) - 1.2;
    std::vector<double> cocs(20, far);
    cocs.insert(cocs.end(), {NAN, NAN, NAN, near, near});
    const Ldi ldi = row_of(cocs);
    const Imath::Box2i frame({0, 0}, {19, 0});
    const ThinLens stopped{.radius = lens.radius / 2, .focal_px = lens.focal_px, .focus = lens.focus};
    const auto beside = [&](const ThinLens &by, double views_radius) {
        return extend_beyond_frame(ldi, by, frame, frame, {7, 1}, 1, views_radius);
    };
    const FrameExtension open = beside(lens, 0), shut = beside(stopped, lens.radius);
    EXPECT_EQ(values(shut, 19, 26), (std::vector<float>{19, unknown, 19, 19, 23, 24, 24, 24}));
    EXPECT_EQ(shut.ldi.z, open.ldi.z);
    EXPECT_EQ(shut.ldi.begin, open.ldi.begin);
    EXPECT_EQ(shut.unseen, open.unseen);
}

// Three bars at the depth of the bar that the frame cuts off are 2 or 3 pixels wide; others are wider or at other
// depths.
TEST(FrameExtension, WhatIsCutOffEndsAsOthersAsNearAndWideDo) {
    const auto bars = [&](int cut, std::vector<int> widths, double c) {
        std::vector<double> cocs(std::size_t(cut), -2.9);
        for (const int width : widths) {
            cocs.insert(cocs.end(), 4, 5);
            cocs.insert(cocs.end(), std::size_t(width), c);
        }
        cocs.insert(cocs.end(), 64, 5);
        const Ldi ldi = row_of(cocs);
        return values(beyond(ldi, ldi.windows.data), -4, 0);
    };
    EXPECT_EQ(bars(2, {7, 3, 3}, -2.9), (std::vector<float>{2, 2, 2, 0, 0}));
    EXPECT_EQ(bars(2, {3, 2, 7}, -2.9), (std::vector<float>{2, 2, 2, 2, 0}));
    EXPECT_EQ(bars(3, {2}, -2.9), (std::vector<float>{3, 3, 3, 3, 0}));    // counted in whole pixels
    EXPECT_EQ(bars(4, {2, 1}, -2.9), (std::vector<float>{0, 0, 0, 0, 0})); // much wider than all others
    EXPECT_EQ(bars(2, {2, 2}, -1.5), (std::vector<float>{0, 0, 0, 0, 0})); // the others have different depths
    EXPECT_EQ(bars(2, {}, -2.9), (std::vector<float>{0, 0, 0, 0, 0}));
}

// A see-through thing in the middle of a picture of few rows ends no surface, so it does not come back at the border.
TEST(FrameExtension, WhatIsSeeThroughInsideDoesNotAppearAtTheBorder) {
    for (const int rows : {64, 72, 95, 96, 120}) {
        const Ldi ldi = make_ldi(windows_of_size(8, rows), coloured, [&](int, int y) {
            std::vector<Sample> samples{{depth_of(lens, 4), {0.5f, 1}}};
            if (3 * y >= rows && 3 * y < 2 * rows)
                samples.insert(samples.begin(), {depth_of(lens, -4), {0.9f, 0.9f}});
            return samples;
        });
        const FrameExtension all = beyond(ldi, ldi.windows.data);
        for (int y = all.ldi.windows.data.min.y; y < 0; ++y)
            for (const std::uint64_t i : all.ldi.pixel(all.ldi.windows.index(Imath::V2i(4, y))))
                EXPECT_EQ(all.ldi.values[0][i], 0.5f) << rows << " rows, row " << y;
    }
}

// With 3 x 3 sub-pixels, the bars are as wide and as far apart in pixels of the picture as those further above.
TEST(FrameExtension, WidthsAreCountedInPixelsOfThePicture) {
    const auto ends = [](int cut, int width, int apart) {
        std::vector<double> cocs(std::size_t(cut), -2.9);
        cocs.insert(cocs.end(), std::size_t(apart), 5);
        cocs.insert(cocs.end(), std::size_t(width), -2.9);
        cocs.insert(cocs.end(), 500, 5);
        const Ldi ldi = row_of(cocs);
        const Imath::Box2i frame = ldi.windows.data;
        return values(extend_beyond_frame(ldi, lens, frame, frame, {12, 1}, 3), -1, 0)[0] > 0;
    };
    EXPECT_TRUE(ends(9, 6, 12)); // one pixel narrower
    EXPECT_FALSE(ends(9, 5, 12));
    EXPECT_TRUE(ends(9, 9, 3 * 96 - 9 - 9 - 1));
    EXPECT_FALSE(ends(9, 9, 3 * 96));
}

TEST(FrameExtension, KeepsCoverageAndWhatIsBehind) {
    const Ldi ldi = make_ldi(windows_of_size(20, 1), grey_alpha, [](int x, int) {
        return x < 19
                   ? std::vector<Sample>{}
                   : std::vector<Sample>{{depth_of(lens, -4), {0.2f, 0.25f}}, {depth_of(lens, 3), {0.5f, 1}}};
    });
    const FrameExtension all = beyond(ldi, ldi.windows.data);
    const SampleRange samples = all.ldi.pixel(all.ldi.windows.index(Imath::V2i(24, 0)));
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(all.ldi.values[1][samples.front()], 0.25f);
    EXPECT_TRUE(all.unseen[all.ldi.windows.index(Imath::V2i(24, 0))]);
    EXPECT_FALSE(all.unseen[all.ldi.windows.index(Imath::V2i(-1, 0))]);
}

// A lamp of radius 5 pixels that is cut off 3 pixels from its middle has 2 pixels beyond.
TEST(FrameExtension, SmallLightsGoOnAsDiscs) {
    const Ldi ldi = make_ldi(windows_of_size(80, 80), coloured, [](int x, int y) {
        const float v = std::hypot(x + 0.5 - 3, y + 0.5 - 40) < 5 ? 100.0f : y < 10 ? 3.0f : 1.0f;
        return std::vector<Sample>{{depth_of(lens, 7), {v, 1}}};
    });
    const FrameExtension all = beyond(ldi, ldi.windows.data);
    const auto value = [&](int x, int y) {
        return all.ldi.values[0][all.ldi.pixel(all.ldi.windows.index(Imath::V2i(x, y))).front()];
    };
    EXPECT_EQ(value(0, 40), 100);
    EXPECT_NEAR(value(-1, 40), 100, 1e-4);
    double light = 0; // in units of the border's
    for (int n = 1; n <= 7; ++n) light += double(value(-n, 40)) / 100;
    EXPECT_NEAR(light, 2 * 1.75, 1); // 2 pixels, and the remaining light farther away
    EXPECT_EQ(value(-5, 33), 1);
    EXPECT_EQ(value(-5, 9), 3); // less than four times as bright: continues
    EXPECT_EQ(all.ldi.values[1][all.ldi.pixel(all.ldi.windows.index(Imath::V2i(-5, 40))).front()], 1);
}

// A lamp of radius 5 pixels is 5 pixels beyond the frame at a disparity of 4 pixels: rim views saw four columns of it.
TEST(FrameExtension, SmallLightsThatViewsCutOffGoOnAsDiscs) {
    const Imath::Box2i frame({10, 0}, {79, 79});
    const Ldi ldi = make_ldi(windows_of_size(80, 80), coloured, [&](int x, int y) {
        const bool lamp = x >= 6 && std::hypot(x + 0.5 - 5, y + 0.5 - 40) < 5;
        return lamp     ? std::vector<Sample>{{depth_of(lens, infinite_coc(lens) - 4), {100, 1}}}
               : x >= 9 ? std::vector<Sample>{{depth_of(lens, 7), {1, 1}}}
                        : std::vector<Sample>{};
    });
    const FrameExtension all = extend_beyond_frame(ldi, lens, frame, frame, {20, 20});
    const auto light = [&](int x, int y) {
        return double(all.ldi.values[0][all.ldi.pixel(all.ldi.windows.index(Imath::V2i(x, y))).front()]) /
               100;
    };
    for (int x = 1; x < 6; ++x) EXPECT_EQ(light(x, 40), 1) << x;
    EXPECT_LT(light(-6, 40), 0.3);
    EXPECT_EQ(light(5, 33), 0.01);
}

// Slow version: each pixel beyond the frame asks the nearest pixel of the frame.
TEST(FrameExtension, IsWhatTheRuleSays) {
    for (const bool opaque : {true, false}) {
        const Ldi ldi = random_surfaces(windows_of_size(70, 50), lens, opaque, 12);
        const Imath::Box2i frame({5, 0}, {69, 45}); // views looked past the left and the lower side
        const FrameExtension all = beyond(ldi, frame);
        const std::size_t alpha = opaque ? npos : ldi.alpha();
        const auto open = [&](const SampleRange &samples) {
            double left = 1;
            for (const std::uint64_t i : samples)
                left *= alpha == npos ? 0 : 1 - double(ldi.values[alpha][i]);
            return left >= 1.0 / 2048;
        };
        const auto of_pixel = [&](const Imath::V2i &at) {
            return ldi.windows.data.intersects(at) ? ldi.pixel(ldi.windows.index(at)) : SampleRange{0, 0};
        };
        const auto near = [&](std::uint64_t k) { return disparity(lens, double(ldi.z[k])); };
        // The samples m pixels from the frame beyond which no view looked, or one pixel farther with no sample.
        const auto seen_last = [&](const Imath::V2i &at, const Imath::V2i &step, int m) {
            std::vector<std::uint64_t> found;
            for (const std::uint64_t i : of_pixel(at)) {
                bool shown = false;
                for (const std::uint64_t k : of_pixel(at + step))
                    shown = shown || std::abs(near(k) - near(i)) < 0.5;
                if (near(i) < m + 0.5 || (near(i) < m + 1.5 && !shown)) found.push_back(i);
            }
            return found;
        };
        // Where the front surface at q ends beyond the frame, and its width inside it.
        struct End {
            double beyond = INFINITY;
            int width = 0;
        };
        const auto end_of = [&](const Imath::V2i &q, const Imath::V2i &in) {
            struct Run {
                double first, last;
                int width;
            };
            std::vector<Run> runs;
            for (int m = 0; m < 64; ++m) {
                if (!ldi.windows.data.intersects(q + m * in)) break;
                double depth = -1; // of the first opaque sample
                for (const std::uint64_t i : of_pixel(q + m * in))
                    if (depth < 0 && (alpha == npos || ldi.values[alpha][i] >= 0.9995f)) depth = near(i);
                if (runs.empty() || std::abs(depth - runs.back().last) >= 0.5)
                    runs.push_back({depth, depth, 1});
                else
                    runs.back().last = depth, ++runs.back().width;
            }
            End end;
            if (runs.size() < 2 || runs[0].first < 0 || runs[0].last < runs[1].first) return end;
            for (std::size_t r = 1; r + 1 < runs.size(); ++r)
                if (runs[r].first > runs[r - 1].last && runs[r].last > runs[r + 1].first &&
                    std::abs(runs[r].last - runs[0].first) < 0.5 && runs[r].width >= runs[0].width - 1)
                    end = {std::min(end.beyond, std::max(0.0, double(runs[r].width - runs[0].width))),
                           runs[0].width};
            return end;
        };
        struct Beyond {
            std::vector<std::uint64_t> samples;
            bool open;
        };
        const auto beside_frame = [&](const Imath::V2i &p) {
            const Imath::V2i q(std::clamp(p.x, 5, 69), std::clamp(p.y, 0, 45));
            const Imath::V2i step(std::clamp(p.x - q.x, -1, 1), std::clamp(p.y - q.y, -1, 1));
            const double n = std::max(std::abs(p.x - q.x), std::abs(p.y - q.y));
            const bool looked = p.x < 5 || p.y > 45;
            const End end = looked ? End{} : end_of(q, -step);
            const Imath::V2i from = n > end.beyond ? q - end.width * step : q;
            Beyond found{{}, open(of_pixel(from))};
            for (const std::uint64_t i : of_pixel(p)) found.samples.push_back(i);
            if (!open(of_pixel(p))) return found;
            if (!looked)
                for (const std::uint64_t i : of_pixel(from)) found.samples.push_back(i);
            else
                for (int m = 0; m < n; ++m)
                    for (const std::uint64_t i : seen_last(q + m * step, step, m))
                        if (near(i) < n - 0.5) found.samples.push_back(i);
            return found;
        };
        const auto past_corner = [&](const Imath::V2i &p) {
            const Beyond above = beside_frame({std::clamp(p.x, 5, 69), p.y}),
                         beside = beside_frame({p.x, std::clamp(p.y, 0, 45)});
            Beyond found{{}, above.open};
            for (const std::uint64_t i : of_pixel(p)) found.samples.push_back(i);
            if (!open(of_pixel(p))) return found;
            for (const std::uint64_t i : above.samples)
                if (std::ranges::any_of(beside.samples,
                                        [&](std::uint64_t k) { return std::abs(near(k) - near(i)) < 0.5; }))
                    found.samples.push_back(i);
            return found;
        };
        for (int y = -8; y < 54; ++y)
            for (int x = -3; x < 78; ++x) {
                const Imath::V2i p(x, y);
                if (frame.intersects(p)) continue;
                ASSERT_TRUE(all.ldi.windows.data.intersects(p)) << p;
                const Beyond there =
                    (x < 5 || x > 69) && (y < 0 || y > 45) ? past_corner(p) : beside_frame(p);
                std::vector<float> expected, found;
                for (const std::uint64_t i : there.samples) expected.push_back(ldi.z[i]);
                std::ranges::sort(expected);
                const std::size_t pixel = all.ldi.windows.index(Imath::V2i(x, y));
                for (const std::uint64_t i : all.ldi.pixel(pixel)) found.push_back(all.ldi.z[i]);
                ASSERT_EQ(found, expected) << p;
                ASSERT_EQ(!all.unseen[pixel], there.open) << p;
            }
    }
}

// Pictures of endless shapes, seen in a frame.

using Inside = std::function<bool(double, double)>;

double covered_share(const Inside &inside, int x, int y) {
    int covered = 0;
    for (int i = 0; i < 64; ++i) covered += inside(x + (i % 8 + 0.5) / 8, y + (i / 8 + 0.5) / 8);
    return covered / 64.0;
}

constexpr int width = 80, height = 45;

// The pixels of a shape at that disparity that five views show.
Windows shown_windows(double near, bool five) {
    Windows windows = windows_of_size(width, height);
    if (!five) return windows;
    windows.data.min -= Imath::V2i(int(near + 0.5));
    windows.data.max += Imath::V2i(int(near + 0.5));
    return windows;
}
bool in_frame(int x, int y) { return x >= 0 && y >= 0 && x < width && y < height; }
// Rim views to the left, right, above and below do not see corners.
bool in_corner(int x, int y) { return (x < 0 || x >= width) && (y < 0 || y >= height); }

// A shape of value 0.8 at CoC c before nothing.
Ldi element(const Inside &inside, double c, const ThinLens &by, bool five) {
    return make_ldi(shown_windows(near_of(by, c), five), grey_alpha, [&](int x, int y) {
        const auto alpha = float(in_corner(x, y) ? 0 : covered_share(inside, x, y));
        return alpha == 0 ? std::vector<Sample>{}
                          : std::vector<Sample>{{depth_of(by, c), {0.8f * alpha, alpha}}};
    });
}

// A dark shape at CoC c before a sky of value 0.5; no view saw the sky beyond the frame.
Ldi before_sky(const Inside &inside, double c, const ThinLens &by, bool five) {
    return make_ldi(shown_windows(near_of(by, c), five), grey, [&](int x, int y) {
        if (in_corner(x, y)) return std::vector<Sample>{};
        if (inside(x + 0.5, y + 0.5)) return std::vector<Sample>{{depth_of(by, c), {0}}};
        return in_frame(x, y) ? std::vector<Sample>{{INFINITY, {0.5f}}} : std::vector<Sample>{};
    });
}

// How much of a shape each pixel sees, given the shape's pixels up to 35 beyond the frame.
class Convolution {
public:
    explicit Convolution(const Inside &inside) : grid_(width + 2 * around, height + 2 * around) {
        for (std::size_t i = 0; i < grid_.size(); ++i) {
            const Imath::V2i at = grid_.position(i) - Position(around, around);
            covered_.push_back(covered_share(inside, at.x, at.y));
        }
    }
    // A lens point shows a sample one pixel wide to a pixel one pixel wide, so the result is linear between pixels.
    double at(double c, int x, int y) const {
        static const auto points = spiral_lens_points(2048);
        double covered = 0;
        for (const Imath::V2d &point : points) {
            const double px = x - c * point.x, py = y + c * point.y;
            const int left = int(std::floor(px)), top = int(std::floor(py));
            covered +=
                std::lerp(std::lerp(here(left, top), here(left + 1, top), px - left),
                          std::lerp(here(left, top + 1), here(left + 1, top + 1), px - left), py - top);
        }
        return covered / double(points.size());
    }

private:
    static constexpr int around = 35;
    double here(int x, int y) const { return covered_[grid_.index(Position(x + around, y + around))]; }
    ArrayGrid grid_;
    std::vector<double> covered_;
};

// The largest difference of a channel from expected(x, y), along the borders and across the middle.
double off(const Ldi &ldi, const ThinLens &by, std::size_t channel,
           const std::function<double(int, int)> &expected) {
    Progress silent;
    PictureOptions options;
    options.gather.lens.quality = Quality::final;
    const Imath::Box2i frame({0, 0}, {width - 1, height - 1});
    const Image image = gather_picture(ldi, by, frame, frame, options, silent);
    double worst = 0;
    for (int y = 0; y < height; y += 3)
        for (int x = 0; x < width; x += 3) {
            if (x > 6 && x < width - 9 && y > 6 && y < height - 9 && x % 15 && y % 15) continue;
            worst = std::max(worst, std::abs(double(image.at(channel, x, y)) - expected(x, y)));
        }
    return worst;
}

struct Shape {
    const char *name;
    Inside inside;
};
const std::vector<Shape> shapes{
    {"from top to bottom", [](double x, double) { return x > 35.3 && x < 48.3; }},
    {"from left to right", [](double, double y) { return y > 15 && y < 28; }},
    {"along the left side", [](double x, double) { return x < 9.3; }},
    {"along the upper side", [](double, double y) { return y < 9.3; }},
    {"along the right side", [](double x, double) { return x > width - 9.3; }},
    {"along the lower side", [](double, double y) { return y > height - 9.3; }},
    {"over a corner", [](double x, double y) { return x > 50 && y > 25; }},
    {"over the opposite corner", [](double x, double y) { return x < 20 && y < 15; }},
};

TEST(FrameExtension, ElementsThatTheFrameCutsOffStayOpaque) {
    for (const auto &[name, inside] : shapes) {
        const Convolution shape(inside);
        for (const bool five : {false, true})
            for (const double c : {-30.0, -22.0, -4.0, 4.0, 22.0, 30.0}) {
                const auto share = [&](int x, int y) { return shape.at(c, x, y); };
                EXPECT_LT(off(element(inside, c, strong, five), strong, 1, share), 0.01)
                    << name << ", CoC " << c << (five ? ", five views" : ", one view");
            }
    }
}

TEST(FrameExtension, TheSkyBesideABarThatLeavesIsNoDarkerThere) {
    for (const auto &[name, inside] : shapes) {
        const Convolution shape([&, &covers = inside](double x, double y) { // its pixels are whole
            return covers(std::floor(x) + 0.5, std::floor(y) + 0.5);
        });
        for (const bool five : {false, true})
            for (const double c : {-22.0, -8.0}) {
                const auto light = [&](int x, int y) { return 0.5 * (1 - shape.at(c, x, y)); };
                EXPECT_LT(off(before_sky(inside, c, lens, five), lens, 0, light), 0.01)
                    << name << ", CoC " << c << (five ? ", five views" : ", one view");
            }
    }
}

} // namespace
} // namespace sparselens
