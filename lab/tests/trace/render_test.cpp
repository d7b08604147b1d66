#include "lab/tests/trace/small_scenes.h"
#include "lab/trace/planes.h"
#include "lab/trace/render.h"
#include "lens/lens_points.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

namespace sparselens::lab {
namespace {

constexpr std::size_t red = 0, alpha = 3, depth = 4;

Progress silent;

// Sum and centroid (pixel centres at half integers) of a channel.
struct Blob {
    double energy = 0, variance = 0; // variance: of the distance from the centroid
    Imath::V2d centroid{0, 0};
};

Blob measure(const Image &image, std::size_t channel) {
    Blob blob;
    const Imath::Box2i &data = image.windows.data;
    const auto sum = [&](const auto &value) {
        for (int y = data.min.y; y <= data.max.y; ++y)
            for (int x = data.min.x; x <= data.max.x; ++x)
                value(double(image.at(channel, x, y)), Imath::V2d(x + 0.5, y + 0.5));
    };
    sum([&](double v, const Imath::V2d &p) { blob.energy += v, blob.centroid += v * p; });
    blob.centroid /= blob.energy;
    sum([&](double v, const Imath::V2d &p) {
        blob.variance += v * (p - blob.centroid).length2() / blob.energy;
    });
    return blob;
}

// One square lamp of `pixels` pixels around centre position p of a picture.
Scene lamp_at(const RenderSettings &settings, const Imath::V2d &p, double z, double pixels) {
    const Imath::V2d centre(settings.windows.display_width() * 0.5, settings.windows.display_height() * 0.5);
    const double unit = z / settings.lens.focal_px, half = pixels / 2;
    Scene scene;
    scene.quads = {facing_quad((p.x - centre.x - half) * unit, (centre.y - p.y - half) * unit,
                               (p.x - centre.x + half) * unit, (centre.y - p.y + half) * unit, z,
                               white_light)};
    return scene;
}

// Section 1 of the design: p = q + (R F / z) (u_x, -u_y).
TEST(RenderView, RimViewsSeeThePointWhereTheDesignSays) {
    const RenderSettings settings = settings_of_size(96, 64, 0.2);
    const Imath::V2d p(50, 30);
    const double z = 2;
    const Tracer tracer(lamp_at(settings, p, z, 3));
    for (const Imath::V2d &u : {Imath::V2d(0, 0), Imath::V2d(1, 0), Imath::V2d(-1, 0), Imath::V2d(0, 1),
                                Imath::V2d(0, -1), Imath::V2d(0.6, -0.8)}) {
        const Blob blob = measure(render_view(tracer, settings, u, 256, 1, silent), red);
        const double shift = settings.lens.radius * settings.lens.focal_px / z; // 9.6 px
        EXPECT_NEAR(blob.centroid.x, p.x - shift * u.x, 0.03) << u;
        EXPECT_NEAR(blob.centroid.y, p.y + shift * u.y, 0.03) << u;
        EXPECT_NEAR(blob.energy, 9, 0.3) << u;
    }
}

// x = p + c (u_x, -u_y): a point of depth z at centre position p is on the lens ray of u through x.
TEST(RenderReference, LensRaysMeetPointsWhereTheDesignSays) {
    RenderSettings settings = settings_of_size(640, 360);
    for (const double aspect : {1.0, 2.0})
        for (const double focus : {5.0, std::numeric_limits<double>::infinity()})
            for (const double z : {1.7, 5.0, 40.0}) {
                settings.lens.focus = focus;
                settings.lens.pixel_aspect = aspect;
                const Imath::V2d p(123.4, 56.7), u(0.3, -0.7);
                const Imath::V2d x = seen_through(settings.lens, p, circle_of_confusion(settings.lens, z), u);
                const Ray through_centre = lens_ray(settings, {0, 0}, p), ray = lens_ray(settings, u, x);
                const Imath::V3d point = z * through_centre.direction, met = ray.origin + z * ray.direction;
                EXPECT_LT((point - met).length(), 1e-12) << focus << ' ' << z;
            }
}

TEST(RenderView, PlanesAreTheirClosedForm) {
    const RenderSettings settings = settings_of_size(160, 90);
    const Tracer tracer(build_scene("planes"));
    const Image image = render_view(tracer, settings, {0, 0}, 1, 1, silent);
    std::size_t seen[4] = {};
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 160; ++x) {
            const Imath::V2d slope((x + 0.5 - 80) / 160, (45 - y - 0.5) / 160);
            const auto planes = facing_planes();
            std::size_t i = 0;
            while (!planes[i].slopes.intersects(slope)) ++i;
            ++seen[i];
            EXPECT_EQ(image.at(depth, x, y), float(planes[i].z));
            EXPECT_EQ(image.at(alpha, x, y), 1);
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(image.at(c, x, y), radiance(planes[i].radiance[c], slope), 1e-6);
        }
    for (const std::size_t count : seen) EXPECT_GT(count, 1000u);
}

// A plane wave keeps its phase and mean; its amplitude falls by sinc (the pixel) times 2 J1(r) / r (the lens).
TEST(RenderReference, DefocusedPlaneWaveIsItsClosedForm) {
    const double focal = 160;
    for (const FacingPlane &plane : facing_planes()) {
        RenderSettings settings = settings_of_size(160, 90);
        Scene scene;
        for (const Quad &quad : build_scene("planes").quads)
            if (quad.corners[0].z == plane.z) scene.quads = {quad};
        const Imath::V2d middle = 0.5 * (plane.slopes.min + plane.slopes.max);
        const int x0 = int(80 + focal * std::clamp(middle.x, -0.4, 0.4)), y0 = 60;
        settings.windows.data = {{x0, y0}, {x0 + 7, y0 + 1}};
        const Image image = render_reference(Tracer(scene), settings, 4096, silent);
        const double c = circle_of_confusion(settings.lens, plane.z);
        for (int y = y0; y <= y0 + 1; ++y)
            for (int x = x0; x <= x0 + 7; ++x)
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    PlaneWave wave = plane.radiance[channel];
                    const auto sinc = [](double v) { return v == 0 ? 1 : std::sin(v) / v; };
                    const double r = wave.frequency.length() * std::abs(c) / focal;
                    wave.amplitude *= sinc(wave.frequency.x / focal / 2) *
                                      sinc(wave.frequency.y / focal / 2) *
                                      (r == 0 ? 1 : 2 * std::cyl_bessel_j(1, r) / r);
                    const Imath::V2d slope((x + 0.5 - 80) / focal, (45 - y - 0.5) / focal);
                    EXPECT_NEAR(image.at(channel, x, y), radiance(wave, slope), 1e-3) << plane.z;
                }
    }
}

