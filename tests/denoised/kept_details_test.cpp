// Denoised views regain details that all views show, and small lamps, but not noise or fireflies.
#include "denoised/denoised_views.h"
#include "finish/synthetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

const Grid grid = windows_of_size(61, 45).grid();
constexpr double focal_px = 60, radius = 0.1;
const Imath::V2d places[] = {{0, 0}, {radius, 0}, {0, radius}, {-radius, 0}, {0, -radius}};

// A plane at one depth before five cameras, or before the first one; the test sets noisy and denoised pictures.
class Views {
public:
    explicit Views(float depth, std::size_t count = 5) : z_(grid.size(), depth) {
        Windows windows = windows_of_size(grid.width(), grid.height());
        for (std::size_t v = 0; v < count; ++v)
            views.push_back({grid, z_, ViewMapping(places[v], focal_px, windows), {}, {}});
    }

    // The denoised picture with the details kept from the noisy one.
    Colours taken(std::size_t at) const {
        std::vector<AveragedLayer> means;
        for (const DenoisedLayer &view : views) means.push_back(averaged(view, focal_px * radius));
        const Values kept = kept_details(views, means, at, focal_px * radius);
        Colours result = views[at].denoised;
        for (std::size_t c = 0; c < result.size(); ++c)
            for (std::size_t i = 0; i < grid.size(); ++i)
                result[c][i] += kept[i] * (views[at].noisy[c][i] - result[c][i]);
        return result;
    }

    std::vector<DenoisedLayer> views;

private:
    std::vector<float> z_;
};

constexpr float far_away = std::numeric_limits<float>::infinity(); // all views show the same

Colours constant(float value) { return Colours(3, Values(grid.size(), value)); }

double squared_error(const Colours &picture, const Colours &truth) {
    double sum = 0;
    for (std::size_t c = 0; c < truth.size(); ++c)
        for (std::size_t i = 0; i < grid.size(); ++i)
            sum += std::pow(double(picture[c][i]) - double(truth[c][i]), 2);
    return sum;
}

TEST(KeptDetails, AreAllOfThemWhereNothingIsNoise) {
    const Colours truth = synthetic_truth(grid.array());
    Views all(far_away);
    for (DenoisedLayer &view : all.views) view.noisy = truth, view.denoised = blurred(truth, grid.array(), 2);
    EXPECT_LT(squared_error(all.taken(0), truth), 1e-4 * squared_error(all.views[0].denoised, truth));
}

TEST(KeptDetails, AreNoNoise) {
    const Colours truth = constant(0.5f);
    Views all(far_away);
    for (std::uint32_t v = 0; v < 5; ++v)
        all.views[v].noisy = rays_of(truth, 1, v + 1), all.views[v].denoised = truth;
    EXPECT_LT(squared_error(all.taken(0), truth), 0.05 * squared_error(all.views[0].noisy, truth));
}

TEST(KeptDetails, AreNearerToTheTruthThanEither) {
    const Colours truth = synthetic_truth(grid.array());
    Views all(far_away);
    for (std::uint32_t v = 0; v < 5; ++v)
        all.views[v].noisy = rays_of(truth, 16, v + 1),
        all.views[v].denoised = blurred(truth, grid.array(), 2);
    const double error = squared_error(all.taken(0), truth);
    EXPECT_LT(error, squared_error(all.views[0].noisy, truth));
    EXPECT_LT(error, 0.5 * squared_error(all.views[0].denoised, truth));
}

// The other cameras see it elsewhere: whole pixels away, or between two pixels.
TEST(KeptDetails, ALampOfLessThanAPixelStays) {
    for (const float parallax : {3.0f, 2.5f}) {
        Views all(float(focal_px * radius) / parallax);
        for (std::uint32_t v = 0; v < 5; ++v) {
            all.views[v].denoised = constant(0.5f);
            all.views[v].noisy = rays_of(constant(0.5f), 4, v + 1);
            const Imath::V2d at =
                all.views[v].mapping.in_view({30.5, 20.5}, double(parallax) / (focal_px * radius));
            const int x = int(std::floor(at.x - 0.25)), y = int(std::floor(at.y - 0.25));
            for (Values &channel : all.views[v].noisy) { // half in each of two pixels if it lies between them
                const bool between = parallax == 2.5f && v > 0;
                channel[grid.index(Imath::V2i(x, y))] += between ? 50.0f : 100.0f;
                if (between) channel[grid.index(Imath::V2i(x + (v % 2 == 1), y + (v % 2 == 0)))] += 50.0f;
            }
        }
        const float kept = all.taken(0)[1][grid.index(Imath::V2i(30, 20))];
        EXPECT_NEAR(kept, all.views[0].noisy[1][grid.index(Imath::V2i(30, 20))],
                    parallax == 3.0f ? 1.0f : 15.0f)
            << parallax;
    }
}

