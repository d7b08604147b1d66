// Pictures of an open shutter whose values are known in closed form.
#include "base/error.h"
#include "chain/notices.h"
#include "chain/take_moments.h"
#include "io/exr/exr_deep.h"
#include "io/files/text_file.h"
#include "io/moment_files.h"
#include "support/lens_ldi.h"
#include "support/mattes.h"
#include "support/scratch_folder.h"
#include "support/share_of_disc.h"

#include <ImfIntAttribute.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

OpenedLdi opened(Ldi ldi, const std::string &name = "x.exr") {
    OpenedLdi in;
    in.name = name;
    in.header = Imf::Header(ldi.windows.display, ldi.windows.data);
    in.ldi = std::move(ldi);
    in.samples_read = in.ldi.samples();
    in.camera.focal_length_mm = lens.focal_px;
    in.camera.sensor_width_mm = in.ldi.windows.display_width();
    in.camera.lens_radius = lens.radius;
    in.camera.focus_distance = lens.focus;
    return in;
}

TakenPicture taken(const std::vector<OpenedLdi> &moments, const PictureRequest &request = {},
                   std::vector<Notice> *told = nullptr) {
    std::vector<const OpenedLdi *> all;
    for (const OpenedLdi &moment : moments) all.push_back(&moment);
    Progress silent;
    return take_moments(all, request, {silent, [&](const Notice &notice) {
                                           if (told) told->push_back(notice);
                                       }});
}

// A card with id 1, 8 pixels of CoC in front of focus, whose edge stands at `edge`; a plane in focus with id 2 behind it,
// or nothing.
OpenedLdi card(int edge, bool plane = true) {
    return opened(make_ldi(windows_of_size(96, 24), channels_with_matte(), [=](int x, int) {
        const Sample front{depth_of(lens, -8), {1, 0.5f, 0, 1, hashed(1), 1, 0, 0}};
        const Sample back{lens.focus, {0, 0, 1, 1, hashed(2), 1, 0, 0}};
        std::vector<Sample> samples;
        if (x < edge) samples.push_back(front);
        if (plane) samples.push_back(back);
        return samples;
    }));
}

constexpr int edges[] = {36, 40, 44, 48};

std::vector<OpenedLdi> moving_card(bool plane = true) {
    std::vector<OpenedLdi> moments;
    for (const int edge : edges) moments.push_back(card(edge, plane));
    return moments;
}

// The card's blurred edge, convolved with its path.
double expected_card(int x, std::span<const double> weights) {
    double sum = 0, all = 0;
    for (std::size_t m = 0; m < weights.size(); ++m) {
        sum += weights[m] * share_of_disc(8, edges[m] - (x + 0.5));
        all += weights[m];
    }
    return sum / all;
}

// With the bounds of LensMattes, each moment must have about as many points as the still there.
PictureRequest with_many_points() {
    PictureRequest request;
    request.picture.gather.lens.lens_samples = 1024;
    return request;
}

TEST(TakeMoments, AMovingEdgeIsItsDiscConvolvedWithItsPath) {
    const Image picture = taken(moving_card(false), with_many_points()).image;
    for (int x = 20; x < 70; ++x) {
        const double expected = expected_card(x, std::array{1.0, 1.0, 1.0, 1.0});
        EXPECT_NEAR(picture.at(0, x, 12), expected, 0.02) << x;
        EXPECT_NEAR(picture.at(1, x, 12), expected / 2, 0.01) << x;
        EXPECT_NEAR(picture.at(3, x, 12), expected, 0.02) << x;
    }
}

TEST(TakeMoments, AreWeightedByTheCurve) {
    PictureRequest request = with_many_points();
    request.shutter_curve = "triangle";
    const Image picture = taken(moving_card(), request).image;
    for (int x = 20; x < 70; ++x)
        EXPECT_NEAR(picture.at(0, x, 12), expected_card(x, std::array{0.25, 0.75, 0.75, 0.25}), 0.02) << x;
}

