#include "base/channel_kind.h"
#include "base/image.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using Names = std::vector<std::string>;

TEST(ChannelNames, WordsAndLettersInAnyCaseAreColours) {
    EXPECT_EQ(colour_name("red"), "R");
    EXPECT_EQ(colour_name("Green"), "G");
    EXPECT_EQ(colour_name("b"), "B");
    EXPECT_EQ(colour_name("ALPHA"), "A");
    EXPECT_EQ(colour_name("R"), "R");
    EXPECT_EQ(colour_name("beauty.red"), "beauty.R");
    EXPECT_EQ(colour_name("fg.diffuse.a"), "fg.diffuse.A");
    for (const char *name : {"Z", "X", "redder", "red.x", "", "AR", "shadow"})
        EXPECT_EQ(colour_name(name), name);
}

TEST(ChannelNames, OnlyLightIsRenamedAndNoNameIsTakenTwice) {
    std::vector<Channel> channels{{"R"},
                                  {"red"},
                                  {"g"},
                                  {"green"},
                                  {"uv.r", PixelType::float32},
                                  {"id.r", PixelType::uint32},
                                  {"CryptoObject00.r", PixelType::float32}};
    find_kinds(channels);
    EXPECT_EQ(names_of_colours(channels),
              (Names{"R", "red", "G", "green", "uv.r", "id.r", "CryptoObject00.r"}));
}

} // namespace
} // namespace sparselens
