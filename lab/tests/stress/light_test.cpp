#include "deep/sanitize.h"
#include "deep/tidy.h"
#include "io/exr/exr_common.h"
#include "lab/tests/stress/stress.h"

#include <half.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens::stress {

namespace {

constexpr double coc = 6;
constexpr int width = 72, height = 40, lamp_x = 36, lamp_y = 20;

// A plane of `dark` with one pixel of `lamp`, all at CoC 6, R, G, B and A.
Ldi lamp_ldi(float dark, float lamp, float alpha = 1) {
    return colour_ldi(width, height, [=](int x, int y) {
        const bool lit = x == lamp_x && y == lamp_y;
        return Pixel{{depth_of(plain_lens, coc), lit ? lamp : dark, lit ? alpha : 1}};
    });
}

// Beyond the reach of the lamp's disc the dark stays as it was, however bright the lamp: no sum mixes them.
Result beside_lamp(float dark, float lamp) {
    const Image image = gather(lamp_ldi(dark, lamp), plain_lens, 0);
    Result result{.energy = sum_of(image, 0) / (double(lamp) + double(dark) * (width * height - 1)) - 1};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double value = double(image.at(0, x, y));
            EXPECT_TRUE(std::isfinite(value));
            if (std::hypot(x - lamp_x, y - lamp_y) > coc + 2)
                result.error = std::max(result.error, std::abs(value - double(dark)) / double(dark));
        }
    return result;
}

// The same without R, G, B: through lens points.
Result points_beside_lamp() {
    return against_reference(grey_ldi(40, 28, [](int x, int y) {
        return Pixel{{depth_of(plain_lens, 4), x == 20 && y == 14 ? 1e30f : 1e-8f}};
    }));
}

// Partly covered glass of radiance 1e30 before a dark plane.
Result bright_glass() {
    return against_reference(grey_ldi(40, 28, [](int x, int y) {
        const Spot plane{depth_of(plain_lens, 4), 1e-8f};
        return x < 20 ? Pixel{{depth_of(plain_lens, -3), 1e30f * texture(x, y), 0.25f}, plane} : Pixel{plane};
    }));
}

// Values stored as half: finite, and counted if they do not fit.
Result half_overflow() {
    constexpr std::array<float, 6> values{65504, 65519, 65520, 1e30f, -1e30f, 3e38f};
    std::array<Imath::half, values.size()> stored;
    EXPECT_EQ(store(PixelType::half, values.data(), values.size(), reinterpret_cast<char *>(stored.data())),
              4u);
    Result result;
    for (const Imath::half h : stored)
        result.error = std::max(result.error, std::abs(std::abs(double(float(h))) - 65504));
    return result;
}

Result negative_texture() {
    return against_reference(grey_ldi(40, 28, [](int x, int y) {
        return Pixel{{depth_of(plain_lens, 4), texture(x, y) - 0.5f}};
    }));
}
Result negative_lamp() {
    const double energy = sum_of(gather(lamp_ldi(0, -100), plain_lens, 0), 0) / -100 - 1;
    return {std::abs(energy), energy};
}

// A bad pixel in a plane of one colour: after filling it has that colour, and the picture equals the one without it.
Result bad_colour(float bad) {
    Ldi ldi = lamp_ldi(0.5f, bad);
    EXPECT_EQ(sanitize(ldi, "stress").colours, 3u);
    return against_plane(gather(ldi, plain_lens, 0), 0.5);
}

Result bad_alpha(float bad, float good) {
    Ldi ldi = lamp_ldi(0.5f, 0.5f, bad), expected = lamp_ldi(0.5f, 0.5f, good);
    EXPECT_EQ(sanitize(ldi, "stress").alphas, 1u);
    sanitize(expected, "stress"); // an A of 0 has no depth
    EXPECT_EQ(ldi.values[3], expected.values[3]);
    return {off_from(gather(ldi, plain_lens, 0), gather(expected, plain_lens, 0))};
}

