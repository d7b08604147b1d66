#include "io/exr/exr_header.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfPixelType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <string_view>

namespace sparselens {
namespace {

Imf::Header stereo() {
    Imf::Header header(Imath::Box2i({0, 0}, {9, 4}), Imath::Box2i({2, 1}, {5, 3}));
    header.compression() = Imf::PIZ_COMPRESSION;
    header.pixelAspectRatio() = 2;
    header.channels().insert("left.R", Imf::Channel(Imf::HALF));
    header.insert("focus", Imf::FloatAttribute(5));
    Imf::addMultiView(header, {"right", "left"});
    return header;
}

TEST(HeaderEdit, WithoutOneAttributeTheOthersAreAsTheyWere) {
    const Imf::Header before = stereo(), after = without_attribute(before, "multiView");
    EXPECT_FALSE(Imf::hasMultiView(after));
    for (auto i = before.begin(); i != before.end(); ++i)
        EXPECT_EQ(after.find(i.name()) != after.end(), std::string_view(i.name()) != "multiView") << i.name();
    EXPECT_EQ(after.displayWindow(), before.displayWindow());
    EXPECT_EQ(after.dataWindow(), before.dataWindow());
    EXPECT_EQ(after.compression(), Imf::PIZ_COMPRESSION);
    EXPECT_EQ(after.pixelAspectRatio(), 2);
    EXPECT_TRUE(after.channels() == before.channels());
    EXPECT_EQ(after.typedAttribute<Imf::FloatAttribute>("focus").value(), 5);
    const Imf::Header copy = without_attribute(before, "none");
    EXPECT_TRUE(Imf::hasMultiView(copy));
}

TEST(HeaderEdit, AnAttributeIsReplacedWhateverItsType) {
    Imf::Header header = stereo();
    set_attribute(header, "focus", Imf::FloatAttribute(6));
    EXPECT_EQ(header.typedAttribute<Imf::FloatAttribute>("focus").value(), 6);
    set_attribute(header, "focus", Imf::StringAttribute("near"));
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("focus").value(), "near");
    set_attribute(header, "owner", Imf::StringAttribute("me"));
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("owner").value(), "me");
    EXPECT_TRUE(Imf::hasMultiView(header));
}

} // namespace
} // namespace sparselens
