#include "deep/sanitize.h"
#include "deep/tidy.h"
#include "io/exr/exr_common.h"
#include "lab/stress/scenes.h"

#include <half.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace sparselens::lab {

namespace {

using namespace stress;

constexpr double rounding = 1e-5; // of sums over lens points, in float (docs/tolerances.md, section 4)
constexpr double coc = 6;
constexpr int width = 72, height = 40, lamp_x = 36, lamp_y = 20;

// A plane of `dark` with one pixel of `lamp`, all at CoC 6, R, G, B and A.
Ldi lamp_ldi(float dark, float lamp, float alpha = 1) {
    const ThinLens lens = plain_lens();
    return colour_ldi(window(width, height), [=](int x, int y) {
        const bool lit = x == lamp_x && y == lamp_y;
        return Pixel{{depth_of(lens, coc), lit ? lamp : dark, lit ? alpha : 1}};
    });
}

// Beyond the reach of the lamp's disc the dark stays as it was, however bright the lamp: no sum mixes them.
StressResult beside_lamp(float dark, float lamp) {
    StressResult result;
    const Image image = gather(lamp_ldi(dark, lamp), plain_lens(), result, 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double distance = std::hypot(x - lamp_x, y - lamp_y), value = double(image.at(0, x, y));
            if (!std::isfinite(value)) result.error = INFINITY;
            if (distance > coc + 2)
                result.error = std::max(result.error, std::abs(value - double(dark)) / double(dark));
        }
    result.energy = sum_of(image, 0) / (double(lamp) + double(dark) * (width * height - 1)) - 1;
    return result;
}
StressResult dark_beside_65504() { return beside_lamp(1e-8f, 65504); }
StressResult dark_beside_1e30() { return beside_lamp(1e-8f, 1e30f); }

// The same without R, G, B: through lens points.
StressResult points_beside_1e30() {
    const ThinLens lens = plain_lens();
    return against_reference(
        grey_ldi(window(40, 28),
                 [&](int x, int y) {
                     return Pixel{{depth_of(lens, 4), x == 20 && y == 14 ? 1e30f : 1e-8f}};
                 }),
        lens);
}

// Partly covered glass of radiance 1e30 before a dark plane.
StressResult bright_glass() {
    const ThinLens lens = plain_lens();
    return against_reference(
        grey_ldi(window(40, 28),
                 [&](int x, int y) {
                     Pixel pixel{{depth_of(lens, 4), 1e-8f}};
                     if (x < 20)
                         pixel.insert(pixel.begin(), {depth_of(lens, -3), 1e30f * texture(x, y), 0.25f});
                     return pixel;
                 }),
        lens);
}

StressResult largest_light() { return constant_plane(plain_lens(), 9, 1e34); }
StressResult smallest_light() { return constant_plane(plain_lens(), 9, 1e-30); }

// Values stored as half: finite, and counted if they do not fit.
StressResult half_overflow() {
    constexpr std::array<float, 6> values{65504, 65519, 65520, 1e30f, -1e30f, 3e38f};
    std::array<Imath::half, values.size()> stored;
    const std::size_t clamped =
        store(PixelType::half, values.data(), values.size(), reinterpret_cast<char *>(stored.data()));
    double error = clamped == 4 ? 0 : 1;
    for (const Imath::half h : stored) error = std::max(error, std::abs(std::abs(double(float(h))) - 65504));
    return {.error = error, .energy = NAN, .seconds = 0, .pixels = 1};
}

StressResult negative_plane() {
    const ThinLens lens = plain_lens();
    return constant_plane(lens, depth_of(lens, coc), -0.5);
}
StressResult negative_texture() {
    const ThinLens lens = plain_lens();
    return against_reference(grey_ldi(window(40, 28),
                                      [&](int x, int y) {
                                          return Pixel{{depth_of(lens, 4), texture(x, y) - 0.5f}};
                                      }),
                             lens);
}
StressResult negative_lamp() {
    StressResult result;
    const Image image = gather(lamp_ldi(0, -100), plain_lens(), result, 0);
    result.energy = sum_of(image, 0) / -100 - 1;
    result.error = std::abs(result.energy);
    return result;
}

// A bad pixel in a plane of one colour: after filling it has that colour, and the picture equals the one without it.
StressResult bad_colour(float bad) {
    StressResult result;
    Ldi ldi = lamp_ldi(0.5f, bad);
    const InvalidValues found = sanitize(ldi, "stress");
    const Image image = gather(ldi, plain_lens(), result, 0);
    result.error = found.colours == 3 ? off_from(image, 0, image.windows.data, 0.5) : INFINITY;
    result.energy = sum_of(image, 0) / (0.5 * width * height) - 1;
    return result;
}
StressResult colour_nan() { return bad_colour(std::nanf("")); }
StressResult colour_inf() { return bad_colour(INFINITY); }
StressResult colour_1e38() { return bad_colour(1e38f); }
StressResult colour_minus_inf() { return bad_colour(-INFINITY); }

StressResult bad_alpha(float bad, float good) {
    StressResult result;
    Ldi ldi = lamp_ldi(0.5f, 0.5f, bad);
    const InvalidValues found = sanitize(ldi, "stress");
    Ldi expected = lamp_ldi(0.5f, 0.5f, good);
    sanitize(expected, "stress"); // an A of 0 has no depth
    result.error = found.alphas == 1 && ldi.values[3] == expected.values[3] ? 0 : 1;
    result.error =
        std::max(result.error, off_from(gather(ldi, plain_lens(), result, 0),
                                        gather(expected, plain_lens(), result, 0), ldi.windows.data));
    return result;
}
StressResult alpha_above() { return bad_alpha(1.5f, 1); }
StressResult alpha_below() { return bad_alpha(-0.5f, 0); }
StressResult alpha_nan() { return bad_alpha(std::nanf(""), 1); }

// An almost opaque surface before another colour, of which 1e-7 shines through.
StressResult nearly_opaque() {
    StressResult result;
    const ThinLens lens = plain_lens();
    const Ldi ldi = grey_ldi(window(64, 48), [&](int, int) {
        return Pixel{{depth_of(lens, -4), 0.25f, 1 - 1e-7f}, {depth_of(lens, 4), 1}};
    });
    const Image image = gather(ldi, lens, result);
    const Imath::Box2i box = inner(ldi.windows, 8);
    result.error = std::max(off_from(image, 0, box, 0.25), off_from(image, 1, box, 1));
    return result;
}

StressResult nothing_at_all() {
    StressResult result;
    const Ldi ldi = tidy(grey_ldi(window(64, 48), [](int, int) { return Pixel{{3, 0, 0}, {9, 0, 0}}; }));
    const Image image = gather(ldi, plain_lens(), result);
    result.error = std::max(off_from(image, 0, ldi.windows.data, 0), off_from(image, 1, ldi.windows.data, 0));
    return result;
}

// Light without coverage, as from a flame: it adds to the things behind it, also out of focus.
StressResult light_alone() {
    StressResult result;
    const ThinLens lens = plain_lens();
    const Ldi ldi = grey_ldi(window(64, 48), [&](int, int) {
        return Pixel{{depth_of(lens, -5), 0.5f, 0}, {depth_of(lens, 5), 0.25f}};
    });
    const Image image = gather(ldi, lens, result);
    const Imath::Box2i box = inner(ldi.windows, 8);
    result.error = std::max(off_from(image, 0, box, 0.75), off_from(image, 1, box, 1));
    return result;
}

constexpr const char *float_sums = "a few hundred lens points summed in float, each rounded at 6e-8";
constexpr const char *reorders =
    "the kernel only reorders the reference's sums: docs/tolerances.md, section 4";
constexpr const char *same_input = "after the repair the input is the same, bit for bit";

constexpr std::array cases{
    StressCase{"1e-8_beside_65504", "radiance 1e-8 beyond the disc of a lamp of 65504", rounding, float_sums,
               dark_beside_65504},
    StressCase{"1e-8_beside_1e30", "radiance 1e-8 beyond the disc of a lamp of 1e30", rounding, float_sums,
               dark_beside_1e30},
    StressCase{"points_1e30", "a pixel of 1e30 amid 1e-8 through the lens points, against the reference",
               rounding, reorders, points_beside_1e30},
    StressCase{"glass_1e30", "glass of radiance 1e30 before 1e-8, against the reference", rounding, reorders,
               bright_glass},
    StressCase{"plane_1e34", "a plane of radiance 1e34, the largest there is, stays", rounding, float_sums,
               largest_light},
    StressCase{"plane_1e-30", "a plane of radiance 1e-30 stays", rounding, float_sums, smallest_light},
    StressCase{"half_overflow", "what half cannot hold is stored as 65504 and counted", 0, "no arithmetic",
               half_overflow},
    StressCase{"negative_plane", "a plane of radiance -0.5 stays", rounding, float_sums, negative_plane},
    StressCase{"negative_texture", "a texture around 0, against the reference", rounding, reorders,
               negative_texture},
    StressCase{"negative_lamp", "a pixel of -100 keeps its light", energy_bound,
               "docs/tolerances.md, section 3: a PSF sums to 1", negative_lamp},
    StressCase{"nan_pixel", "a pixel of NaN in a plane is not seen, and is counted", rounding, float_sums,
               colour_nan},
    StressCase{"inf_pixel", "a pixel of infinity in a plane is not seen, and is counted", rounding,
               float_sums, colour_inf},
    StressCase{"1e38_pixel", "a pixel of 1e38, of which sums would overflow, is not seen, and is counted",
               rounding, float_sums, colour_1e38},
    StressCase{"minus_inf_pixel", "a pixel of -infinity in a plane is not seen, and is counted", rounding,
               float_sums, colour_minus_inf},
    StressCase{"alpha_1.5", "A = 1.5 in a pixel is 1, and is counted", 0, same_input, alpha_above},
    StressCase{"alpha_-0.5", "A = -0.5 in a pixel is 0, and is counted", 0, same_input, alpha_below},
    StressCase{"alpha_nan", "A = NaN in a pixel is its neighbours', and is counted", 0, same_input,
               alpha_nan},
    StressCase{"alpha_1-1e-7", "A = 1 - 1e-7 hides what is behind", rounding, float_sums, nearly_opaque},
    StressCase{"fully_transparent", "samples without light and coverage show nothing", 0,
               "nothing is left to sum", nothing_at_all},
    StressCase{"light_without_coverage", "light of A = 0 adds to what is behind", rounding, float_sums,
               light_alone},
};

} // namespace

std::span<const StressCase> light_stress() { return cases; }

} // namespace sparselens::lab
