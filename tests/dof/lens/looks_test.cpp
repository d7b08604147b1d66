// Properties of the lens picture that hold for every look.
#include "deep/flatten.h"
#include "dof/lens/lens_gather.h"
#include "lens/cat_eye.h"
#include "lens/psf.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5}; // CoC up to 7.7 px behind focus

Image gather(const Ldi &ldi, const LensLooks &looks, const ThinLens &by = lens) {
    Progress silent;
    return lens_gather(ldi, by, ldi.windows.data, {.looks = looks}, silent);
}

// A picture with a bright corner and different colours.
std::shared_ptr<const AperturePicture> picture() {
    auto made = std::make_shared<AperturePicture>(AperturePicture{7, 5, {}});
    for (int i = 0; i < 35; ++i)
        made->rgb.insert(made->rgb.end(), {1 + float(i % 7), 3, i < 7 ? 9.0f : 1.0f});
    return made;
}

std::vector<LensLooks> all_looks() {
    return {{.aperture = {.blades = 6, .rotation = 15}},
            {.aperture = {.blades = 3, .curvature = 0.3}},
            {.aperture = {.squeeze = 2}},
            {.aperture = {.blades = 5, .squeeze = 0.5}},
            {.aperture = {.spherical = 0.9}},
            {.aperture = {.blades = 7, .spherical = -0.9}},
            {.aperture = {.spherical = {-0.7, 0, 0.7}}},
            {.aperture = {.picture = picture()}},
            {.aperture = {.squeeze = 1.5, .spherical = 0.5, .picture = picture()}},
            {.cat_eye = 1.2},
            {.aperture = {.blades = 6, .squeeze = 1.3, .spherical = 0.5}, .cat_eye = 0.7},
            {.aperture = {.picture = picture()}, .cat_eye = 0.8},
            {.chromatic_coc = {-2, 0, 2}},
            {.field_curvature = 0.3},
            {.tilt = {0.5, -0.3}},
            {.astigmatism = 0.6},
            {.magnification = 1.03}};
}

TEST(LensLooks, ConstantStaysConstantAndOpaque) {
    // Planes of one colour: behind focus, in front, and strips before another plane, half of them half covered. Samples
    // of partial coverage are so far out of focus that nothing is sharpened.
    const std::array<float, 4> colour{0.4f, 0.7f, 0.2f, 1};
    const auto strips = [&](int x, int y) {
        std::vector<Sample> samples{{depth_of(lens, 6), {0.4f, 0.7f, 0.2f, 1}}};
        const float cover = y < 24 ? 1.0f : 0.5f;
        if (x / 6 % 2 == 0)
            samples.insert(samples.begin(),
                           {depth_of(lens, -12), {0.4f * cover, 0.7f * cover, 0.2f * cover, cover}});
        return samples;
    };
    const Ldi ldi = make_ldi(windows_of_size(48, 48), rgba_channels(), strips);
    for (const LensLooks &looks : all_looks()) {
        const Image image = gather(ldi, looks);
        for (std::size_t k = 0; k < 4; ++k)
            for (const float v : image.plane(k)) ASSERT_NEAR(v, colour[k], 1e-4);
    }
}

TEST(LensLooks, ChangeThePicture) {
    const Ldi ldi = random_surfaces(windows_of_size(64, 48), lens, false, 1);
    const Image round = gather(ldi, {});
    for (const LensLooks &looks : all_looks()) EXPECT_GT(largest_difference(gather(ldi, looks), round), 0.01);
    EXPECT_EQ(largest_difference(gather(ldi, {.aperture = {.blades = 4, .curvature = 1}}), round), 0);
}

TEST(LensLooks, GiveTheSameBitsOnAnyNumberOfThreads) {
    const Ldi ldi = random_surfaces(windows_of_size(140, 16), lens, false, 2); // three tiles
    std::vector<LensLooks> all = all_looks();
    all.push_back({.aperture = {.spherical = 0.5}, .cat_eye = 1, .cat_eye_darkening = true});
    for (const LensLooks &looks : all) {
        const Image many = gather(ldi, looks);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(gather(ldi, looks).values, many.values);
    }
}