// Radiance times projected area, spread evenly over the disc: its variance is c^2 / 2, plus s^2 / 6 for the square and
// 1 / 6 for the pixel.
TEST(RenderReference, LampKeepsItsEnergyAndFillsItsDisc) {
    const RenderSettings settings = settings_of_size(64, 64, 0.2);
    for (const double z : {2.5, 20.0}) {
        const double side = 4, c = circle_of_confusion(settings.lens, z);
        const Image image =
            render_reference(Tracer(lamp_at(settings, {33, 30}, z, side)), settings, 256, silent);
        const Blob blob = measure(image, red);
        EXPECT_NEAR(blob.energy / (side * side), 1, 0.01) << z;
        EXPECT_NEAR(blob.centroid.x, 33, 0.05);
        EXPECT_NEAR(blob.centroid.y, 30, 0.05);
        EXPECT_NEAR(blob.variance, c * c / 2 + side * side / 6 + 1.0 / 6, 0.3) << z;
    }
}

TEST(RenderReference, WithoutLensItIsTheCentreView) {
    const RenderSettings settings = settings_of_size(96, 54, 0);
    const Tracer tracer(build_scene("fence"));
    const Image view = render_view(tracer, settings, {0, 0}, 1024, 1, silent);
    const Image reference = render_reference(tracer, settings, 1024, silent);
    double difference = 0;
    for (std::size_t i = 0; i < 2 * view.windows.pixels(); ++i) // red and green, lamps compressed
        difference += std::abs(std::min(view.values[i], 1.f) - std::min(reference.values[i], 1.f));
    EXPECT_LT(difference / (2.0 * double(view.windows.pixels())), 3e-3);
}

TEST(RenderView, WithoutLensAllViewsAreTheCentre) {
    RenderSettings settings = settings_of_size(48, 27, 0);
    const Tracer tracer(build_scene("fence"));
    EXPECT_EQ(render_view(tracer, settings, {0, 0}, 4, 1, silent).values,
              render_view(tracer, settings, {-0.8, 0.6}, 4, 2, silent).values);
}

TEST(RenderView, SkyIsOpaqueAtInfinity) {
    const RenderSettings settings = settings_of_size(64, 36);
    const Image image = render_view(Tracer(build_scene("slant")), settings, {0, 0}, 4, 1, silent);
    EXPECT_EQ(image.at(depth, 10, 0), std::numeric_limits<float>::infinity());
    EXPECT_FLOAT_EQ(image.at(red, 10, 0), 0.3f);
    EXPECT_EQ(image.at(alpha, 10, 0), 1);
}

