#include "chain/picture_looks.h"

#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(PictureLooks, WriteTheLensOverWhateverStandsThere) {
    Imf::Header header(64, 48);
    header.insert("lensModel", Imf::IntAttribute(50));
    Camera camera;
    const ThinLens lens{.radius = 0.1, .focal_px = 100, .focus = 5};
    picture_looks({.name = "Petzval", .values = {.blades = 5}}, camera, header, lens,
                  windows_of_size(64, 48));
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("lensModel").value(), "Petzval");
    EXPECT_EQ(camera.looks.blades, 5);
}

TEST(PictureLooks, AreMissedWhereAMethodKnowsNone) {
    EXPECT_FALSE(warning_of_round_aperture({}, "selective"));
    EXPECT_FALSE(warning_of_round_aperture({.blades = 0, .squeeze = 1}, "selective"));
    EXPECT_EQ(warning_of_round_aperture({.squeeze = 2}, "selective"),
              "method selective ignores the aperture's shape; using a disc");
}

} // namespace
} // namespace sparselens
