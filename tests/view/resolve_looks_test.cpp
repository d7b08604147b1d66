#include "base/error.h"
#include "support/given_looks.h"
#include "support/scratch_folder.h"
#include "view/resolve_lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

// 50 mm at f/2 on a film back of 25 mm and 100 pixels: 4 pixels per mm, a radius of 12.5 mm.
Camera camera() {
    Camera camera;
    camera.focal_length_mm = 50;
    camera.sensor_width_mm = 25;
    return camera;
}

const ThinLens lens{.radius = 0.0125, .focal_px = 200, .focus = 4};
const Windows windows = windows_of_size(100, 60);

LookValues breathing(double b) { return given(std::pair(&LookValues::breathing, b)); }

LensLooks resolved(const LookValues &values) { return resolve_looks(values, camera(), lens, windows); }

TEST(ResolveLooks, NothingGivenIsNoLook) { EXPECT_EQ(resolved({}), LensLooks()); }

TEST(ResolveLooks, CarriesTheShapeAndTheCatEye) {
    LookValues values =
        given(std::pair(&LookValues::blades, 6), std::pair(&LookValues::curvature, 0.5),
              std::pair(&LookValues::rotation, 15), std::pair(&LookValues::squeeze, 2),
              std::pair(&LookValues::spherical, -0.3), std::pair(&LookValues::cat_eye, 1.5),
              std::pair(&LookValues::field_curvature, 0.2), std::pair(&LookValues::astigmatism, -0.4));
    values.cat_eye_darkening = true;
    const LensLooks looks = resolved(values);
    const ApertureShape shape{.blades = 6, .curvature = 0.5, .rotation = 15, .squeeze = 2, .spherical = -0.3};
    EXPECT_EQ(looks, (LensLooks{.aperture = shape,
                                .cat_eye = 1.5,
                                .cat_eye_darkening = true,
                                .field_curvature = 0.2,
                                .astigmatism = -0.4}));
}

// Red that is sharp 0.1 mm behind the sensor has a cone of 0.1 / (2 N) mm at the sensor, as objects in front of focus
// have.
TEST(ResolveLooks, ShiftsTheFocusOfColours) {
    const double coc = 0.1 / (2 * 2) * 4; // pixels
    using Cocs = std::array<double, 3>;
    const auto cocs = [&](std::optional<ChromaticType> type) {
        LookValues values = given(std::pair(&LookValues::axial_chromatic, 0.1));
        values.chromatic_type = type;
        return resolved(values).chromatic_coc;
    };
    const auto expect = [](const Cocs &found, const Cocs &expected) {
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 1e-12);
    };
    expect(cocs({}), {-coc, 0, coc});
    expect(cocs(ChromaticType::red_blue), {-coc, 0, coc});
    expect(cocs(ChromaticType::blue_yellow), {0, 0, coc});
    expect(cocs(ChromaticType::green_magenta), {-coc, 0, -coc});
    EXPECT_EQ(resolve_looks(given(std::pair(&LookValues::axial_chromatic, 0.1)), camera(),
                            {.radius = 0, .focal_px = 200, .focus = 4}, windows),
              LensLooks());
}

TEST(ResolveLooks, TiltsByTangents) {
    const LensLooks looks =
        resolved(given(std::pair(&LookValues::tilt_x, 45), std::pair(&LookValues::tilt_y, -60)));
    EXPECT_NEAR(looks.tilt.x, 1, 1e-12);
    EXPECT_NEAR(looks.tilt.y, -std::numbers::sqrt3, 1e-12);
}

TEST(ResolveLooks, BreathesAsAThinLensThatMoves) {
    EXPECT_NEAR(resolved(breathing(1)).magnification, 4 / (4 - 0.05), 1e-12);
    EXPECT_NEAR(resolved(breathing(2)).magnification, std::pow(4 / 3.95, 2), 1e-12);
    EXPECT_EQ(resolved(breathing(0)).magnification, 1);
    Camera in_tens = camera();
    in_tens.metres_per_unit = 10;
    EXPECT_NEAR(resolve_looks(breathing(1), in_tens, lens, windows).magnification, 4 / (4 - 0.005), 1e-12);
}

TEST(ResolveLooks, LooksFromWhereTheOpticalAxisIs) {
    Camera shifted = camera();
    shifted.principal_point = Imath::V2d(0.1, -0.05); // display widths
    const LensLooks looks = resolve_looks({}, shifted, lens, windows);
    EXPECT_NEAR(looks.axis.x, 10, 1e-9);
    EXPECT_NEAR(looks.axis.y, -5, 1e-9);
}

TEST(ResolveLooks, NamesWhatIsMissing) {
    Camera unknown;
    for (const auto &[values, option] :
         {std::pair(breathing(1), "breathing"),
          std::pair(given(std::pair(&LookValues::axial_chromatic, 1)), "axial")}) {
        const auto message =
            what_of<UsageError>([&, &values = values] { resolve_looks(values, unknown, lens, windows); });
        EXPECT_NE(message.find(option), std::string::npos) << message;
        EXPECT_NE(message.find("`focal_length`"), std::string::npos) << message;
    }
    const ThinLens near{.radius = 0.0125, .focal_px = 200, .focus = 0.05};
    EXPECT_NE(
        what_of<UsageError>([&] { resolve_looks(breathing(1), camera(), near, windows); }).find("no lens"),
        std::string::npos);
}

} // namespace
} // namespace sparselens
