#include "io/camera/camera_header.h"

#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

Camera full_camera() {
    Camera camera;
    camera.focal_length_mm = 35.5;
    camera.sensor_width_mm = 36.1;
    camera.fstop = 2.75;
    camera.focus_distance = 12.5;
    camera.metres_per_unit = 0.01;
    camera.world_to_camera = Imath::M44d(1, 0, 0, 0, 0, 0.5, 0.25, 0, 0, -0.25, 0.5, 0, 7, 8, 9, 1);
    camera.world_to_ndc = Imath::M44d(2, 0, 0, 0, 0, -3, 0, 0, 0.5, 0.5, 1, 1, 0, 0, -1, 0);
    camera.looks.blades = 7;
    camera.looks.rotation = 30;
    camera.looks.squeeze = 1.5;
    camera.supersample = 3;
    camera.pixel_filter = PixelFilter{PixelFilter::Shape::gaussian, 2.5};
    camera.lens_points = {{0, 0}, {0.0625, -0.03125}, {-1e-9, 12345.5}};
    return camera;
}

TEST(CameraMetadata, EverythingComesBack) {
    Imf::Header header;
    write_camera(header, full_camera());
    const Camera read = read_camera(header);
    EXPECT_EQ(read.focal_length_mm, 35.5);
    EXPECT_EQ(read.sensor_width_mm, 36.1);
    EXPECT_EQ(read.fstop, 2.75);
    EXPECT_NEAR(read.focus_distance.value(), 12.5, 1e-6);
    EXPECT_EQ(read.metres_per_unit, 0.01);
    EXPECT_EQ(read.looks.blades, 7);
    EXPECT_NEAR(read.looks.rotation.value(), 30, 1e-5);
    EXPECT_EQ(read.looks.squeeze, 1.5);
    EXPECT_EQ(read.world_to_camera, full_camera().world_to_camera);
    EXPECT_EQ(read.world_to_ndc, full_camera().world_to_ndc);
    EXPECT_EQ(read.lens_points, full_camera().lens_points);
    EXPECT_EQ(read.supersample, 3);
    EXPECT_EQ(read.pixel_filter, full_camera().pixel_filter);
}

// A picture's header does not mention sub-pixels, even if its camera has them.
TEST(CameraMetadata, APictureHasNoSubpixels) {
    Imf::Header header;
    write_camera(header, full_camera());
    write_picture_window(header, {{1, 1}, {6, 4}});
    write_picture_camera(header, full_camera());
    EXPECT_EQ(header.find("sparselens:dataWindow"), header.end()) << "that of the LDI";
    const Camera read = read_camera(header);
    EXPECT_FALSE(read.supersample || read.pixel_filter);
    EXPECT_EQ(read.fstop, 2.75);
}

TEST(CameraMetadata, SubpixelsThatCannotBeAreNotRead) {
    for (const int across : {-1, 0, 17}) {
        Imf::Header header;
        header.insert("ldi.supersample", Imf::IntAttribute(across));
        header.insert("ldi.pixelFilter", Imf::StringAttribute("sinc"));
        const Camera read = read_camera(header);
        EXPECT_FALSE(read.supersample || read.pixel_filter);
        EXPECT_TRUE(read.unsure.contains("supersample") && read.unsure.contains("pixel_filter"));
    }
}

// Impossible apertures are ignored: a squeeze of 1e-30 would make every sample reach every tile.
TEST(CameraMetadata, AnApertureThatCannotBeIsNotRead) {
    const auto looks_of = [](int blades, float ratio, float rotation) {
        Imf::Header header;
        header.insert("aperture_blades", Imf::IntAttribute(blades));
        header.insert("aperture_ratio", Imf::FloatAttribute(ratio));
        header.insert("aperture_rotation", Imf::FloatAttribute(rotation));
        return read_camera(header).looks;
    };
    EXPECT_EQ(looks_of(5, 0.5f, 0).squeeze, 0.5);
    for (const float ratio : {1e-30f, 0.0f, -1.0f, 1e30f})
        EXPECT_FALSE(looks_of(5, ratio, 0).squeeze) << ratio;
    EXPECT_EQ(looks_of(2, 1, 0).blades, 0); // Cycles treats them as none
    EXPECT_FALSE(looks_of(5, 1, 1e30f).rotation);
}

TEST(CameraMetadata, NothingIsKnownOfAnEmptyHeader) {
    const Camera read = read_camera(Imf::Header());
    EXPECT_FALSE(read.focal_length_mm || read.sensor_width_mm || read.fstop || read.focus_distance ||
                 read.metres_per_unit || read.world_to_camera || read.world_to_ndc);
    EXPECT_TRUE(read.lens_points.empty());
}

TEST(CameraMetadata, WhatIsUnknownIsNotWritten) {
    Imf::Header header;
    write_camera(header, {});
    EXPECT_FALSE(Imf::hasFocus(header) || Imf::hasAperture(header) || Imf::hasWorldToCamera(header) ||
                 Imf::hasWorldToNDC(header));
    EXPECT_EQ(header.findTypedAttribute<Imf::FloatAttribute>("pinholeFocalLength"), nullptr);
}

// The standard attribute is in metres, ours in scene units.
TEST(CameraMetadata, FocusIsStoredInMetres) {
    Camera camera;
    camera.focus_distance = 250;
    camera.metres_per_unit = 0.01;
    Imf::Header header;
    write_camera(header, camera);
    EXPECT_EQ(Imf::focus(header), 2.5f);
    EXPECT_EQ(read_camera(header).focus_distance, 250);
    header.erase("sparselens:metresPerUnit");
    EXPECT_EQ(read_camera(header).focus_distance,
              2.5); // a scene unit is a metre by default
}