// The factor on 1/d, by hand: (1 + K rho^2) (1 + tan X x/F + tan Y y/F), with x right and y up of the axis and rho in
// half diagonals.
struct BentFocus {
    double curvature, tan_x, tan_y;
    double factor(double x, double y, double half_diagonal) const {
        const double rho = std::sqrt(x * x + y * y) / half_diagonal;
        return (1 + curvature * rho * rho) * (1 + (tan_x * x + tan_y * y) / lens.focal_px);
    }
    LensLooks looks() const { return {.field_curvature = curvature, .tilt = {tan_x, tan_y}}; }
};

// A surface at the focus of the bent lens is sharp everywhere. With only a tilt it is a plane in space, z + x tan X + y
// tan Y = d. Pixels are square, and twice as wide as high; the data window is a part of the display window.
TEST(LensLooks, FocusOnTheSurfaceThatTheirAnglesSay) {
    for (const float aspect : {1.0f, 2.0f})
        for (const BentFocus &bent : {BentFocus{0.4, 0, 0}, BentFocus{0, 2, -1}, BentFocus{0, 0, 6}}) {
            Windows windows = windows_of_size(96, 60);
            windows.data = {{3, 5}, {95, 50}};
            windows.pixel_aspect = aspect;
            ThinLens by = lens;
            by.pixel_aspect = double(aspect);
            const double half_diagonal = std::hypot(48, 30 / double(aspect));
            const Ldi ldi = make_ldi(windows, rgba_channels(), [&](int px, int py) {
                const float v = (px / 3 + py / 3) % 2 ? 1.0f : 0.1f;
                const double x = px + 0.5 - 48, y = (30 - (py + 0.5)) / double(aspect);
                return std::vector<Sample>{{lens.focus / bent.factor(x, y, half_diagonal), {v, v, v, 1}}};
            });
            EXPECT_LT(largest_difference(gather(ldi, bent.looks(), by), flatten(ldi)), 0.02);
            EXPECT_GT(largest_difference(gather(ldi, {}, by), flatten(ldi)), 0.1);
        }
}

// A lamp of CoC 7 has the disc given by the bent plane of focus at its position: c = R F (1/d' - 1/z), R F / d = 7.68.
TEST(LensLooks, SpreadALampByTheFocusAtItsPlace) {
    const double half_diagonal = std::hypot(64, 32), rf_by_d = 0.06 * 640 / 5;
    for (const BentFocus &bent : {BentFocus{0, 3, 0}, BentFocus{0, 0, 6}, BentFocus{0.5, 0, 0}})
        for (const Imath::V2i &at : {Imath::V2i(24, 32), {104, 32}, {64, 14}, {64, 49}}) {
            const Ldi ldi = make_ldi(windows_of_size(128, 64), rgba_channels(), [&](int x, int y) {
                std::vector<Sample> samples;
                if (Imath::V2i(x, y) == at) samples.push_back({depth_of(lens, 7), {1000, 1000, 1000, 1}});
                return samples;
            });
            const double coc =
                7 + rf_by_d * (bent.factor(at.x + 0.5 - 64, 32 - (at.y + 0.5), half_diagonal) - 1);
            const Image image = gather(ldi, bent.looks());
            double reached = 0;
            for (const float v : image.plane(0))
                reached += v > 0.5f * float(1000 / (std::numbers::pi * coc * coc));
            EXPECT_NEAR(reached, std::numbers::pi * coc * coc, 0.05 * std::numbers::pi * coc * coc)
                << coc << " at " << at;
        }
}