// Light of the card and of the plane, their alpha, and the coverages of their ids each add up to one.
void expect_whole(const Image &picture, int x, int y) {
    const std::size_t pixel = picture.windows.index(Imath::V2i(x, y));
    const double front = coverage_in(picture, hashed(1), pixel),
                 back = coverage_in(picture, hashed(2), pixel);
    EXPECT_EQ(picture.at(3, x, y), 1) << x << ' ' << y;
    EXPECT_NEAR(picture.at(0, x, y) + picture.at(2, x, y), 1, 1e-4) << x << ' ' << y;
    EXPECT_NEAR(front + back, 1, 1e-4) << x << ' ' << y;
    EXPECT_NEAR(front, picture.at(0, x, y), 0.01) << x << ' ' << y;
    const std::vector<Matte> mattes = find_mattes(picture.channels);
    EXPECT_GE(picture.plane(mattes[0].ranks[0].coverage)[pixel],
              picture.plane(mattes[0].ranks[1].coverage)[pixel]);
}

TEST(TakeMoments, CoveragesAddUpToOne) {
    for (const double duration : {0.3, 1.0}) {
        PictureRequest request;
        request.rolling_shutter = duration;
        const Image picture = taken(moving_card(), request).image;
        for (const int y : {0, 12, 23})
            for (int x = 20; x < 70; ++x) expect_whole(picture, x, y);
    }
}

// A dot in focus that moves a pixel each moment is a streak.
TEST(TakeMoments, InFocusAreTheExactMean) {
    std::vector<OpenedLdi> moments;
    for (int m = 0; m < 8; ++m)
        moments.push_back(opened(make_ldi(windows_of_size(40, 20), rgba_channels(), [=](int x, int y) {
            return x == 10 + m && y == 9 ? std::vector<Sample>{{lens.focus, {4, 2, 1, 1}}}
                                         : std::vector<Sample>();
        })));
    const Image picture = taken(moments).image;
    for (int x = 0; x < 40; ++x) {
        const float share = x >= 10 && x < 18 ? 0.125f : 0.0f;
        EXPECT_EQ(picture.at(0, x, 9), 4 * share) << x;
        EXPECT_EQ(picture.at(3, x, 9), share) << x;
        EXPECT_EQ(picture.at(3, x, 8), 0) << x;
    }
}

// A rolling shutter slants a bar that moves a pixel each moment. In each row its mean position is that in the middle of
// the row's exposure.
TEST(TakeMoments, ARollingShutterSlantsABarThatMoves) {
    constexpr int moments = 8, height = 20;
    std::vector<OpenedLdi> bars;
    for (int m = 0; m < moments; ++m)
        bars.push_back(opened(make_ldi(windows_of_size(40, height), rgba_channels(), [=](int x, int) {
            return x == 10 + m ? std::vector<Sample>{{lens.focus, {4, 2, 1, 1}}} : std::vector<Sample>();
        })));
    for (const double duration : {0.125, 0.25, 0.75}) {
        PictureRequest request;
        request.rolling_shutter = duration;
        const Image picture = taken(bars, request).image;
        for (int y = 0; y < height; ++y) {
            const double time = (y + 0.5) / height * (1 - duration) + duration / 2;
            double alpha = 0, light = 0, moment = 0;
            for (int x = 0; x < 40; ++x) {
                alpha += double(picture.at(3, x, y));
                light += double(picture.at(0, x, y));
                moment += double(picture.at(3, x, y)) * (x + 0.5);
            }
            EXPECT_NEAR(alpha, 1, 1e-6) << y;
            EXPECT_NEAR(light, 4, 1e-5) << y;
            EXPECT_NEAR(moment, 10 + time * moments, 1e-5) << y;
        }
    }
}

// A lamp of one pixel, with this CoC, moves by `step` pixels each moment, before a plane in focus. A dim card beside it
// is out of focus, so that the picture is not sharp everywhere.
constexpr float lamp_light = 1000;
constexpr int lamp_from = 40, lamp_row = 48, lamp_moments = 4;

std::vector<OpenedLdi> moving_lamp(double coc, int step) {
    std::vector<OpenedLdi> moments;
    for (int m = 0; m < lamp_moments; ++m)
        moments.push_back(opened(make_ldi(windows_of_size(200, 96), rgba_channels(), [=](int x, int y) {
            std::vector<Sample> samples;
            if (x == lamp_from + step * m && y == lamp_row)
                samples.push_back({coc == 0 ? lens.focus : depth_of(lens, coc), {lamp_light, 0, 0, 1}});
            else if (x < 6)
                samples.push_back({depth_of(lens, -3), {0.01f, 0.01f, 0.01f, 1}});
            samples.push_back({lens.focus * 1.001, {0.01f, 0.01f, 0.01f, 1}});
            return samples;
        })));
    return moments;
}