TEST(CameraMetadata, InfinityIsAFocusAndAnAperture) {
    Camera camera;
    camera.focus_distance = camera.fstop = inf;
    camera.metres_per_unit = 0.1;
    Imf::Header header;
    write_camera(header, camera);
    EXPECT_EQ(read_camera(header).focus_distance, inf);
    EXPECT_EQ(read_camera(header).fstop, inf);
}

TEST(CameraMetadata, GarbageIsIgnored) {
    for (const float garbage : {0.0f, -1.0f, std::nanf(""), -std::numeric_limits<float>::infinity()}) {
        Imf::Header header;
        Imf::addFocus(header, garbage);
        Imf::addAperture(header, garbage);
        header.insert("pinholeFocalLength", Imf::FloatAttribute(garbage));
        header.insert("sparselens:sensorWidth", Imf::DoubleAttribute(double(garbage)));
        header.insert("sparselens:metresPerUnit", Imf::FloatAttribute(garbage));
        const Camera read = read_camera(header);
        EXPECT_FALSE(read.fstop || read.focus_distance || read.focal_length_mm || read.sensor_width_mm ||
                     read.metres_per_unit)
            << garbage;
    }
    Imf::Header header;
    header.insert("pinholeFocalLength", Imf::FloatAttribute(std::numeric_limits<float>::infinity()));
    EXPECT_FALSE(read_camera(header).focal_length_mm);
}

TEST(CameraMetadata, MatricesThatAreNoNumbersAreIgnored) {
    for (const float garbage : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        Imf::Header header;
        Imath::M44f matrix;
        matrix[3][1] = garbage;
        Imf::addWorldToCamera(header, matrix);
        Imf::addWorldToNDC(header, matrix);
        EXPECT_FALSE(read_camera(header).world_to_camera);
        EXPECT_FALSE(read_camera(header).world_to_ndc);
    }
}

TEST(CameraMetadata, LensPointsEndWhereTheyCannotBeRead) {
    const auto points_in = [](const char *text) {
        Imf::Header header;
        header.insert("sparselens:lensPoints", Imf::StringAttribute(text));
        return read_camera(header).lens_points.size();
    };
    EXPECT_EQ(points_in(""), 0u);
    EXPECT_EQ(points_in("1,2"), 1u);
    EXPECT_EQ(points_in("1,2 3"), 1u);
    EXPECT_EQ(points_in("1,2 3;4"), 1u);
    EXPECT_EQ(points_in("1,2 3,x 5,6"), 1u);
    EXPECT_EQ(points_in("hello"), 0u);
}

// Other programs may write these attributes with any type: numbers are read, and all are replaced.
TEST(CameraMetadata, AttributesOfAnotherTypeAreReplaced) {
    Imf::Header header;
    header.insert("focus", Imf::StringAttribute("far"));
    header.insert("aperture", Imf::IntAttribute(4));
    header.insert("pinholeFocalLength", Imf::DoubleAttribute(50));
    header.insert("sparselens:sensorWidth", Imf::FloatAttribute(24));
    header.insert("sparselens:metresPerUnit", Imf::StringAttribute("1"));
    header.insert("sparselens:lensPoints", Imf::IntAttribute(4));
    header.insert("worldToCamera", Imf::M44dAttribute(*full_camera().world_to_camera));
    header.insert("worldToNDC", Imf::StringAttribute("?"));
    EXPECT_EQ(read_camera(header).focal_length_mm, 50);
    EXPECT_EQ(read_camera(header).sensor_width_mm, 24);
    EXPECT_EQ(read_camera(header).world_to_camera, full_camera().world_to_camera);
    write_camera(header, full_camera());
    const Camera read = read_camera(header);
    EXPECT_EQ(read.fstop, 2.75);
    EXPECT_EQ(read.focal_length_mm, 35.5);
    EXPECT_EQ(read.sensor_width_mm, 36.1);
    EXPECT_EQ(read.world_to_ndc, full_camera().world_to_ndc);
    EXPECT_EQ(read.lens_points.size(), 3u);
}

TEST(PictureWindow, IsTheDataWindowUnlessItIsSaidAndLiesInside) {
    Imf::Header header(Imath::Box2i({0, 0}, {9, 9}), Imath::Box2i({-4, -4}, {13, 13}));
    EXPECT_EQ(read_picture_window(header), header.dataWindow());
    write_picture_window(header, Imath::Box2i({0, 0}, {9, 9}));
    EXPECT_EQ(read_picture_window(header), Imath::Box2i({0, 0}, {9, 9}));
    write_picture_window(header,
                         Imath::Box2i({0, 0}, {9, 14})); // from another file with a larger data window
    EXPECT_EQ(read_picture_window(header), header.dataWindow());
    write_picture_window(header, Imath::Box2i({5, 5}, {2, 2}));
    EXPECT_EQ(read_picture_window(header), header.dataWindow());
}

TEST(CameraMetadata, TheRestOfTheHeaderIsLeftAlone) {
    Imf::Header header;
    header.insert("comments", Imf::StringAttribute("mine"));
    Imf::addFocus(header, 3);
    write_camera(header, {});
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("comments").value(), "mine");
    EXPECT_EQ(Imf::focus(header), 3);
}

} // namespace
} // namespace sparselens