// At a position q half diagonals from the axis a lamp becomes an ellipse: R F / d A |q|^2 pixels longer than the disc
// along the line to the axis, and shorter by as much across it. The mean square of an ellipse along its axes is a
// quarter of theirs.
TEST(LensLooks, SkewALampAlongTheLineToTheAxis) {
    const double half_diagonal = std::hypot(64, 32), rf_by_d = 0.06 * 640 / 5;
    for (const double coc : {7.0, -7.0, 2.5})
        for (const Imath::V2i &at : {Imath::V2i(104, 32), {24, 32}, {64, 14}, {90, 10}, {40, 50}}) {
            const Ldi ldi = make_ldi(windows_of_size(128, 64), rgba_channels(), [&](int x, int y) {
                std::vector<Sample> samples;
                if (Imath::V2i(x, y) == at) samples.push_back({depth_of(lens, coc), {1000, 1000, 1000, 1}});
                return samples;
            });
            const Image image = gather(ldi, {.astigmatism = 0.8});
            const Imath::V2d lamp(at.x + 0.5, at.y + 0.5), q = (lamp - Imath::V2d(64, 32)) / half_diagonal,
                                                           along = q.normalized(), across(-along.y, along.x);
            const double s = rf_by_d * 0.8 * q.dot(q);
            double sum = 0, squares_along = 0, squares_across = 0;
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 128; ++x) {
                    const Imath::V2d from = Imath::V2d(x + 0.5, y + 0.5) - lamp;
                    const double v = double(image.at(0, x, y));
                    sum += v;
                    squares_along += v * from.dot(along) * from.dot(along);
                    squares_across += v * from.dot(across) * from.dot(across);
                }
            const double in_pixel =
                0.35; // square pixels: the mean square of pixels, and of what comes from one
            EXPECT_NEAR(sum, 1000, 5);
            EXPECT_NEAR(squares_along / sum, (coc + s) * (coc + s) / 4, in_pixel) << coc << " at " << at;
            EXPECT_NEAR(squares_across / sum, (coc - s) * (coc - s) / 4, in_pixel) << coc << " at " << at;
        }
}

// To the right of the axis, in the middle of a quarter of a tile, the sagittal focus resolves changes from row to row,
// and the tangential focus those from column to column. Two pixels away the CoC is 0.3 pixels, which reduces an edge of
// 0.9 by less than 0.1.
TEST(LensLooks, FocusLinesAlongAndAcross) {
    const double s = 0.06 * 640 / 5 * 48 * 48 / (80 * 80); // half a diagonal is 80 pixels
    for (const bool rows : {true, false})
        for (const double coc : {s, -s}) {
            const Ldi ldi = make_ldi(windows_of_size(128, 96), rgba_channels(), [&](int x, int y) {
                const float v = (rows ? y : x) / 3 % 2 ? 1.0f : 0.1f;
                return std::vector<Sample>{{depth_of(lens, coc), {v, v, v, 1}}};
            });
            const Image image = gather(ldi, {.astigmatism = 1}), sharp = flatten(ldi);
            double off = 0;
            for (int y = 46; y < 50; ++y)
                for (int x = 110; x < 114; ++x)
                    off = std::max(off, std::abs(double(image.at(0, x, y)) - double(sharp.at(0, x, y))));
            if (rows == (coc > 0))
                EXPECT_LT(off, 0.1) << rows << coc;
            else
                EXPECT_GT(off, 0.2) << rows << coc;
        }
}

TEST(LensLooks, MagnifyAboutTheAxis) {
    const Windows windows = windows_of_size(101, 61);
    const Ldi ldi = make_ldi(windows, rgba_channels(), [&](int x, int y) {
        const float v = x == 80 && y == 50 ? 1000.0f : 0.01f;
        return std::vector<Sample>{{depth_of(lens, 4), {v, v, v, 1}}};
    });
    const Image image = gather(ldi, {.magnification = 1.2, .axis = {-10, 4}});
    double sum = 0, x = 0, y = 0;
    for (std::size_t i = 0; i < image.plane(0).size(); ++i) {
        const double v = std::max(0.0, double(image.plane(0)[i]) - 0.011);
        const Imath::V2i p = windows.pixel(i);
        sum += v, x += v * (p.x + 0.5), y += v * (p.y + 0.5);
    }
    EXPECT_NEAR(x / sum, 40.5 + 1.2 * (80.5 - 40.5), 0.05);
    EXPECT_NEAR(y / sum, 34.5 + 1.2 * (50.5 - 34.5), 0.05);
    EXPECT_NEAR(sum, 1000, 5); // the lamp's light is kept, its disc is wider
}