// The share of a pixel that a disc of this radius covers in the mean, while its middle moves from x0 to x1 in its row.
double share_of_path(double radius, double x0, double x1, double x, double y) {
    constexpr int times = 400, across = 8;
    int inside = 0;
    for (int t = 0; t < times; ++t)
        for (int i = 0; i < across * across; ++i) {
            const double dx = x + (i % across + 0.5) / across - (x0 + (x1 - x0) * (t + 0.5) / times),
                         dy = y + (i / across + 0.5) / across - (lamp_row + 0.5);
            inside += dx * dx + dy * dy < radius * radius;
        }
    return inside / double(times * across * across);
}

TEST(TakeMoments, ALampThatMovesIsItsDiscConvolvedWithItsPath) {
    constexpr double radius = 6;
    constexpr int step = 20;
    const Image picture = taken(moving_lamp(-radius, step)).image;
    const double area = std::numbers::pi * radius * radius, from = lamp_from + 0.5 - step / 2.0,
                 to = from + step * lamp_moments;
    double light = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 20; x < 180; ++x) light += double(picture.at(0, x, y)) - 0.01;
    EXPECT_NEAR(light, double(lamp_light), 0.005 * double(lamp_light));
    const double even = double(lamp_light) * 2 * radius / area / (to - from); // in the middle of the streak
    for (const int y : {lamp_row - 7, lamp_row - 4, lamp_row, lamp_row + 3})
        for (int x = 16; x < 180; ++x)
            EXPECT_NEAR(picture.at(0, x, y),
                        0.01 + double(lamp_light) / area * share_of_path(radius, from, to, x, y), 0.03 * even)
                << x << ' ' << y;
}

// The pixels of a ball are not equally near. On their paths they do not hide each other.
TEST(TakeMoments, ABallOfLightThatMovesKeepsItsLight) {
    std::vector<OpenedLdi> moments;
    for (int m = 0; m < lamp_moments; ++m)
        moments.push_back(opened(make_ldi(windows_of_size(200, 96), rgba_channels(), [=](int x, int y) {
            const int dx = x - lamp_from - 12 * m, dy = y - lamp_row, square = dx * dx + dy * dy;
            if (square > 9) return std::vector<Sample>{{lens.focus, {0.01f, 0.01f, 0.01f, 1}}};
            return std::vector<Sample>{{depth_of(lens, -5.5 + 0.05 * square), {lamp_light, 0, 0, 1}}};
        })));
    const Image picture = taken(moments).image;
    double light = 0;
    for (const float red : picture.plane(0)) light += double(red) - 0.01;
    EXPECT_NEAR(light, 29 * double(lamp_light), 0.005 * 29 * double(lamp_light));
}

TEST(TakeMoments, ALampInFocusThatMovesIsAnEvenLine) {
    constexpr int step = 12;
    const Image picture = taken(moving_lamp(0, step)).image;
    const double even = double(lamp_light) / (step * lamp_moments);
    for (int x = lamp_from - step / 2 + 2; x < lamp_from + step * lamp_moments - step / 2 - 1; ++x)
        EXPECT_NEAR(picture.at(0, x, lamp_row), even, 0.06 * even) << x;
    EXPECT_LT(picture.at(0, lamp_from - step / 2 - 2, lamp_row), 0.02 * even);
}

TEST(TakeMoments, OneIsTheStill) {
    const OpenedLdi in = opened(random_surfaces(windows_of_size(64, 48), lens, false, 3));
    Progress silent;
    const Notify nobody = [](const Notice &) {};
    EXPECT_EQ(taken({in}).image.values, take_picture(in, {}, {silent, nobody}).image.values);
    ScratchFolder folder;
    write_ldi(folder.file("ldi_0.exr"), in.ldi, in.header);
    PictureRequest request;
    request.lens = {.focal_length_mm = 640, .sensor_width_mm = 64, .lens_radius = 0.06, .focus_distance = 5};
    std::vector<Image> pictures;
    for (const char *name : {"ldi_0.exr", "ldi_%s.exr"}) {
        LdiCache cache;
        request.input = folder.file(name);
        pictures.push_back(take_moments(cache, false, request, {silent, nobody}).image);
    }
    EXPECT_EQ(pictures[0].values, pictures[1].values);
}

