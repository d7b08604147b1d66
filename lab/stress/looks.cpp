// Extreme looks of the lens: a plane of one colour keeps its colour under each of them.
#include "base/error.h"
#include "dof/lens/lens_gather.h"
#include "lab/stress/scenes.h"

#include <algorithm>
#include <array>

namespace sparselens::lab {

namespace {

using namespace stress;

std::array<LensLooks, 9> all_looks() {
    const auto tinted =
        std::make_shared<AperturePicture>(AperturePicture{2, 2, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 2, 3}});
    return {LensLooks{.aperture = {.blades = 3}},
            LensLooks{.aperture = {.blades = 16, .curvature = 0.5, .squeeze = 2, .spherical = 1}},
            LensLooks{.aperture = {.spherical = -1}},
            LensLooks{.aperture = {.spherical = 0.5, .picture = tinted}},
            LensLooks{.cat_eye = 1},
            LensLooks{.chromatic_coc = {-1, 0, 1}},
            LensLooks{.field_curvature = 1, .tilt = {1, -1}},
            LensLooks{.astigmatism = 1},
            LensLooks{.magnification = 1.02}};
}

// How far the plane is from its colour, including flattened tiles.
double off_plane(const LensLooks &looks, double coc, int width, int height) {
    ThinLens lens = plain_lens();
    lens.radius *= std::max(1.0, coc / 4);
    const Ldi ldi = colour_ldi(window(width, height), [&](int, int) {
        return Pixel{{depth_of(lens, coc), 0.3f}};
    });
    Progress silent;
    const Image image = lens_gather(ldi, lens, ldi.windows.data, {.looks = looks}, silent);
    return off_from(image, 0, ldi.windows.data, double(0.3f));
}

StressResult all_at(double coc, int width = 48, int height = 32) {
    StressResult result;
    for (const LensLooks &looks : all_looks())
        result.error = std::max(result.error, off_plane(looks, coc, width, height));
    return result;
}

StressResult tiny() { return all_at(1e-6); }
StressResult huge() { return all_at(1e4); }
StressResult one_pixel() { return all_at(5, 1, 1); }
StressResult one_row() { return all_at(5, 16384, 1); }
StressResult flat_squeeze() { return {.error = off_plane({.aperture = {.squeeze = 1e-3}}, 5, 48, 32)}; }
StressResult high_squeeze() {
    return {.error = off_plane({.aperture = {.blades = 5, .squeeze = 1e3}}, 5, 48, 32)};
}
StressResult nothing_left() { return {.error = off_plane({.cat_eye = 100}, 5, 48, 32)}; }

StressResult black_picture() {
    const auto black = std::make_shared<AperturePicture>(AperturePicture{1, 1, {0, 0, 0}});
    try {
        off_plane({.aperture = {.picture = black}}, 5, 8, 8);
    } catch (const Error &) {
        return {.error = 0};
    }
    return {.error = 1};
}

constexpr double bound = 1e-4;
constexpr const char *reason = "light is conserved: weights are divided by those that a pixel sees";
constexpr std::array cases{
    StressCase{"looks_coc_1e-6", "every look at a CoC of 1e-6 pixels keeps a plane's colour", bound, reason,
               tiny},
    StressCase{"looks_coc_1e4", "every look at a CoC of 1e4 pixels keeps a plane's colour", bound, reason,
               huge},
    StressCase{"looks_one_pixel", "every look on a picture of one pixel keeps its colour", bound, reason,
               one_pixel},
    StressCase{"looks_16384x1", "every look on a picture of 16384x1 pixels keeps its colour", bound, reason,
               one_row},
    StressCase{"squeeze_1e-3", "an aperture 1000 times wider than high keeps a plane's colour", bound, reason,
               flat_squeeze},
    StressCase{"squeeze_1e3", "an aperture 1000 times higher than wide keeps a plane's colour", bound, reason,
               high_squeeze},
    StressCase{"cat_eye_nothing", "a cat-eye that leaves nothing of the lens keeps a plane's colour", bound,
               "where nothing is left the picture is as it was rendered", nothing_left},
    StressCase{"black_aperture", "a black picture of an aperture is an error", 0, "no light would pass",
               black_picture},
};

} // namespace

std::span<const StressCase> look_stress() { return cases; }

} // namespace sparselens::lab