// Denoisers take lamps of a few pixels for more or for less light, as chance will have it.
TEST(KeptDetails, ALampThatEachDenoisedViewShowsDifferentlyStays) {
    Views all(far_away);
    const float factors[] = {1.5f, 0.8f, 0.7f, 0.9f, 0.8f};
    for (std::uint32_t v = 0; v < 5; ++v) {
        all.views[v].noisy = rays_of(constant(0.5f), 4, v + 1), all.views[v].denoised = constant(0.5f);
        for (std::size_t c = 0; c < 3; ++c)
            for (const std::size_t i : {grid.index(Imath::V2i(30, 20)), grid.index(Imath::V2i(31, 20)),
                                        grid.index(Imath::V2i(30, 21)), grid.index(Imath::V2i(31, 21))})
                all.views[v].noisy[c][i] = 100, all.views[v].denoised[c][i] = factors[v] * 100;
    }
    EXPECT_NEAR(all.taken(0)[0][grid.index(Imath::V2i(30, 20))], 100, 10); // the denoised view has 150
}

// A denoiser makes a wall without noise a little brighter. Each view has the lamp before another part of the wall.
TEST(KeptDetails, ALampHidesNothingOfTheWallAroundIt) {
    Views all(far_away);
    std::vector<std::vector<float>> depths(5, std::vector<float>(grid.size(), far_away));
    constexpr double parallax = 5;
    const auto shows_lamp = [&](std::size_t v, int x, int y) {
        const Imath::V2d at = all.views[v].mapping.in_view({30.5, 20.5}, parallax / (focal_px * radius));
        return std::abs(x + 0.5 - at.x) < 2 && std::abs(y + 0.5 - at.y) < 2;
    };
    for (std::size_t v = 0; v < 5; ++v) {
        all.views[v].noisy = constant(0.02f), all.views[v].denoised = constant(0.0204f);
        for (int y = 0; y < grid.height(); ++y)
            for (int x = 0; x < grid.width(); ++x) {
                if (!shows_lamp(v, x, y)) continue;
                const std::size_t i = grid.index(Imath::V2i(x, y));
                depths[v][i] = float(focal_px * radius / parallax);
                for (Values &channel : all.views[v].noisy) channel[i] = 1000;
                for (Values &channel : all.views[v].denoised) channel[i] = 900;
            }
        all.views[v].z = depths[v];
    }
    const Colours taken = all.taken(0);
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x)
            EXPECT_NEAR(taken[1][grid.index(Imath::V2i(x, y))], shows_lamp(0, x, y) ? 1000 : 0.02f,
                        shows_lamp(0, x, y) ? 1 : 2e-5f)
                << x << ' ' << y;
}

TEST(KeptDetails, AFireflyOfOneViewGoes) {
    Views all(far_away);
    for (std::uint32_t v = 0; v < 5; ++v)
        all.views[v].denoised = constant(0.5f), all.views[v].noisy = rays_of(constant(0.5f), 4, v + 1);
    all.views[0].noisy[0][grid.index(Imath::V2i(30, 20))] = 100;
    EXPECT_LT(all.taken(0)[0][grid.index(Imath::V2i(30, 20))], 10);
    EXPECT_LT(all.taken(1)[0][grid.index(Imath::V2i(30, 20))], 1);
}

TEST(KeptDetails, OneViewAloneKeepsItsLamps) {
    Views one(2, 1);
    one.views[0].denoised = constant(0.5f), one.views[0].noisy = rays_of(constant(0.5f), 4, 1);
    one.views[0].noisy[0][grid.index(Imath::V2i(30, 20))] = 100;
    EXPECT_NEAR(one.taken(0)[0][grid.index(Imath::V2i(30, 20))], 100, 5);
    one.views[0].noisy[0][grid.index(Imath::V2i(30, 20))] = 0.5f;
    EXPECT_LT(squared_error(one.taken(0), constant(0.5f)),
              0.05 * squared_error(one.views[0].noisy, constant(0.5f)));
}

TEST(KeptDetails, WhatShowsNothingKeepsNothing) {
    Views all(0);
    for (DenoisedLayer &view : all.views) view.noisy = constant(1), view.denoised = constant(0.5f);
    const Colours taken = all.taken(0);
    for (const float v : taken[0]) ASSERT_TRUE(std::isfinite(v));
}

} // namespace
} // namespace sparselens
