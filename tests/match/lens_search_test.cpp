#include "match/blocks.h"
#include "match/lens_search.h"
#include "match/patterns.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

// A plate with another tone curve and exposure.
Rgb graded(Rgb plate) {
    for (std::vector<float> &plane : plate.rgb)
        for (float &v : plane) v = 0.02f + 0.7f * std::pow(v, 0.8f);
    return plate;
}

LensFit found(const Comparison &pictures, const KnownLens &known) {
    LensFit best;
    best.likelihood = -1;
    for (const BlurGuess &guess : search_lens(pictures, known))
        if (LensFit fit = measured_lens(pictures, known, guess, 30, 1.5); fit.likelihood > best.likelihood)
            best = std::move(fit);
    return best;
}

TEST(LensSearch, finds_the_focus_and_the_lens_of_a_graded_plate) {
    for (const auto &[coc, scale] : {std::pair{0.0, 0.6}, {2.0, 0.8}, {-1.5, 0.4}}) {
        const Comparison pictures = test::slope_before(graded(test::blurred_waves(96, 48, coc, scale)));
        const LensFit fit = found(pictures, {});
        EXPECT_NEAR(fit.guess.coc, coc, 0.1);
        EXPECT_NEAR(fit.guess.scale, scale, 0.02);
    }
}

TEST(LensSearch, tells_softness_of_the_whole_from_the_lens) {
    const Rgb soft = softened(test::blurred_waves(96, 48, 1, 0.7), 0.8);
    const LensFit fit = found(test::slope_before(graded(soft)), {});
    EXPECT_NEAR(fit.guess.softness, 0.8, 0.15);
    EXPECT_NEAR(fit.guess.scale, 0.7, 0.03);
}

TEST(LensSearch, keeps_what_is_known) {
    const Comparison pictures = test::slope_before(graded(test::blurred_waves(96, 48, 1.4, 0.7)));
    const LensFit by_scale = found(pictures, {.scale = 0.7});
    EXPECT_EQ(by_scale.guess.scale, 0.7);
    EXPECT_NEAR(by_scale.guess.coc, 1.4, 0.1);
    const LensFit by_focus = found(pictures, {.focus = 9});
    EXPECT_NEAR(by_focus.guess.coc / by_focus.guess.scale, 2, 1e-9);
    EXPECT_NEAR(by_focus.guess.scale, 0.7, 0.02);
}

// The covariance comes from the spread between blocks, so noise widens it.
TEST(LensSearch, noise_widens_the_spread) {
    Rgb noisy = graded(test::blurred_waves(96, 48, 1, 0.7));
    const LensFit before = found(test::slope_before(noisy), {});
    std::uint32_t state = 1;
    for (std::vector<float> &plane : noisy.rgb)
        for (float &v : plane) {
            state = state * 1664525u + 1013904223u;
            v += 0.05f * (float(state >> 8) / float(1 << 24) - 0.5f);
        }
    const LensFit after = found(test::slope_before(noisy), {});
    EXPECT_GT(after.covariance.scale, 4 * before.covariance.scale);
    EXPECT_NEAR(after.guess.scale, 0.7, 4 * std::sqrt(after.covariance.scale) + 0.02);
}

// Each gathered picture has noise of its own, as those of lens points have.
Comparison noisy_slope_before(const Rgb &plate, float amount) {
    Comparison pictures = test::slope_before(plate);
    pictures.gather = [gather = pictures.gather, amount](double coc, double scale, bool exactly) {
        Rgb gathered = gather(coc, scale, exactly);
        auto state = std::uint32_t(std::llround(1e6 * std::abs(coc) + 1e8 * scale));
        for (std::vector<float> &plane : gathered.rgb)
            for (float &v : plane) {
                state = state * 1664525u + 1013904223u;
                v += amount * (float(state >> 8) / float(1 << 24) - 0.5f);
            }
        return gathered;
    };
    return pictures;
}

TEST(LensSearch, noise_of_gathered_pictures_does_not_stop_the_search) {
    const Comparison pictures = noisy_slope_before(graded(test::blurred_waves(96, 48, 1, 0.7)), 0.02f);
    const LensFit fit = refine_lens(pictures, {}, {3.5, 1.1, 0.3}, 40, 0.75);
    EXPECT_NEAR(fit.guess.coc, 1, 0.1);
    EXPECT_NEAR(fit.guess.scale, 0.7, 0.05); // the noise passes for softness
    EXPECT_GT(fit.likelihood, refine_lens(pictures, {}, {1, 0.7, 0.15}, 1, 0.75).likelihood);
}

