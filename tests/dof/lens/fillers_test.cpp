// Fillers: by hand on a row of pixels, and compared with a slow version; and their effect in the lens gather, compared
// with closed forms.
#include "dof/lens/fillers.h"
#include "dof/lens/lens_gather.h"
#include "lens/lens_points.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5}; // CoC up to 7.7 px behind focus
const std::vector<Channel> grey{{"Y"}}, grey_alpha{{"Y"}, {"A"}};

// A row with one sample per pixel at these CoCs, none where it is NAN. The value of a sample is its column.
Ldi row_of(const std::vector<double> &cocs) {
    return make_ldi(windows_of_size(int(cocs.size()), 1), grey, [&](int x, int) {
        const double c = cocs[std::size_t(x)];
        return std::isnan(c) ? std::vector<Sample>{} : std::vector<Sample>{{depth_of(lens, c), {float(x)}}};
    });
}

// The value of a filler of each pixel, the first or the last; -1: no filler, -2: a filler of nothing.
std::vector<float> filled(const Ldi &ldi, const KnownPixels &known, bool last = false) {
    std::vector<float> values(ldi.windows.pixels(), -1);
    for (const Filler &filler : find_fillers(ldi, lens, known)) {
        float &value = values[filler.pixel];
        if (value != -1 && !last) continue;
        value = filler.is_nothing() ? -2 : 0;
        for (const Filler::Part &part : filler.parts())
            if (!filler.is_nothing()) value += part.share * ldi.values[0][part.sample];
    }
    return values;
}
std::vector<float> filled(const Ldi &ldi, bool last = false) { return filled(ldi, ldi.windows.data, last); }

TEST(Fillers, TheFartherSideGoesOnBehindTheNearerOne) {
    // 2.5 pixels nearer: the lens sees three pixels past an edge, four along the row if it runs at 45 degrees.
    EXPECT_EQ(filled(row_of({3, 3, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5})),
              (std::vector<float>{-1, -1, 1, 1, 1, 1, -1, -1, -1}));
    // Between two sides the nearer one, and the mean in the middle; weighted by distance.
    const std::vector<float> between = filled(row_of({4, -4, -4, -4, 4}));
    EXPECT_FLOAT_EQ(between[1], (0 * 1 + 4 / 3.0f) / (1 + 1 / 3.0f));
    EXPECT_FLOAT_EQ(between[2], 2);
    EXPECT_FLOAT_EQ(between[3], (0 / 3.0f + 4) / (1 + 1 / 3.0f));
    // One surface does not continue behind itself, however steep.
    EXPECT_EQ(filled(row_of({3, 2.6, 2.2, 1.8, 1.4, 1, 0.6})), std::vector<float>(7, -1));
    // If two continue, the one whose edge is nearer, and the farther one behind it.
    EXPECT_EQ(filled(row_of({7, 7, 3, -3, -3})), (std::vector<float>{-1, -1, 1, 2, 2}));
    EXPECT_EQ(filled(row_of({7, 7, 3, -3, -3}), true), (std::vector<float>{-1, -1, 1, 1, 1}));
    EXPECT_EQ(filled(row_of({7, 7, 3, -1, -6, -6}), true), (std::vector<float>{-1, -1, 1, 1, 1, 1}));
}

TEST(Fillers, NothingGoesOnToo) {
    EXPECT_EQ(filled(row_of({NAN, 3, 3, 3, NAN})), (std::vector<float>{-1, -2, -2, -2, -1}));
}

TEST(Fillers, WhereNothingIsKnownNoneGoesOn) {
    const Ldi ldi = row_of({NAN, NAN, NAN, 1.4, -7, -7, NAN, -7, -7, NAN, NAN});
    const Imath::Box2i known({0, 0}, {5, 0});
    EXPECT_EQ(filled(ldi, known), (std::vector<float>{-1, -1, -1, -2, 3, 3, -1, -1, -1, -1, -1}));
    EXPECT_EQ(filled(ldi, known, true), (std::vector<float>{-1, -1, -1, -2, -2, -2, -1, -1, -1, -1, -1}));
    std::vector<char> unseen(11, 0);
    unseen[2] = 1;
    EXPECT_EQ(filled(ldi, KnownPixels(known, unseen)),
              (std::vector<float>{-1, -1, -1, -1, 3, 3, -1, -1, -1, -1, -1}));
}