// The moments of a scene that stands still look through all lens points of a still, each through its share. So do those
// that a row of a rolling shutter sees, if its exposure is a whole number of moments long.
TEST(TakeMoments, OfAStillSceneAreTheStill) {
    const OpenedLdi in = opened(random_surfaces(windows_of_size(64, 48), lens, false, 3));
    const Image still = taken({in}).image;
    for (const auto &[count, duration] :
         {std::pair{2u, 1.0}, {4u, 1.0}, {8u, 1.0}, {4u, 0.5}, {4u, 0.25}, {8u, 0.25}}) {
        PictureRequest request;
        request.rolling_shutter = duration;
        const Image moments = taken(std::vector<OpenedLdi>(count, in), request).image;
        double sum = 0;
        for (std::size_t i = 0; i < still.values.size(); ++i)
            sum += std::pow(double(still.values[i] - moments.values[i]), 2);
        EXPECT_LT(std::sqrt(sum / double(still.values.size())), 2e-3) << count << ' ' << duration;
    }
}

TEST(TakeMoments, HaveTheDepthTheFocusAndTheIdsOfTheMiddleMoment) {
    std::vector<OpenedLdi> moments;
    for (const double z : {3.0, 4.0, 5.0, 6.0})
        moments.push_back(
            opened(make_ldi(windows_of_size(24, 20), {{"A"}, {"id.X", PixelType::uint32}}, [=](int, int) {
                return std::vector<Sample>{{z, {1, float(z)}}};
            })));
    PictureRequest request;
    request.focus_pixel = Imath::V2i(4, 4);
    request.front_depth = true;
    std::vector<Notice> told;
    const TakenPicture picture = taken(moments, request, &told);
    EXPECT_EQ(picture.camera.focus_distance, 5);
    EXPECT_EQ(picture.depth.at(0, 3, 3), 5);
    EXPECT_EQ(picture.image.at(1, 3, 3), 5);
    EXPECT_EQ(picture.moments, 4u);
    EXPECT_EQ(picture.samples_read, 4u * 24 * 20);
    EXPECT_EQ(std::ranges::count(told, NoticeKind::focused, &Notice::kind), 1);
}

// Only the middle moment shows something at the pixel to focus on.
TEST(TakeMoments, FollowLampsWithTheFocusOfTheMiddleMoment) {
    std::vector<OpenedLdi> moments;
    for (int m = 0; m < 2; ++m)
        moments.push_back(opened(make_ldi(windows_of_size(40, 20), rgba_channels(), [=](int x, int y) {
            std::vector<Sample> samples;
            if (x == 10 + 8 * m && y == 10) samples.push_back({depth_of(lens, -3), {lamp_light, 0, 0, 1}});
            if (x > 0 || m == 1) samples.push_back({lens.focus, {0.01f, 0.01f, 0.01f, 1}});
            return samples;
        })));
    PictureRequest request;
    request.focus_pixel = Imath::V2i(0, 0);
    EXPECT_EQ(taken(moments, request).image.values, taken(moments).image.values);
}

TEST(TakeMoments, OfDifferentSizesAreTheirUnion) {
    std::vector<OpenedLdi> moments;
    for (const int x : {0, 20}) {
        Windows windows = windows_of_size(40, 10);
        windows.data = {{x, 0}, {x + 19, 9}};
        moments.push_back(opened(make_ldi(windows, rgba_channels(), [](int, int) {
            return std::vector<Sample>{{lens.focus, {1, 1, 1, 1}}};
        })));
    }
    const Image picture = taken(moments).image;
    EXPECT_EQ(picture.windows.data, Imath::Box2i({0, 0}, {39, 9}));
    EXPECT_EQ(picture.at(3, 5, 5), 0.5f);
    EXPECT_EQ(picture.at(3, 35, 5), 0.5f);
}

OpenedLdi plane(int width, const char *name) {
    return opened(make_ldi(windows_of_size(width, 10), rgba_channels(),
                           [](int, int) {
                               return std::vector<Sample>{{5, {1, 1, 1, 1}}};
                           }),
                  name);
}

