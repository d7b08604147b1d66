#include "chain/take_picture.h"
#include "support/given_looks.h"

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
    picture_looks({.name = "Petzval", .values = given(std::pair(&LookValues::blades, 5))}, camera, header,
                  lens, windows_of_size(64, 48));
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("lensModel").value(), "Petzval");
    EXPECT_EQ(camera.looks.blades, 5);
}

TEST(PictureLooks, AreMissedWhereAMethodKnowsNone) {
    EXPECT_FALSE(shape_aperture({}));
    EXPECT_FALSE(
        shape_aperture(given(std::pair(&LookValues::blades, 0), std::pair(&LookValues::squeeze, 1))));
    EXPECT_TRUE(shape_aperture(given(std::pair(&LookValues::blades, 5))));
    EXPECT_TRUE(shape_aperture(given(std::pair(&LookValues::squeeze, 2))));
}

} // namespace
} // namespace sparselens