// One lamp in an empty picture of 64 x 64 pixels.
Image gather_lamp(double coc, const LensLooks &looks) {
    const Ldi ldi = make_ldi(windows_of_size(64, 64), rgba_channels(), [&](int x, int y) {
        std::vector<Sample> samples;
        if (x == 32 && y == 32) samples.push_back({depth_of(lens, coc), {1000, 1000, 1000, 1}});
        return samples;
    });
    return gather(ldi, looks);
}

TEST(LensLooks, SqueezeADiscToTheAreaOfTheEllipseInEachPixel) {
    const Image image = gather_lamp(7, {.aperture = {.squeeze = 1.6}});
    const double a = 7 / 1.6, b = 7, area = std::numbers::pi * a * b;
    constexpr int n = 200; // points a side of a pixel
    for (int y = 20; y < 45; ++y)
        for (int x = 20; x < 45; ++x) {
            int inside = 0;
            for (int i = 0; i < n * n; ++i) {
                const double u = (x - 32.5 + (i % n + 0.5) / n) / a, v = (y - 32.5 + (i / n + 0.5) / n) / b;
                inside += u * u + v * v <= 1;
            }
            ASSERT_NEAR(image.at(0, x, y) / 1000 * area, inside / double(n * n), 1e-3) << x << "," << y;
        }
}

TEST(LensLooks, MirrorATriangleInFrontOfFocus) {
    const LensLooks looks{.aperture = {.blades = 3, .rotation = 90}};
    const Image behind = gather_lamp(7, looks), in_front = gather_lamp(-7, looks);
    for (int y = 1; y < 64; ++y)
        for (int x = 1; x < 64; ++x)
            ASSERT_NEAR(behind.at(0, x, y), in_front.at(0, 64 - x, 64 - y), 1e-3) << x << "," << y; // of 1000
    EXPECT_GT(behind.at(0, 28, 30), 1.0f); // a flat side is on top behind focus, a corner in front
    EXPECT_EQ(in_front.at(0, 28, 30), 0.0f);
}

// One lamp's colours are discs of different CoC.
TEST(LensLooks, FocusColoursAtDifferentDepths) {
    const Image image = gather_lamp(7, {.chromatic_coc = {-2, 0, 3}});
    for (std::size_t k = 0; k < 3; ++k) {
        const double coc = std::array{5.0, 7.0, 10.0}[k];
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                ASSERT_NEAR(image.at(k, x, y), 1000 * psf_weight({{32.5, 32.5}, coc}, x, y), 0.05) << k;
    }
}

// The common area of two circles of radius 1 and r whose middles are d apart.
double common_area(double r, double d) {
    const double x = (d * d + 1 - r * r) / (2 * d), y = std::sqrt(1 - x * x);
    return std::acos(x) + r * r * std::acos((d - x) / r) - d * y;
}

// The light of a lamp `away` half diagonals from the axis with a CoC of `coc` half diagonals, for a cat-eye of 1: each
// pixel's light is weighted by the part of the lens that remains there.
double light_past_cat_eye(double away, double coc) {
    constexpr int n = 400;
    double light = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Imath::V2d u((i + 0.5) * 2 / n - 1, (j + 0.5) * 2 / n - 1),
                at = Imath::V2d(away, 0) + coc * u;
            if (u.length() > 1 || (u - at).length() > 1) continue;
            light += 4.0 / (n * n) / common_area(1, at.length());
        }
    return light;
}

