// Mattes of a traced scene from five views, compared with those of 256 views over the lens.
#include "deep/cluster.h"
#include "dof/methods.h"
#include "lab/tests/support/traced.h"
#include "lens/lens_points.h"
#include "support/mattes.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace sparselens {
namespace {

using namespace lab;

constexpr int grid = 8; // rays per pixel of a view along one axis

// Adds the share of the rays that meet each object.
void count_objects(const Tracer &tracer, const std::vector<Ray> &rays, double weight,
                   std::map<int, double> &shares) {
    std::vector<Hit> hits(rays.size());
    tracer.nearest(rays, hits);
    for (const Hit &hit : hits)
        if (!hit.sky()) shares[hit.primitive] += weight / double(rays.size());
}

// The middle of part i of a pixel divided into parts x parts.
Imath::V2d in_pixel(const Imath::V2i &pixel, int i, int parts) {
    return {pixel.x + (i % parts + 0.5) / parts, pixel.y + (i / parts + 0.5) / parts};
}

View with_matte(View view, const SceneCamera &scene, const Imath::V2d &u) {
    Image image(view.image.windows, channels_with_matte(3));
    for (std::size_t k = 0; k < 4; ++k) std::ranges::copy(view.image.plane(k), image.plane(k).begin());
    const std::vector<Matte> mattes = find_mattes(image.channels);
    for (std::size_t i = 0; i < image.windows.pixels(); ++i) {
        std::vector<Ray> rays;
        for (int r = 0; r < grid * grid; ++r)
            rays.push_back(view_ray(scene.settings, u, in_pixel(image.windows.pixel(i), r, grid)));
        std::map<int, double> shares;
        count_objects(scene.tracer, rays, 1, shares);
        MatteSum sum(mattes);
        std::vector<float> one(image.channels.size());
        for (const auto &[object, share] : shares) {
            one[mattes[0].ranks[0].id] = hashed(std::uint32_t(object));
            one[mattes[0].ranks[0].coverage] = float(share);
            sum.add(1, [&](std::size_t k) { return one[k]; });
        }
        sum.take([&](std::size_t k, float value) { image.plane(k)[i] = value; });
    }
    view.image = std::move(image);
    return view;
}

std::map<int, double> seen_by_lens(const SceneCamera &scene, const Imath::V2i &pixel) {
    std::map<int, double> shares;
    const auto points = spiral_lens_points(256);
    for (const Imath::V2d &u : points) {
        std::vector<Ray> rays;
        for (const int r : {1, 7, 8, 14}) // four objects that do not overlap
            rays.push_back(lens_ray(scene.settings, u, in_pixel(pixel, r, 4)));
        count_objects(scene.tracer, rays, 1.0 / double(points.size()), shares);
    }
    return shares;
}

// Sums over all pixels for each object: its share of them, the picture's error, and the squares of both.
struct MatteError {
    double shares = 0, errors = 0, shares_squared = 0, errors_squared = 0;

    // Checks the amount: few rays of the five views hit an object as small as a lamp, so two standard errors of their
    // number are allowed, and a fifth for light that edges and other objects hide. Checks the position: a lamp with the
    // wall's depth is as far out of focus as the wall, so squares may be those of sixteen rays per pixel.
    bool is_there() const {
        const auto allowed = [this](int rays) { return 0.2 + 2 / std::sqrt(5 * rays * shares); };
        return std::abs(errors) <= allowed(grid * grid) * shares &&
               errors_squared <= allowed(16) * allowed(16) * shares_squared;
    }
};

// The largest sum of a pixel's coverages.
float most_covered(const Image &picture) {
    const std::vector<Matte> mattes = find_mattes(picture.channels);
    float most = 0;
    for (std::size_t i = 0; i < picture.windows.pixels(); ++i) {
        float sum = 0;
        for (const Matte::Rank &rank : mattes[0].ranks) sum += picture.plane(rank.coverage)[i];
        most = std::max(most, sum);
    }
    return most;
}

std::map<int, MatteError> errors_of_five_views(const SceneCamera &scene) {
    std::vector<View> views;
    const ThinLens &lens = scene.settings.lens;
    for (View &view : scene.five_views(16))
        views.push_back(with_matte(view, scene, view.position / lens.radius));
    Progress silent;
    const Ldi warped = warp(views, {.focal_px = lens.focal_px, .radius = lens.radius}, silent);
    const Ldi ldi = cluster(warped, {.scale = lens.radius * lens.focal_px, .tolerance = 0.25}, silent).ldi;
    const Image picture = gather_methods().front().gather(
        ldi, lens, scene.settings.windows.data, {.layers = 8, .lens = {.quality = Quality::final}}, silent);
    EXPECT_LE(most_covered(picture), 1.005f);
    std::map<int, MatteError> errors;
    for (std::size_t i = 0; i < picture.windows.pixels(); ++i)
        for (const auto &[object, share] : seen_by_lens(scene, picture.windows.pixel(i))) {
            const double error = coverage_in(picture, hashed(std::uint32_t(object)), i) - share;
            MatteError &of = errors[object];
            of.shares += share;
            of.errors += error;
            of.shares_squared += share * share;
            of.errors_squared += error * error;
        }
    return errors;
}

constexpr int width = 160, height = 90;

// 18 lamps of a quarter of a pixel each. Their corners are in the middle of a pixel, so five of them have the wall's
// depth in all views.
TEST(TracedMattes, SmallObjectsFarOutOfFocus) {
    const auto errors = errors_of_five_views(SceneCamera("lamps", width, height));
    EXPECT_EQ(errors.size(), 19u);
    for (const auto &[object, error] : errors) EXPECT_TRUE(error.is_there()) << "object " << object;
}

TEST(TracedMattes, SpheresAndLampsBehindAFence) {
    const auto errors = errors_of_five_views(SceneCamera("fence", width, height));
    EXPECT_GE(errors.size(), 35u);
    for (const auto &[object, error] : errors) EXPECT_TRUE(error.is_there()) << "object " << object;
}

} // namespace
} // namespace sparselens