TEST(LensSearch, ends_at_the_best_lens) {
    const Comparison pictures = test::slope_before(graded(test::blurred_waves(96, 48, 1, 0.7)));
    const LensFit fit = refine_lens(pictures, {}, {2, 0.5, 0.3}, 40, 0.75);
    EXPECT_NEAR(fit.guess.coc, 1, 0.03);
    EXPECT_NEAR(fit.guess.scale, 0.7, 0.01);
}

TEST(LensSearch, compares_no_more_lenses_than_it_may) {
    Comparison pictures = test::slope_before(graded(test::blurred_waves(96, 48, 1, 0.7)));
    int count = 0;
    pictures.gather = [&count, gather = pictures.gather](double coc, double scale, bool exactly) {
        ++count;
        return gather(coc, scale, exactly);
    };
    measured_lens(pictures, {}, {3, 0.4, 0.3}, 7, 0.75);
    EXPECT_EQ(count, 7);
}

// At a known focus beyond all depths, the CoC changes everywhere with the radius.
TEST(LensSearch, a_known_focus_makes_the_radius_more_certain) {
    const Comparison pictures = noisy_slope_before(graded(test::blurred_waves(96, 48, 4, 0.4)), 0.02f);
    const BlurGuess guess{4, 0.4, 0.15};
    const LensFit free = measured_lens(pictures, {}, guess, 8, 0.3),
                  known = measured_lens(pictures, {.focus = pictures.middle + 10}, guess, 8, 0.3);
    EXPECT_LT(known.covariance.scale, free.covariance.scale);
}

TEST(LensSearch, the_interval_is_as_wide_as_other_lenses_fit) {
    const Comparison pictures = noisy_slope_before(graded(test::blurred_waves(96, 48, 1, 0.7)), 0.02f);
    const LensFit narrow = measured_lens(pictures, {}, {1, 0.7, 0.15}, 8, 0.75),
                  wide = widened(pictures, {}, narrow);
    EXPECT_GT(wide.covariance.coc, 2 * narrow.covariance.coc);
    EXPECT_NEAR(wide.guess.coc, 1, 0.1);
    const KnownLens known{.focus = 9};
    const LensFit by_focus = measured_lens(pictures, known, {1.4, 0.7, 0.15}, 8, 0.75);
    EXPECT_EQ(widened(pictures, known, by_focus).covariance.scale, by_focus.covariance.scale);
}

TEST(LensSearch, goes_to_a_better_lens_beside) {
    const Comparison pictures = test::slope_before(graded(test::blurred_waves(96, 48, 1, 0.7)));
    const LensFit wrong = measured_lens(pictures, {}, {3.5, 1.1, 0.3}, 6, 0.75);
    EXPECT_GT(std::abs(wrong.guess.coc - 1), 0.5);
    EXPECT_NEAR(widened(pictures, {}, wrong).guess.coc, 1, 0.1);
}

TEST(LensSearch, axes_of_an_ellipse) {
    const auto [longer, shorter] = axes_of({5, 2 / 4.0, 2 / 16.0}, 4); // 5 2, 2 2: variances 6 and 1
    EXPECT_NEAR(longer.variance, 6, 1e-12);
    EXPECT_NEAR(shorter.variance, 1, 1e-12);
    EXPECT_NEAR(std::abs(longer.coc), 2 / std::sqrt(5.0), 1e-12);
    EXPECT_NEAR(longer.coc, 2 * longer.ends, 1e-12);
}

TEST(Evidence, a_picture_matches_itself_and_not_another) {
    const Rgb shown = test::waves(192, 96);
    const Rgb other = test::colours(192, 96, [](double x, double y, std::size_t k) {
        return 0.5 + 0.3 * std::sin(0.013 * x * y + double(k)) * std::cos(0.31 * x);
    });
    const auto usable = test::all_usable(shown.grid);
    EXPECT_EQ(find_evidence(brightness(shown), usable, shown).matched_share(), 1);
    const Evidence wrong = find_evidence(brightness(other), usable, shown);
    EXPECT_LT(wrong.matched_share(), 0.3);
    EXPECT_EQ(
        find_evidence({shown.grid, std::vector<float>(shown.grid.size(), 0.2f)}, usable, shown).textured, 0);
}

} // namespace
} // namespace sparselens
