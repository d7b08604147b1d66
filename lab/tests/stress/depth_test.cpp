#include "deep/flatten.h"
#include "deep/sanitize.h"
#include "lab/tests/stress/stress.h"

#include <cmath>
#include <limits>

namespace sparselens::stress {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Half covered surfaces at these depths, the same in every pixel, before a sky: displaced or not, they show their
// composite.
Result stack(const ThinLens &lens, const std::vector<double> &depths) {
    const Ldi ldi = grey_ldi(64, 48, [&](int, int) {
        Pixel pixel;
        for (const double z : depths) pixel.push_back({z, 0.25f, 0.5f});
        pixel.push_back({infinity});
        return pixel;
    });
    const double passed = std::pow(0.5, double(depths.size()));
    return {off_plane(gather(ldi, lens), 0.5 * (1 - passed) + passed, 1, 12)};
}

// The CoC at the float next to the focus, compared with long double, for a lens that makes it 60 pixels.
Result coc_beside_focus(float towards) {
    const ThinLens lens{.radius = 1e6, .focal_px = 640, .focus = 0.7f};
    const long double z = std::nextafter(0.7f, towards), d = 0.7f, rf = 640e6L;
    const long double exact = rf * (z - d) / (z * d);
    return {double(std::abs((circle_of_confusion(lens, double(z)) - exact) / exact))};
}

// A textured plane one ulp from focus is as sharp as in focus.
Result plane_beside_focus(float towards) {
    const double z = double(std::nextafter(5.0f, towards));
    const Ldi ldi = grey_ldi(64, 48, [&](int x, int y) { return Pixel{{z, texture(x, y)}}; });
    return {off_from(gather(ldi, plain_lens), flatten(ldi))};
}

// Blobs before a textured backdrop at z. Depths of samples that may overlap differ, because the order of samples at one
// depth is undefined.
Result backdrop(double z, double focus = plain_lens.focus) {
    ThinLens lens = plain_lens;
    lens.focus = focus;
    return against_reference(
        grey_ldi(40, 28,
                 [&](int x, int y) {
                     if ((x / 6 + y / 5) % 3 != 0) return Pixel{{z, texture(x, y)}};
                     return Pixel{{3.5 + 0.01 * texture(x, y + 50), texture(x, y), 1, texture(y, x) - 0.5f}};
                 }),
        lens);
}

// Focused at a millimetre: the whole scene is far behind the focus.
Result near_focus() {
    return against_reference(grey_ldi(40, 28,
                                      [](int x, int y) {
                                          return Pixel{{x < 20 ? 1e-3 : 5e-3, texture(x, y)}};
                                      }),
                             {.radius = 1e-5, .focal_px = 640, .focus = 1e-3});
}

// A 50 mm lens in metres, and a surface 20 mm in front of it: nearer than any real lens could focus, but still a plane.
Result inside_focal_length() {
    return against_reference(grey_ldi(40, 28,
                                      [](int x, int y) {
                                          return Pixel{{((x / 8 + y / 8) % 2 == 0 ? 0.02 : 0.03) *
                                                            (1 + 0.01 * double(texture(x, y + 50))),
                                                        texture(x, y), 1, 0.25f * texture(y, x)}};
                                      }),
                             {.radius = 0.00125, .focal_px = 640, .focus = 0.03});
}

// A textured plane out of focus; one pixel has other samples.
Ldi plane_with(const Pixel &odd) {
    return grey_ldi(64, 48, [&](int x, int y) {
        return x == 30 && y == 20 ? odd : Pixel{{depth_of(plain_lens, 3), texture(x, y)}};
    });
}

// A half covered surface at the smallest float depth: its light leaves the picture, and nothing else changes.
Result nearest_float() {
    const Spot plane{depth_of(plain_lens, 3), texture(30, 20)};
    const Ldi with = plane_with({{double(std::numeric_limits<float>::min()), 0.5f, 0.5f}, plane});
    return {off_from(gather(with, plain_lens), gather(plane_with({plane}), plain_lens))};
}

// One pixel's depth is bad, and repaired; the rest of the plane must not change.
Result bad_depth(double bad, std::size_t counted) {
    const auto plane = [](double z) { return plane_with({{z, texture(30, 20)}}); };
    Ldi ldi = plane(bad);
    EXPECT_EQ(sanitize(ldi, "stress").depths, counted);
    const Ldi expected = plane(counted == 0 ? infinity : depth_of(plain_lens, 3));
    return {off_from(gather(ldi, plain_lens), gather(expected, plain_lens))};
}

constexpr Limit sums{
    rounding,
    "64 lens points summed in float: 64 roundings of 6e-8, and what the flattened tile lacks of them"};
constexpr Limit three{1e-12, "(z - d) is exact in double; three more operations round at 1.1e-16"};
constexpr Limit copied{0, "no CoC reaches half a pixel: tiles are copied"};
constexpr Limit beyond{rounding, "its disc is 1e39 pixels wide: of its light nothing falls into the picture"};

constexpr Case cases[] = {
    {"near_far_1e9", "depths 1 and 1e9 in every pixel show their composite", sums,
     [] {
         return stack({.radius = 0.0125, .focal_px = 640, .focus = 1.5}, {1, 1e9});
     }},
    {"ulps_apart", "three depths one ulp from each other show their composite", sums,
     [] {
         const float second = std::nextafter(3.0f, 9.0f), third = std::nextafter(second, 9.0f);
         return stack(plain_lens, {3, double(second), double(third)});
     }},
    {"coc_ulp_before_focus", "c one float ulp before focus, against long double", three,
     [] { return coc_beside_focus(0); }},
    {"coc_ulp_behind_focus", "c one float ulp behind focus, against long double", three,
     [] { return coc_beside_focus(1); }},
    {"plane_ulp_before_focus", "a textured plane one ulp before focus is the flattened picture", copied,
     [] { return plane_beside_focus(0); }},
    {"plane_ulp_behind_focus", "a textured plane one ulp behind focus is the flattened picture", copied,
     [] { return plane_beside_focus(9); }},
    {"sky_inf", "texture at z = inf behind blobs, against the reference", reorders,
     [] { return backdrop(infinity); }},
    {"sky_1e10", "texture at z = 1e10 behind blobs, against the reference", reorders,
     [] { return backdrop(1e10); }},
    {"sky_1e30", "texture at z = 1e30 behind blobs, against the reference", reorders,
     [] { return backdrop(1e30); }},
    {"sky_65504", "texture at z = 65504, a half-float sky, against the reference", reorders,
     [] { return backdrop(65504); }},
    {"focus_inf", "focus at infinity, against the reference", reorders,
     [] { return backdrop(20, infinity); }},
    {"focus_inf_sky_inf", "focus and backdrop at infinity, against the reference", reorders,
     [] { return backdrop(infinity, infinity); }},
    {"focus_1e-3", "focus at 1e-3, against the reference", reorders, near_focus},
    {"inside_focal_length", "a surface nearer than the focal length, against the reference", reorders,
     inside_focal_length},
    {"nearest_float", "one half covered pixel at z = 1.2e-38 changes no other", beyond, nearest_float},
    {"z_zero", "one pixel of depth 0 is the sky", same_input, [] { return bad_depth(0, 0); }},
    {"z_denormal", "one pixel of depth 1e-40 is the sky", same_input,
     [] { return bad_depth(double(1e-40f), 0); }},
    {"z_negative", "one pixel of depth -2 takes its neighbours', and is counted", same_input,
     [] { return bad_depth(-2, 1); }},
    {"z_nan", "one pixel of depth NaN takes its neighbours', and is counted", same_input,
     [] { return bad_depth(std::nan(""), 1); }},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(depth, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