TEST(RenderView, OverscanAddsPixelsAndChangesNone) {
    const Tracer tracer(build_scene("grass"));
    const RenderSettings settings = settings_of_size(64, 36);
    RenderSettings wide = settings;
    wide.windows.data = {{-5, -5}, {68, 40}};
    for (const int samples : {4, 5}) { // regular and not
        const Image a = render_view(tracer, settings, {1, 0}, samples, 1, silent);
        const Image b = render_view(tracer, wide, {1, 0}, samples, 1, silent);
        for (std::size_t channel = 0; channel < 5; ++channel)
            for (int y = 0; y < 36; ++y)
                for (int x = 0; x < 64; ++x) EXPECT_EQ(a.at(channel, x, y), b.at(channel, x, y));
    }
    EXPECT_EQ(render_reference(tracer, settings, 4, silent).at(red, 20, 20),
              render_reference(tracer, wide, 4, silent).at(red, 20, 20));
}

TEST(RenderView, NoiseOfViewsIsIndependent) {
    RenderSettings settings = settings_of_size(48, 27);
    settings.light = Light::area;
    const Tracer tracer(build_scene("fence"));
    EXPECT_NE(render_view(tracer, settings, {0, 0}, 4, 1, silent).values,
              render_view(tracer, settings, {0, 0}, 4, 2, silent).values);
}

TEST(Render, NoiseOfSeedsIsIndependent) {
    RenderSettings settings = settings_of_size(48, 27);
    settings.light = Light::area;
    RenderSettings other = settings;
    other.seed = 63;
    const Tracer tracer(build_scene("fence"));
    EXPECT_NE(render_view(tracer, settings, {0, 0}, 4, 1, silent).values,
              render_view(tracer, other, {0, 0}, 4, 1, silent).values);
    // Unlike streams of one seed, the mean of two seeds has half the variance of one.
    const Image reference = render_reference(tracer, settings, 4096, silent);
    const auto squares = [&](const Image &a, const Image &b) {
        double sum = 0;
        for (std::size_t i = 0; i < reference.values.size(); ++i) {
            const double error = (a.values[i] + b.values[i]) / 2 - reference.values[i];
            sum += error * error;
        }
        return sum;
    };
    const Image a = render_reference(tracer, settings, 8, silent),
                b = render_reference(tracer, other, 8, silent);
    EXPECT_NEAR(squares(a, b) / squares(b, b), 0.5, 0.15);
}

// One sample per pixel and view: on a grid all samples are at pixel centres, and edges stay jagged with any number of
// views.
TEST(RenderView, ScatteredSamplesAreAntialiasedByTheirAverage) {
    RenderSettings settings = settings_of_size(48, 27);
    settings.lens.radius = 0;
    const Tracer tracer(build_scene("fence"));
    const Image reference = render_view(tracer, settings, {0, 0}, 1024, 1, silent);
    const auto error_of_average = [&](bool scattered) {
        settings.scattered = scattered;
        std::vector<double> sum(reference.plane(0).size());
        constexpr int views = 64;
        for (int k = 0; k < views; ++k) {
            const Image view = render_view(tracer, settings, {0, 0}, 1, std::uint32_t(k), silent);
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += view.values[i] / views;
        }
        double squares = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) squares += std::pow(sum[i] - reference.values[i], 2);
        return squares;
    };
    EXPECT_LT(error_of_average(true), 0.1 * error_of_average(false));
}

TEST(Render, ThreadsDoNotMatter) {
    RenderSettings settings = settings_of_size(70, 41);
    settings.light = Light::area;
    for (const char *name : {"grass", "mist"}) {
        const Tracer tracer(build_scene(name));
        const auto both = [&] {
            return std::pair(render_view(tracer, settings, {0, 1}, 3, 1, silent).values,
                             render_reference(tracer, settings, 5, silent).values);
        };
        const auto many = both();
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(many, both());
    }
}

TEST(Render, OnePixelIsEnough) {
    const RenderSettings settings = settings_of_size(1, 1);
    const Tracer tracer(build_scene("fence"));
    EXPECT_GT(render_view(tracer, settings, {0, 0}, 1, 1, silent).at(depth, 0, 0), 0);
    EXPECT_EQ(render_reference(tracer, settings, 1, silent).at(alpha, 0, 0), 1);
}

} // namespace
} // namespace sparselens::lab
