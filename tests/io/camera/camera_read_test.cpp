// Headers of each renderer give the camera that rendered.
#include "io/camera/camera_header.h"
#include "io/camera/camera_headers.h"
#include "view/lens_views.h"
#include "view/resolve_lens.h"

#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

using namespace camera_headers;

class CameraOf : public testing::TestWithParam<Renderer> {
protected:
    Camera camera(const Imath::V2d &offset = {0, 0}) const {
        Imf::Header header(64, 36);
        GetParam().write(header, Pose(offset));
        return read_camera(header);
    }
};

TEST_P(CameraOf, IsTheOneThatRendered) {
    const Camera read = camera();
    LensValues options;
    if (!GetParam().knows_focus) options.focus_distance = focus;
    if (!GetParam().knows_fstop) options.fstop = fstop;
    const Camera complete = camera_with_options(options, read);
    const ThinLens lens = resolve_lens(complete, windows);
    EXPECT_NEAR(lens.focal_px, 64 * focal / film, 1e-3);
    EXPECT_NEAR(lens.focus, focus, 1e-5);
    EXPECT_NEAR(lens.radius, focal / 1000 / (2 * fstop) / complete.metres_per_unit.value_or(1), 1e-6);
    EXPECT_NEAR(complete.sensor_width_mm.value(), film, 1e-3);
    EXPECT_FALSE(read.found.empty());
    EXPECT_TRUE(read.unsure.empty()) << read.unsure.begin()->second;
}

TEST_P(CameraOf, StandsWhereItStood) {
    const auto place = position_relative_to(camera(), camera({0.25, -0.125}), "view");
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->x, 0.25, 1e-5);
    EXPECT_NEAR(place->y, -0.125, 1e-5);
    EXPECT_NEAR(place->z, 0, 1e-5);
}

TEST_P(CameraOf, ProjectsAsTheStandardHasIt) {
    const Camera read = camera();
    if (!read.world_to_ndc) return; // not every renderer writes one
    const Pose p;
    Imath::V3d ahead, right, below;
    read.world_to_ndc->multVecMatrix(p.place + 2.0 * p.forward, ahead);
    read.world_to_ndc->multVecMatrix(p.place + 2.0 * p.forward + p.right, right);
    read.world_to_ndc->multVecMatrix(p.place + 2.0 * p.forward - p.up, below);
    EXPECT_NEAR(right.x - ahead.x, focal / film / 2, 1e-4);
    EXPECT_NEAR(right.y, ahead.y, 1e-4);
    EXPECT_NEAR(below.y - ahead.y, focal / film * 64 / 36 / 2, 1e-4);
    EXPECT_NEAR(ahead.y, 0.5, 1e-4);
    Imath::V3d in_camera;
    read.world_to_camera->multVecMatrix(p.place + 2.0 * p.forward, in_camera);
    EXPECT_NEAR(in_camera.z, 2, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Renderers, CameraOf, testing::ValuesIn(renderers().begin(), renderers().end()),
                         [](const auto &renderer) {
                             std::string name = renderer.param.name;
                             std::erase_if(
                                 name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                             return name;
                         });

// The picture moved by an eighth of its width: in NDC the axis is at 5/8.
TEST(PrincipalPoint, IsWhereTheMatrixSendsTheAxis) {
    for (const Ndc kind : {Ndc::standard, Ndc::y_up, Ndc::clip}) {
        Imf::Header h(64, 36);
        write_standard(h, Pose(), kind, 0.125);
        const Camera camera = read_camera(h);
        ASSERT_TRUE(camera.principal_point);
        EXPECT_NEAR(camera.principal_point->x, 0.125, 1e-6);
        EXPECT_NEAR(camera.principal_point->y, 0, 1e-6);
        EXPECT_NE(camera.found.back().find("optical axis 0.125,"), std::string::npos) << camera.found.back();
        write_camera(h, camera); // as in an LDI
        EXPECT_NEAR(read_camera(h).principal_point.value().x, 0.125, 1e-6);
    }
    // Down in the picture, in picture widths: a quarter of the height of 64 x 36.
    Imf::Header h(64, 36);
    write_standard(h, Pose());
    Imath::M44d move;
    move.setTranslation(Imath::V3d(0, 0.25, 0));
    put(h, "worldToNDC", standard_camera(Pose()) * projection(Ndc::standard, 1) * move);
    EXPECT_NEAR(read_camera(h).principal_point.value().y, 0.25 * 36 / 64, 1e-6);
}

// A window at depth 1 that is 0.7 wide, centred 0.07 to the right of the axis and 0.14 above it.
TEST(PrincipalPoint, IsTheZeroOfTheScreenWindow) {
    Imf::Header h(64, 36);
    h.screenWindowWidth() = 0.7f;
    h.screenWindowCenter() = {0.07f, 0.14f};
    const Camera camera = read_camera(h);
    ASSERT_TRUE(camera.principal_point);
    EXPECT_NEAR(camera.principal_point->x, -0.1, 1e-6);
    EXPECT_NEAR(camera.principal_point->y, 0.2, 1e-6);
    write_standard(h, Pose(), Ndc::standard, 0.125);
    EXPECT_NEAR(read_camera(h).principal_point.value().x, 0.125, 1e-6); // the matrix is more exact
    for (const float centre : {0.0f, std::nanf("")}) {
        Imf::Header silent(64, 36);
        silent.screenWindowCenter() = {centre, 0};
        EXPECT_FALSE(read_camera(silent).principal_point);
    }
}

// Rounding is not a shift and changes no picture.
TEST(PrincipalPoint, IsTheMiddleWhereNothingElseIsMeant) {
    for (const Ndc kind : {Ndc::standard, Ndc::y_up, Ndc::clip}) {
        Imf::Header h(64, 36);
        write_standard(h, Pose(), kind);
        EXPECT_EQ(read_camera(h).principal_point, Imath::V2d(0, 0));
    }
    EXPECT_FALSE(read_camera(Imf::Header(64, 36)).principal_point);
}

} // namespace
} // namespace sparselens