// At the corner the second circle is displaced by the cat-eye's amount; on the axis the disc is whole.
TEST(LensLooks, CutCatEyes) {
    const Windows windows = windows_of_size(160, 120); // half a diagonal is 100 pixels
    const auto lit = [&](const Imath::V2i &pixel, const LensLooks &looks, double &sum) {
        const ThinLens wide{.radius = 1.2, .focal_px = 640, .focus = 5};
        const Ldi ldi = make_ldi(windows, rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples;
            if (Imath::V2i(x, y) == pixel) samples.push_back({depth_of(wide, 12), {1000, 1000, 1000, 1}});
            return samples;
        });
        const Image image = gather(ldi, looks, wide);
        double area = 0;
        sum = 0;
        for (const float v : image.plane(0)) area += v > 1.1f, sum += double(v);
        return area;
    };
    const double disc = std::numbers::pi * 144;
    double sum = 0;
    EXPECT_NEAR(lit({80, 60}, {.cat_eye = 1}, sum), disc, 0.05 * disc);
    // 60 pixels from the axis the second circle is 0.6 away for the lamp's middle, and 12/100 more at the outer rim of
    // its disc: |a - 0.6 - 0.12 a| <= 1 is a circle of radius 1 / 0.88 around 0.6 / 0.88.
    const double left = common_area(1 / 0.88, 0.6 / 0.88);
    EXPECT_NEAR(lit({140, 60}, {.cat_eye = 1}, sum), 144 * left, 0.05 * disc);
    EXPECT_NEAR(sum, 1000 * light_past_cat_eye(0.6, 0.12), 10);
    lit({140, 60}, {.cat_eye = 1, .cat_eye_darkening = true}, sum);
    EXPECT_NEAR(sum, 1000 * left / std::numbers::pi, 10);
}

// A plane keeps the share of its light that the rest of the lens passes: behind focus, in front, and in focus, where
// nothing is blurred.
TEST(LensLooks, DarkenWhatACatEyeCuts) {
    for (const double coc : {6.0, -6.0, 0.0}) {
        const Ldi ldi = make_ldi(windows_of_size(160, 120), rgba_channels(), [&](int, int) {
            return std::vector<Sample>{{depth_of(lens, coc), {0.5, 0.5, 0.5, 1}}};
        });
        const LensLooks looks{.cat_eye = 1, .cat_eye_darkening = true};
        const Image image = gather(ldi, looks);
        const Aperture aperture;
        const CatEye cat_eye(aperture, looks, picture_frame(ldi.windows, looks));
        for (const Imath::V2i &p :
             {Imath::V2i(80, 60), Imath::V2i(120, 60), Imath::V2i(20, 20), Imath::V2i(150, 110)}) {
            const double left = cat_eye.share(CatEye::Light::evenly, {p.x + 0.5, p.y + 0.5});
            EXPECT_NEAR(image.at(0, p.x, p.y), 0.5 * left, 5e-4) << p;
            EXPECT_NEAR(image.at(3, p.x, p.y), 1, 1e-4);
        }
        EXPECT_LT(image.at(0, 150, 110), 0.3f);
    }
}

TEST(LensLooks, LeaveAPinholeItsLight) {
    const Ldi ldi = random_surfaces(windows_of_size(64, 48), lens, false, 1);
    const ThinLens pinhole{.radius = 0, .focal_px = 640, .focus = 5};
    const Image dark = gather(ldi, {.cat_eye = 1, .cat_eye_darkening = true, .magnification = 1.1}, pinhole);
    EXPECT_EQ(dark.values, gather(ldi, {.magnification = 1.1}, pinhole).values);
}

// Data has no colour and no rim: it is gathered as if through an even lens of one colour.
TEST(LensLooks, LeaveDataAlone) {
    std::vector<Channel> channels = rgba_channels();
    channels.push_back({"velocity"});
    channels.push_back({"normal.R"}); // only its letter means red
    find_kinds(channels);
    const auto sample = [](int x, int y) {
        const float v = float(random_unit(x, y, 3));
        return std::vector<Sample>{{depth_of(lens, x < 32 ? 5 : -4), {v, v, v, 1, v, v}}};
    };
    const Ldi ldi = make_ldi(windows_of_size(64, 64), channels, sample);
    const Image round = gather(ldi, {}), ringed = gather(ldi, {.aperture = {.spherical = 1}});
    const Image split = gather(ldi, {.chromatic_coc = {-2, 0, 3}});
    for (const std::size_t k : {4u, 5u})
        for (std::size_t i = 0; i < round.plane(k).size(); ++i) {
            ASSERT_NEAR(ringed.plane(k)[i], round.plane(k)[i], 1e-6) << k;
            ASSERT_NEAR(split.plane(k)[i], split.plane(4)[i], 1e-6) << k;
        }
    EXPECT_GT(std::abs(ringed.plane(0)[64 * 32 + 32] - round.plane(0)[64 * 32 + 32]), 1e-4);
}

} // namespace
} // namespace sparselens