// These samples in every pixel.
Ldi everywhere(const Pixel &samples) {
    return grey_ldi(64, 48, [&](int, int) { return samples; });
}
// An almost opaque surface before another colour, of which 1e-7 shines through.
Result nearly_opaque() {
    const Ldi ldi = everywhere({{depth_of(plain_lens, -4), 0.25f, 1 - 1e-7f}, {depth_of(plain_lens, 4)}});
    return {off_plane(gather(ldi, plain_lens), 0.25, 1, 8)};
}
Result fully_transparent() {
    return {off_plane(gather(tidy(everywhere({{3, 0, 0}, {9, 0, 0}})), plain_lens), 0, 0)};
}
// Light without coverage, as from a flame: it adds to the things behind it, also out of focus.
Result light_alone() {
    const Ldi ldi = everywhere({{depth_of(plain_lens, -5), 0.5f, 0}, {depth_of(plain_lens, 5), 0.25f}});
    return {off_plane(gather(ldi, plain_lens), 0.75, 1, 8)};
}

constexpr Limit sums{rounding, "a few hundred lens points summed in float, each rounded at 6e-8"};
constexpr Limit psf{energy_bound, "docs/tolerances.md, section 3: a PSF sums to 1"};

constexpr Case cases[] = {
    {"1e-8_beside_65504", "radiance 1e-8 beyond the disc of a lamp of 65504", sums,
     [] { return beside_lamp(1e-8f, 65504); }},
    {"1e-8_beside_1e30", "radiance 1e-8 beyond the disc of a lamp of 1e30", sums,
     [] { return beside_lamp(1e-8f, 1e30f); }},
    {"points_1e30", "a pixel of 1e30 amid 1e-8 through the lens points, against the reference", reorders,
     points_beside_lamp},
    {"glass_1e30", "glass of radiance 1e30 before 1e-8, against the reference", reorders, bright_glass},
    {"plane_1e34", "a plane of radiance 1e34, the largest there is, stays", sums,
     [] { return constant_plane(plain_lens, 9, 1e34); }},
    {"plane_1e-30", "a plane of radiance 1e-30 stays", sums,
     [] { return constant_plane(plain_lens, 9, 1e-30); }},
    {"half_overflow",
     "what half cannot hold is stored as 65504 and counted",
     {0, "no arithmetic"},
     half_overflow},
    {"negative_plane", "a plane of radiance -0.5 stays", sums,
     [] { return constant_plane(plain_lens, depth_of(plain_lens, coc), -0.5); }},
    {"negative_texture", "a texture around 0, against the reference", reorders, negative_texture},
    {"negative_lamp", "a pixel of -100 keeps its light", psf, negative_lamp},
    {"nan_pixel", "a pixel of NaN in a plane is not seen, and is counted", sums,
     [] { return bad_colour(std::nanf("")); }},
    {"inf_pixel", "a pixel of infinity in a plane is not seen, and is counted", sums,
     [] { return bad_colour(INFINITY); }},
    {"1e38_pixel", "a pixel of 1e38, of which sums would overflow, is not seen, and is counted", sums,
     [] { return bad_colour(1e38f); }},
    {"minus_inf_pixel", "a pixel of -infinity in a plane is not seen, and is counted", sums,
     [] { return bad_colour(-INFINITY); }},
    {"alpha_1.5", "A = 1.5 in a pixel is 1, and is counted", same_input, [] { return bad_alpha(1.5f, 1); }},
    {"alpha_-0.5", "A = -0.5 in a pixel is 0, and is counted", same_input,
     [] { return bad_alpha(-0.5f, 0); }},
    {"alpha_nan", "A = NaN in a pixel is its neighbours', and is counted", same_input,
     [] { return bad_alpha(std::nanf(""), 1); }},
    {"alpha_1-1e-7", "A = 1 - 1e-7 hides what is behind", sums, nearly_opaque},
    {"fully_transparent",
     "samples without light and coverage show nothing",
     {0, "nothing is left to sum"},
     fully_transparent},
    {"light_without_coverage", "light of A = 0 adds to what is behind", sums, light_alone},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(light, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
