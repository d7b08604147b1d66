#include "base/numbers.h"
#include "view/view_mapping.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

constexpr double focal_px = 1400;

// A pinhole camera from first principles: axes right, up, forward; principal point and focal length in pixels.
struct Pinhole {
    Imath::V3d place;
    double focal;
    Imath::V2d axis;
    double pixel_aspect;

    Imath::V2d sees(const Imath::V3d &point) const {
        const Imath::V3d p = point - place;
        return {axis.x + focal * p.x / p.z, axis.y - focal * p.y / p.z * pixel_aspect};
    }
};

struct Case {
    const char *name;
    Imath::V3d place;
    double zoom;
    Imath::V2d principal_point, centre_principal_point;
    float pixel_aspect = 1;
};

const Case cases[] = {
    {"on_axis", {0.05, -0.03, 0}, 1, {0, 0}, {0, 0}},
    {"off_axis", {0.05, -0.03, 0}, 1, {0.013, -0.021}, {0, 0}},
    {"lens_shift", {0.05, -0.03, 0}, 1, {0.25, 0.125}, {0.25, 0.125}},
    {"both_off_axis", {-0.05, 0.03, 0}, 1, {0.26, 0.1}, {0.25, 0.125}},
    {"longer", {0.05, 0.03, 0}, 1.02, {0, 0}, {0, 0}},
    {"shorter_off_axis", {0.05, 0.03, 0}, 0.97, {0.1, 0.2}, {0.11, 0.19}},
    {"in_front", {0.05, 0.03, 0.04}, 1, {0, 0}, {0, 0}},
    {"behind", {0.05, 0.03, -0.04}, 1, {0, 0}, {0, 0}},
    {"all_at_once", {-0.05, 0.03, 0.02}, 1.03, {0.1, -0.2}, {0.09, -0.22}},
    {"wide_pixels", {-0.05, 0.03, 0.02}, 1.03, {0.1, -0.2}, {0.09, -0.22}, 2},
};

class Mapping : public testing::TestWithParam<Case> {
protected:
    Mapping() : windows{Imath::Box2i({-100, 40}, {1819, 1119}), Imath::Box2i({0, 50}, {900, 1000})} {
        const Case &c = GetParam();
        windows.pixel_aspect = c.pixel_aspect;
        const auto camera = [&](const Imath::V3d &place, double zoom, const Imath::V2d &axis) {
            const double aspect = double(windows.pixel_aspect);
            const Imath::V2d pixels(-100 + 1920 * (0.5 + axis.x), 40 + 540 + 1920 * axis.y * aspect);
            return Pinhole{place, focal_px * zoom, pixels, aspect};
        };
        view = camera(c.place, c.zoom, c.principal_point);
        centre = camera({0, 0, 0}, 1, c.centre_principal_point);
    }
    ViewMapping mapping() const {
        const Case &c = GetParam();
        return {{c.place.x, c.place.y},
                focal_px,
                windows,
                {c.place.z, c.zoom, c.principal_point},
                c.centre_principal_point};
    }

    Windows windows;
    Pinhole view, centre;
};

TEST_P(Mapping, IsWhereTheCentreSeesThePoint) {
    std::uint32_t seed = 0;
    const auto random = [&] { return 2 * unit_interval(mix_bits(++seed)) - 1; };
    for (int i = 0; i < 1000; ++i) {
        const double z = 0.5 + 20 * std::abs(random());
        const Imath::V3d point(random() * z, random() * z, z);
        const Imath::V2d q = view.sees(point), p = centre.sees(point);
        const Imath::V2d landed = mapping().at_infinity(q) + mapping().parallax(q) / z;
        EXPECT_LT((landed - p).length(), 1e-9);
        EXPECT_LT((mapping().in_view(p, 1 / z) - q).length(), 1e-9);
    }
}

// Only the framing moves infinitely far points.
TEST_P(Mapping, OfTheSkyIsThatOfDirections) {
    const Imath::V3d direction(0.1, -0.2, 1);
    Pinhole here = view;
    here.place = {0, 0, 0};
    EXPECT_LT((mapping().at_infinity(here.sees(direction)) - centre.sees(direction)).length(), 1e-9);
    EXPECT_LT((mapping().in_view(centre.sees(direction), 0) - here.sees(direction)).length(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Cameras, Mapping, testing::ValuesIn(cases),
                         [](const auto &c) { return std::string(c.param.name); });

TEST(ViewMapping, OfTheSameFramingIsAPureShiftToTheBit) {
    const Windows w = windows_of_size(641, 363);
    for (const Imath::V2d &axis : {Imath::V2d(0, 0), Imath::V2d(0.1, 0.03)}) {
        const ViewMapping mapping({0.05, -0.03}, focal_px, w, {.principal_point = axis}, axis);
        for (const double z : {0.3, 2.7, 1e10}) {
            const Imath::V2d q(17.5, 241.5), shift(focal_px * 0.05, -focal_px * -0.03);
            const double inverse_z = 1 / z;
            const Imath::V2d expected(q.x + shift.x * inverse_z, q.y + shift.y * inverse_z);
            EXPECT_EQ(mapping.at_infinity(q) + mapping.parallax(q) * inverse_z, expected);
            const Imath::V2d back(q.x - shift.x * inverse_z, q.y - shift.y * inverse_z);
            EXPECT_EQ(mapping.in_view(q, inverse_z), back);
        }
    }
}

TEST(ViewMapping, BehindTheViewsCameraIsNowhere) {
    const ViewMapping mapping({0, 0}, focal_px, windows_of_size(64, 36), {.forward = 0.5});
    EXPECT_TRUE(std::isnan(mapping.in_view({10, 10}, 1 / 0.4).x));
    EXPECT_TRUE(std::isnan(mapping.in_view({10, 10}, 1 / 0.5).y));
    EXPECT_TRUE(std::isfinite(mapping.in_view({10, 10}, 1 / 0.6).x));
}

} // namespace
} // namespace sparselens