TEST(TakeMoments, OfDifferentShotsAreRefused) {
    const auto refused = [](OpenedLdi other, const PictureRequest &request = {}) {
        return what_of<Error>([&] { taken({std::move(other), plane(20, "b.exr")}, request); });
    };
    const std::string end = " than b.exr; the moments of a shutter are of one shot";
    EXPECT_EQ(refused(plane(24, "a.exr")), "a.exr: its size of 24x10 is another" + end);
    OpenedLdi other = plane(20, "a.exr");
    other.ldi.windows.pixel_aspect = 2;
    EXPECT_EQ(refused(other), "a.exr: its pixel aspect of 2 is another" + end);
    other = plane(20, "a.exr");
    other.camera.focal_length_mm = 2 * lens.focal_px;
    EXPECT_EQ(refused(other), "a.exr: its focal length of 1280 pixels is another" + end);
    other = plane(20, "a.exr");
    other.camera.lens_radius = 0.03;
    EXPECT_EQ(refused(other), "a.exr: its lens radius of 0.03 is another" + end);
    other.camera.lens_radius = 0.05; // a lens that closes
    EXPECT_NO_THROW(taken({other, plane(20, "b.exr")}));
    other.ldi.channels.back().name = "Z2";
    EXPECT_EQ(refused(other), "a.exr: it has other channels" + end);
    other = plane(20, "a.exr");
    other.header.insert("sparselens:moment", Imf::IntAttribute(0));
    other.header.insert("sparselens:moments", Imf::IntAttribute(3));
    EXPECT_EQ(refused(other), "a.exr: is one of 3 moments, and there are 2");
    other.header.insert("sparselens:moment", Imf::IntAttribute(1));
    other.header.insert("sparselens:moments", Imf::IntAttribute(2));
    EXPECT_EQ(refused(other), "a.exr: is moment 1 of its shutter, and the files have it as moment 0");
}

TEST(TakeMoments, NeedToBeSeveralForACurveOrARollingShutter) {
    PictureRequest curve, rolling;
    curve.shutter_curve = "triangle";
    rolling.rolling_shutter = 0.5;
    const auto refused = [](const PictureRequest &request) {
        return what_of<UsageError>([&] { taken({plane(20, "a.exr")}, request); });
    };
    EXPECT_EQ(refused(curve),
              "`shutter_curve`: needs the moments of a shutter, each an LDI (docs/motion.md)");
    EXPECT_EQ(refused(rolling),
              "`rolling_shutter`: needs the moments of a shutter, each an LDI (docs/motion.md)");
}

// A warning that all moments give is given once.
TEST(TakeMoments, WarnOnce) {
    std::vector<OpenedLdi> moments{plane(20, "a_0.exr"), plane(20, "a_1.exr"), plane(20, "a_2.exr")};
    for (OpenedLdi &moment : moments) moment.camera.lens_points = {{0, 0}, {0.01, 0}};
    std::vector<Notice> told;
    taken(moments, {}, &told);
    EXPECT_EQ(std::ranges::count(told, NoticeKind::wide_lens, &Notice::kind), 1);
}

TEST(MomentFiles, AreFoundByTheirNumbers) {
    ScratchFolder folder;
    const auto make = [&](const char *name) { write_text_file(folder.file(name), ""); };
    const std::string pattern = folder.file("shot.0001_%s.exr");
    EXPECT_TRUE(names_moments(pattern));
    EXPECT_THROW(moments_on_disk(pattern), Error);
    for (const char *name : {"shot.0001_0.exr", "shot.0001_1.exr", "shot.0001_x.exr", "shot.0002_2.exr"})
        make(name);
    EXPECT_EQ(moments_on_disk(pattern), (std::vector<std::string>{"0", "1"}));
    for (int m = 2; m < 11; ++m) make(("shot.0001_" + std::to_string(m) + ".exr").c_str());
    EXPECT_EQ(moments_on_disk(pattern).size(), 11u);
    EXPECT_EQ(moments_on_disk(pattern).back(), "10"); // by number, not by spelling
    make("shot.0001_12.exr");
    EXPECT_EQ(what_of<Error>([&] { moments_on_disk(pattern); }),
              pattern +
                  ": the moments must be numbered without a gap, and there are 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, "
                  "10, 12");
    EXPECT_EQ(at_moment("m%s/shot_%s.exr", "03"), "m03/shot_03.exr");
    make("a_%s.exr");
    EXPECT_FALSE(names_moments(folder.file("a_%s.exr")));
}

} // namespace
} // namespace sparselens
