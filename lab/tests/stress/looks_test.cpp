// Extreme looks of the lens: a plane of one colour keeps its colour under each of them.
#include "base/error.h"
#include "dof/lens/lens_gather.h"
#include "lab/tests/stress/stress.h"

#include <algorithm>
#include <memory>

namespace sparselens::stress {

namespace {

std::vector<LensLooks> all_looks() {
    const auto tinted =
        std::make_shared<AperturePicture>(AperturePicture{2, 2, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 2, 3}});
    return {{.aperture = {.blades = 3}},
            {.aperture = {.blades = 16, .curvature = 0.5, .squeeze = 2, .spherical = 1}},
            {.aperture = {.spherical = -1}},
            {.aperture = {.spherical = 0.5, .picture = tinted}},
            {.cat_eye = 1},
            {.chromatic_coc = {-1, 0, 1}},
            {.field_curvature = 1, .tilt = {1, -1}},
            {.astigmatism = 1},
            {.magnification = 1.02}};
}

// How far the plane is from its colour, including flattened tiles.
Result plane(const std::vector<LensLooks> &various, double coc = 5, int width = 48, int height = 32) {
    ThinLens lens = plain_lens;
    lens.radius *= std::max(1.0, coc / 4);
    const Ldi ldi = colour_ldi(width, height, [&](int, int) { return Pixel{{depth_of(lens, coc), 0.3f}}; });
    Result result;
    for (const LensLooks &looks : various) {
        Progress silent;
        const Image image = lens_gather(ldi, lens, ldi.windows.data, {.looks = looks}, silent);
        result.error = std::max(result.error, off_from(image, 0, ldi.windows.data, double(0.3f)));
    }
    return result;
}

Result black_aperture() {
    const auto black = std::make_shared<AperturePicture>(AperturePicture{1, 1, {0, 0, 0}});
    EXPECT_THROW(plane({{.aperture = {.picture = black}}}, 5, 8, 8), Error);
    return {};
}

constexpr Limit conserved{1e-4, "light is conserved: weights are divided by those that a pixel sees"};
constexpr Limit nothing{1e-4, "where nothing is left the picture is as it was rendered"};

constexpr Case cases[] = {
    {"looks_coc_1e-6", "every look at a CoC of 1e-6 pixels keeps a plane's colour", conserved,
     [] { return plane(all_looks(), 1e-6); }},
    {"looks_coc_1e4", "every look at a CoC of 1e4 pixels keeps a plane's colour", conserved,
     [] { return plane(all_looks(), 1e4); }},
    {"looks_one_pixel", "every look on a picture of one pixel keeps its colour", conserved,
     [] { return plane(all_looks(), 5, 1, 1); }},
    {"looks_16384x1", "every look on a picture of 16384x1 pixels keeps its colour", conserved,
     [] { return plane(all_looks(), 5, 16384, 1); }},
    {"squeeze_1e-3", "an aperture 1000 times wider than high keeps a plane's colour", conserved,
     [] { return plane({{.aperture = {.squeeze = 1e-3}}}); }},
    {"squeeze_1e3", "an aperture 1000 times higher than wide keeps a plane's colour", conserved,
     [] { return plane({{.aperture = {.blades = 5, .squeeze = 1e3}}}); }},
    {"cat_eye_nothing", "a cat-eye that leaves nothing of the lens keeps a plane's colour", nothing,
     [] { return plane({{.cat_eye = 100}}); }},
    {"black_aperture",
     "a black picture of an aperture is an error",
     {0, "no light would pass"},
     black_aperture},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(looks, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