// A ground of coverage 0.8 continues as opaque; one of less than half does not.
TEST(Fillers, GoOnOpaque) {
    const auto picture = [](float behind) {
        return make_ldi(windows_of_size(4, 1), grey_alpha, [behind](int x, int) {
            std::vector<Sample> samples{{depth_of(lens, -4), {1, 1}}};
            if (x == 0) samples.push_back({depth_of(lens, 4), {0.5f * behind, behind}});
            return samples;
        });
    };
    EXPECT_EQ(filled(picture(0.8f)), (std::vector<float>{-1, 0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(filled(picture(0.4f)), std::vector<float>(4, -1));
}

// A veil behind a bar ends there in something of higher coverage. Views saw that, so the veil does not continue behind
// it; a farther surface does.
TEST(Fillers, AVeilThatWasSeenIsNotFilledUp) {
    const auto picture = [](double coc) {
        return make_ldi(windows_of_size(3, 1), grey_alpha, [coc](int x, int) {
            std::vector<Sample> samples{{depth_of(lens, -4), {1, 1}}};
            if (x == 0) samples.push_back({depth_of(lens, 4), {0.3f, 0.6f}});
            if (x == 1) samples.push_back({depth_of(lens, coc), {0.1f, 0.2f}});
            return samples;
        });
    };
    EXPECT_EQ(filled(picture(4)), (std::vector<float>{-1, -1, 0.5f}));
    EXPECT_EQ(filled(picture(3)), (std::vector<float>{-1, 0.5f, 0.5f}));
}

// Slow version: each pixel searches its row and column for the grounds that continue up to it.
TEST(Fillers, AreWhatTheRuleSays) {
    for (const bool opaque : {true, false}) {
        const Ldi ldi = random_surfaces(windows_of_size(70, 50), lens, opaque, 12);
        const Imath::Box2i known({5, 4}, {60, 45});
        const auto ground = [&](const Imath::V2i &at) { // disparity, -1: unknown
            double left = 1, depth = -1;
            for (const std::uint64_t i : ldi.pixel(ldi.windows.index(at))) {
                const double alpha = opaque ? 1 : double(ldi.values[ldi.alpha()][i]);
                left *= 1 - alpha;
                if (alpha >= 0.5) depth = disparity(lens, double(ldi.z[i]));
            }
            return left < 1.0 / 2048 ? depth : known.intersects(at) ? 0 : -1;
        };
        const auto goes_on = [&](double from, const Imath::V2i &end, const Imath::V2i &step, int n) {
            for (int m = 1; m <= n; ++m)
                if (const double to = ground(end + m * step);
                    to < 0 || to - from <= std::max(0.5, (m - 1) / std::sqrt(2.0)))
                    return false;
            return from >= 0;
        };
        std::vector<std::vector<double>> expected(ldi.windows.pixels()), depths = expected;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const Imath::V2i at = ldi.windows.pixel(i);
            std::vector<std::pair<int, double>> nearest, farthest; // of each direction: distance and depth
            for (const Imath::V2i &step : {Imath::V2i(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
                std::vector<std::pair<int, double>> found;
                for (int n = 1; ldi.windows.grid().contains(at - n * step); ++n)
                    if (const double from = ground(at - n * step); goes_on(from, at - n * step, step, n))
                        found.push_back({n, from});
                if (found.empty()) continue;
                nearest.push_back(found.front());
                farthest.push_back(*std::ranges::min_element(found, {}, &std::pair<int, double>::second));
            }
            const auto add = [&](double depth) {
                for (const std::uint64_t s : ldi.pixel(i))
                    if (depth > 0 && std::abs(disparity(lens, double(ldi.z[s])) - depth) < 0.5) return;
                expected[i].push_back(depth);
            };
            if (nearest.empty()) continue;
            const double first = std::ranges::min(nearest).second;
            add(first);
            std::erase_if(farthest, [&](const auto &end) { return first - end.second <= 0.5; });
            if (!farthest.empty()) add(std::ranges::min(farthest).second);
        }
        for (const Filler &filler : find_fillers(ldi, lens, known))
            depths[filler.pixel].push_back(disparity(lens, double(filler.z)));
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_EQ(depths[i].size(), expected[i].size()) << i;
            for (std::size_t n = 0; n < depths[i].size(); ++n)
                ASSERT_NEAR(depths[i][n], expected[i][n], 1e-5) << i;
        }
    }
}

// A red post at CoC -4 before a grey wall at CoC 4; `edge` is the wall's last pixel. Returns red and green of the
// nearer filler of the next pixel.
std::array<float, 2> filled_beside(const std::vector<Sample> &edge) {
    const Ldi ldi = make_ldi(windows_of_size(6, 1), rgba_channels(), [&](int x, int) {
        if (x == 2) return edge;
        return x < 2 ? std::vector<Sample>{{depth_of(lens, 4), {0.5f, 0.5f, 0.5f, 1}}}
                     : std::vector<Sample>{{depth_of(lens, -4), {0.8f, 0, 0, 1}}};
    });
    std::array<float, 2> colour{0, 0};
    const LargeArray<Filler> fillers = find_fillers(ldi, lens, ldi.windows.data);
    for (const Filler::Part &part : std::ranges::find(fillers, 3u, &Filler::pixel)->parts())
        for (std::size_t k = 0; k < 2; ++k) colour[k] += part.share * ldi.values[k][part.sample];
    return colour;
}

TEST(Fillers, ShowNothingOfWhatHidesThem) {
    using Colour = std::array<float, 2>;
    const double wall = depth_of(lens, 4), post = depth_of(lens, -4);
    // A third of the edge shows the post; a green edge is not a mixture.
    EXPECT_EQ(filled_beside({{wall, {0.6f, 1 / 3.0f, 1 / 3.0f, 1}}}), (Colour{0.5f, 0.5f}));
    EXPECT_EQ(filled_beside({{wall, {0.4f, 0.6f, 0.4f, 1}}}), (Colour{0.4f, 0.6f}));
    // Unmixed samples, and other surfaces, stay as they are.
    EXPECT_EQ(filled_beside({{post, {0.27f, 0, 0, 0.333f}}, {wall, {0.55f, 0.45f, 0.45f, 1}}}),
              (Colour{0.55f, 0.45f}));
    EXPECT_EQ(filled_beside({{depth_of(lens, 2), {0.6f, 1 / 3.0f, 1 / 3.0f, 1}}}), (Colour{0.6f, 1 / 3.0f}));
}

using Inside = std::function<bool(double, double)>;

// A shape of value 0.8 at CoC c before nothing, antialiased.
Ldi shape_over_nothing(const Windows &windows, const ThinLens &by, const Inside &inside, double c) {
    return make_ldi(windows, grey_alpha, [&](int x, int y) {
        int covered = 0;
        for (int i = 0; i < 256; ++i) covered += inside(x + (i % 16 + 0.5) / 16, y + (i / 16 + 0.5) / 16);
        const float alpha = float(covered) / 256;
        return covered == 0 ? std::vector<Sample>{}
                            : std::vector<Sample>{{depth_of(by, c), {0.8f * alpha, alpha}}};
    });
}

constexpr int side = 80 + 2 * 17; // no lens point looks past the border

// The largest difference from the shape convolved with the disc of the lens, averaged over the pixel: along a row, a
// column and the diagonal.
double off_from_convolution(const Inside &inside, double c, const ThinLens &by) {
    const Windows windows = windows_of_size(side, side);
    Progress silent;
    const Image image = lens_gather(shape_over_nothing(windows, by, inside, c), by, windows.data,
                                    {.quality = Quality::final}, silent);
    const auto points = spiral_lens_points(2000);
    double worst = 0;
    const auto compare = [&](int x, int y) {
        double covered = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double u = (double(i % 16) + 0.5) / 16, v = (double(i / 16 % 16) + 0.5) / 16;
            covered += inside(x + u - c * points[i].x, y + v + c * points[i].y);
        }
        covered /= double(points.size());
        worst = std::max({worst, std::abs(double(image.at(1, x, y)) - covered),
                          std::abs(double(image.at(0, x, y)) - 0.8 * covered)});
    };
    for (int x = 0; x < side; ++x)
        compare(x, side / 2), compare(side / 2, x), compare(x, x), compare(x, side / 3);
    return worst;
}

const ThinLens strong{.radius = 0.15, .focal_px = 640, .focus = 6}; // CoC up to 16 px behind focus

TEST(Fillers, ShapesOverNothingAreConvolvedWithTheLens) {
    constexpr double middle = side / 2;
    const auto radius = [](double x, double y) { return std::hypot(x - middle, y - middle); };
    const Inside disc = [&](double x, double y) { return radius(x, y) < 20; };
    const Inside ring = [&](double x, double y) { return radius(x, y) < 23 && radius(x, y) > 13; };
    const Inside square = [](double x, double y) {
        return std::max(std::abs(x - middle - 0.3), std::abs(y - middle - 0.3)) < 16;
    };
    for (const double c : {-15.0, -6.9, -3.0, 3.0, 15.0})
        EXPECT_LT(off_from_convolution(disc, c, strong), 0.02) << c;
    for (const double c : {-14.0, 6.9}) {
        EXPECT_LT(off_from_convolution(ring, c, strong), 0.02) << c;
        EXPECT_LT(off_from_convolution(square, c, strong), 0.02) << c;
    }
}

Image gather(const Ldi &ldi, const ThinLens &by = lens) {
    Progress silent;
    return lens_gather(ldi, by, ldi.windows.data, {.lens_samples = 256}, silent);
}

// A plane of value 1 that comes nearer by 0.3 pixels of CoC per pixel, before a wall of 0 that continues behind its
// edge: no crack by parallax shows the wall.
TEST(Fillers, ASlantedPlaneStaysClosed) {
    const Ldi ldi = make_ldi(windows_of_size(100, 60), grey, [](int x, int) {
        return std::vector<Sample>{x < 40 ? Sample{depth_of(lens, 6), {0}}
                                          : Sample{depth_of(lens, 1 - 0.3 * (x - 40)), {1}}};
    });
    const Image image = gather(ldi);
    for (int x = 40 + 8; x < 100; ++x) ASSERT_NEAR(image.at(0, x, 30), 1, 1e-5) << x;
}

// The surfaces beside a pillar continue behind it, but lamps do not.
TEST(Fillers, LampsDoNotGoOn) {
    const auto picture = [](float lamp) {
        return make_ldi(windows_of_size(120, 80), rgba_channels(), [lamp](int x, int y) {
            const bool pillar = x >= 56 && x < 64, lit = x == 64 && y == 40;
            const float v = lit ? lamp : pillar ? 0 : 0.1f;
            return std::vector<Sample>{{depth_of(lens, pillar ? -6 : 6), {v, v, v, 1}}};
        });
    };
    const auto light = [](const Image &image) {
        double sum = 0;
        for (const float v : image.plane(0)) sum += double(v);
        return sum;
    };
    // The pillar hides a strip of the lamp's disc, from 4 1/4 to 1/4 of 6 pixels left of its middle.
    const auto left_of = [](double t) {
        return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
    };
    const double seen = 1 - left_of(-0.25 / 6) + left_of(-4.25 / 6);
    EXPECT_NEAR(light(gather(picture(100))) - light(gather(picture(0.1f))), 99.9 * seen, 0.03 * 99.9);
}

// Nothing is invented beyond the picture: the border of a picture that continues is the mean of the known part.
TEST(Fillers, NothingIsInventedBeyondTheData) {
    const std::vector<Channel> no_lamps{{"V"}};
    const Ldi ldi = make_ldi(windows_of_size(80, 40), no_lamps, [](int x, int) {
        return std::vector<Sample>{{depth_of(lens, 5), {x == 0 ? 100.0f : 1.0f}}};
    });
    const Image image = gather(ldi);
    double sum = 0, expected = 0; // light above 1
    for (int x = 0; x < 12; ++x) {
        sum += double(image.at(0, x, 20)) - 1;
        int hit = 0, known = 0;
        for (int i = 0; i < 16; ++i) // of each pixel
            for (const Imath::V2d &u : spiral_lens_points(1000)) {
                const double at = x + (i + 0.5) / 16 - 5 * u.x;
                hit += at >= 0 && at < 1;
                known += at >= 0;
            }
        expected += 99 * double(hit) / known;
    }
    EXPECT_NEAR(sum, expected, 0.02 * expected); // a border continued outwards would give about 200
    EXPECT_TRUE(find_fillers(ldi, lens, ldi.windows.data).empty());
}

} // namespace
} // namespace sparselens
