#include "deep/flatten.h"
#include "deep/sanitize.h"
#include "lab/stress/scenes.h"
#include "view/view.h"

#include <algorithm>
#include <array>

namespace sparselens::lab {

namespace {

using namespace stress;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr double rounding = 1e-5; // of sums over lens points, in float (docs/tolerances.md, section 4)

// Half covered surfaces at these depths, the same in every pixel, before a sky: displaced or not, they show their
// composite.
StressResult stack(const ThinLens &lens, std::span<const double> depths) {
    StressResult result;
    const Ldi ldi = grey_ldi(window(64, 48), [&](int, int) {
        Pixel pixel;
        for (const double z : depths) pixel.push_back({z, 0.25f, 0.5f});
        pixel.push_back({infinity, 1, 1});
        return pixel;
    });
    long double passed = 1, light = 0;
    for (std::size_t i = 0; i < depths.size(); ++i, passed /= 2) light += passed * 0.25L;
    const Image image = gather(ldi, lens, result);
    const Imath::Box2i box = inner(ldi.windows, 12);
    result.error = std::max(off_from(image, 0, box, double(light + passed)), off_from(image, 1, box, 1));
    return result;
}

StressResult near_and_far() {
    return stack({.radius = 0.0125, .focal_px = 640, .focus = 1.5}, std::array{1.0, 1e9});
}
StressResult ulps_apart() {
    const float z = 3;
    return stack(plain_lens(), std::array{double(z), double(std::nextafter(z, 9.0f)),
                                          double(std::nextafter(std::nextafter(z, 9.0f), 9.0f))});
}

// The CoC at the float next to the focus, compared with long double, for a lens that makes it 60 pixels.
StressResult coc_beside_focus(float towards) {
    const ThinLens lens{.radius = 1e6, .focal_px = 640, .focus = 0.7f};
    const long double z = std::nextafter(0.7f, towards), d = 0.7f, rf = 640e6L;
    const long double exact = rf * (z - d) / (z * d);
    return {.error = double(std::abs((circle_of_confusion(lens, double(z)) - exact) / exact)),
            .energy = NAN,
            .seconds = 0,
            .pixels = 1};
}
StressResult coc_before_focus() { return coc_beside_focus(0); }
StressResult coc_behind_focus() { return coc_beside_focus(1); }

// A textured plane one ulp from focus is as sharp as in focus.
StressResult plane_beside_focus(float towards) {
    StressResult result;
    const ThinLens lens = plain_lens();
    const Ldi ldi = grey_ldi(window(64, 48), [&](int x, int y) {
        return Pixel{{double(std::nextafter(5.0f, towards)), texture(x, y)}};
    });
    result.error = off_from(gather(ldi, lens, result), flatten(ldi), ldi.windows.data);
    return result;
}
StressResult plane_before_focus() { return plane_beside_focus(0); }
StressResult plane_behind_focus() { return plane_beside_focus(9); }

// Blobs before a textured backdrop at z. Depths of samples that may overlap differ, because the order of samples at one
// depth is undefined.
Ldi before_backdrop(double z) {
    return grey_ldi(window(40, 28), [&](int x, int y) {
        if ((x / 6 + y / 5) % 3 != 0) return Pixel{{z, texture(x, y)}};
        return Pixel{{3.5 + 0.01 * texture(x, y + 50), texture(x, y), 1, texture(y, x) - 0.5f}};
    });
}
StressResult sky_1e10() { return against_reference(before_backdrop(1e10), plain_lens()); }
StressResult sky_1e30() { return against_reference(before_backdrop(1e30), plain_lens()); }
StressResult sky_65504() { return against_reference(before_backdrop(65504), plain_lens()); }
StressResult sky_inf() { return against_reference(before_backdrop(double(infinity)), plain_lens()); }
StressResult focus_inf() {
    ThinLens lens = plain_lens();
    lens.focus = double(infinity);
    return against_reference(before_backdrop(20), lens);
}
StressResult sky_in_focus_inf() {
    ThinLens lens = plain_lens();
    lens.focus = double(infinity);
    return against_reference(before_backdrop(double(infinity)), lens);
}

// Focused at a millimetre: the whole scene is far behind the focus.
StressResult focus_1e_3() {
    const ThinLens lens{.radius = 1e-5, .focal_px = 640, .focus = 1e-3};
    return against_reference(grey_ldi(window(40, 28),
                                      [](int x, int y) {
                                          return Pixel{{x < 20 ? 1e-3 : 5e-3, texture(x, y)}};
                                      }),
                             lens);
}

// A 50 mm lens in metres, and a surface 20 mm in front of it: nearer than any real lens could focus, but still a plane.
StressResult inside_focal_length() {
    const ThinLens lens{.radius = 0.00125, .focal_px = 640, .focus = 0.03};
    return against_reference(grey_ldi(window(40, 28),
                                      [](int x, int y) {
                                          return Pixel{{((x / 8 + y / 8) % 2 == 0 ? 0.02 : 0.03) *
                                                            (1 + 0.01 * double(texture(x, y + 50))),
                                                        texture(x, y), 1, 0.25f * texture(y, x)}};
                                      }),
                             lens);
}

// A surface at the smallest float depth: its light leaves the picture, and nothing else changes.
StressResult nearest_float() {
    StressResult result;
    const ThinLens lens = plain_lens();
    const auto plane = [&](float nearest) {
        return grey_ldi(window(64, 48), [&](int x, int y) {
            Pixel pixel;
            if (x == 30 && y == 20) pixel.push_back({double(nearest), 0.5f, 0.5f});
            pixel.push_back({depth_of(lens, 3), texture(x, y)});
            return pixel;
        });
    };
    const Ldi with = plane(std::numeric_limits<float>::min()), without = plane(infinity);
    const Image expected = gather(grey_ldi(window(64, 48),
                                           [&](int x, int y) {
                                               return Pixel{{depth_of(lens, 3), texture(x, y)}};
                                           }),
                                  lens, result);
    result.error = off_from(gather(with, lens, result), expected, with.windows.data);
    return result;
}

// One pixel's depth is bad; the rest of a textured plane out of focus must not change.
StressResult bad_depth(float bad, std::size_t counted) {
    StressResult result;
    const ThinLens lens = plain_lens();
    const auto plane = [&](float z) {
        return grey_ldi(window(64, 48), [&](int x, int y) {
            return Pixel{{x == 30 && y == 20 ? double(z) : depth_of(lens, 3), texture(x, y)}};
        });
    };
    Ldi ldi = plane(bad);
    const bool right_count = sanitize(ldi, "stress").depths == counted;
    const Ldi expected = plane(counted == 0 ? infinity : float(depth_of(lens, 3)));
    result.error = off_from(gather(ldi, lens, result), gather(expected, lens, result), ldi.windows.data);
    if (!right_count) result.error = INFINITY;
    return result;
}
StressResult z_zero() { return bad_depth(0, 0); }
StressResult z_denormal() { return bad_depth(1e-40f, 0); }
StressResult z_negative() { return bad_depth(-2, 1); }
StressResult z_nan() { return bad_depth(std::nanf(""), 1); }

constexpr const char *float_sums =
    "64 lens points summed in float: 64 roundings of 6e-8, and what the flattened tile lacks of them";
constexpr const char *reorders =
    "the kernel only reorders the reference's sums: docs/tolerances.md, section 4";
constexpr const char *same_input = "after the repair the input is the same, bit for bit";

constexpr std::array cases{
    StressCase{"near_far_1e9", "depths 1 and 1e9 in every pixel show their composite", rounding, float_sums,
               near_and_far},
    StressCase{"ulps_apart", "three depths one ulp from each other show their composite", rounding,
               float_sums, ulps_apart},
    StressCase{"coc_ulp_before_focus", "c one float ulp before focus, against long double", 1e-12,
               "(z - d) is exact in double; three more operations round at 1.1e-16", coc_before_focus},
    StressCase{"coc_ulp_behind_focus", "c one float ulp behind focus, against long double", 1e-12,
               "(z - d) is exact in double; three more operations round at 1.1e-16", coc_behind_focus},
    StressCase{"plane_ulp_before_focus", "a textured plane one ulp before focus is the flattened picture", 0,
               "no CoC reaches half a pixel: tiles are copied", plane_before_focus},
    StressCase{"plane_ulp_behind_focus", "a textured plane one ulp behind focus is the flattened picture", 0,
               "no CoC reaches half a pixel: tiles are copied", plane_behind_focus},
    StressCase{"sky_inf", "texture at z = inf behind blobs, against the reference", rounding, reorders,
               sky_inf},
    StressCase{"sky_1e10", "texture at z = 1e10 behind blobs, against the reference", rounding, reorders,
               sky_1e10},
    StressCase{"sky_1e30", "texture at z = 1e30 behind blobs, against the reference", rounding, reorders,
               sky_1e30},
    StressCase{"sky_65504", "texture at z = 65504, a half-float sky, against the reference", rounding,
               reorders, sky_65504},
    StressCase{"focus_inf", "focus at infinity, against the reference", rounding, reorders, focus_inf},
    StressCase{"focus_inf_sky_inf", "focus and backdrop at infinity, against the reference", rounding,
               reorders, sky_in_focus_inf},
    StressCase{"focus_1e-3", "focus at 1e-3, against the reference", rounding, reorders, focus_1e_3},
    StressCase{"inside_focal_length", "a surface nearer than the focal length, against the reference",
               rounding, reorders, inside_focal_length},
    StressCase{"nearest_float", "one half covered pixel at z = 1.2e-38 changes no other", rounding,
               "its disc is 1e39 pixels wide: of its light nothing falls into the picture", nearest_float},
    StressCase{"z_zero", "one pixel of depth 0 is the sky", 0, same_input, z_zero},
    StressCase{"z_denormal", "one pixel of depth 1e-40 is the sky", 0, same_input, z_denormal},
    StressCase{"z_negative", "one pixel of depth -2 takes its neighbours', and is counted", 0, same_input,
               z_negative},
    StressCase{"z_nan", "one pixel of depth NaN takes its neighbours', and is counted", 0, same_input, z_nan},
};

} // namespace

std::span<const StressCase> depth_stress() { return cases; }

} // namespace sparselens::lab
