#include "base/error.h"
#include "viewing/page_request.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(PageRequest, IsRead) {
    const PageRequest wanted = parse_page_request(
        R"({"page": "k3J9", "settings": {"fstop": "2.8", "tilt": "-3,4"}, "exposure": -1.5, "frame": -3, "pixel": [320, -1], "region": [-2, 3, 40, 3]})");
    EXPECT_EQ(wanted.page, "k3J9");
    EXPECT_EQ(wanted.settings, (std::map<std::string, std::string>{{"fstop", "2.8"}, {"tilt", "-3,4"}}));
    EXPECT_EQ(wanted.exposure, -1.5);
    EXPECT_EQ(wanted.frame, -3);
    EXPECT_EQ(wanted.pixel, Imath::V2i(320, -1));
    EXPECT_EQ(wanted.region, Imath::Box2i({-2, 3}, {40, 3}));
    const PageRequest least = parse_page_request(R"({"page": "a"})");
    EXPECT_TRUE(least.settings.empty());
    EXPECT_FALSE(least.frame);
    EXPECT_FALSE(least.pixel);
    EXPECT_FALSE(least.region);
    EXPECT_EQ(least.format, "exr");
    EXPECT_EQ(parse_page_request(R"({"page": "a", "format": "png"})").format, "png");
}

TEST(PageRequest, AnythingElseIsRefused) {
    for (const char *text : {"",
                             "{",
                             "[]",
                             "null",
                             "{}",
                             R"({"page": ""})",
                             R"({"page": 1})",
                             R"({"page": "../a"})",
                             R"({"settings": {}})",
                             R"({"page": "a", "more": 1})",
                             R"({"page": "a", "settings": []})",
                             R"({"page": "a", "settings": {"fstop": 2}})",
                             R"({"page": "a", "settings": {"lens": "/etc/passwd"}})",
                             R"({"page": "a", "settings": {"fstop": "2 3"}})",
                             R"({"page": "a", "region": [0, 0, 1]})",
                             R"({"page": "a", "region": [0, 0, 1, 1.5]})",
                             R"({"page": "a", "region": [5, 0, 4, 9]})",
                             R"({"page": "a", "exposure": "1"})",
                             R"({"page": "a", "exposure": 21})",
                             R"({"page": "a", "format": "../a"})",
                             R"({"page": "a", "format": 1})",
                             R"({"page": "a", "frame": 1.5})",
                             R"({"page": "a", "frame": 3000000000})",
                             R"({"page": "a", "frame": 18446744073709551615})", // -1 in 64 bits
                             R"({"page": "a", "pixel": [1]})",
                             R"({"page": "a", "pixel": [1.5, 2]})",
                             R"({"page": "a", "pixel": [1e300, 2]})",
                             R"({"page": "a", "pixel": [2147483648, 2]})"})
        EXPECT_THROW(parse_page_request(text), UsageError) << text;
    const std::string longest(64, '1'), page(32, 'a');
    EXPECT_NO_THROW(
        parse_page_request(R"({"page": ")" + page + R"(", "settings": {"fstop": ")" + longest + R"("}})"));
    EXPECT_THROW(parse_page_request(R"({"page": ")" + page + R"(a"})"), UsageError);
    EXPECT_THROW(parse_page_request(R"({"page": "a", "settings": {"fstop": ")" + longest + R"(1"}})"),
                 UsageError);
    EXPECT_THROW(parse_page_request(R"({"page": "a"})" + std::string(most_request_bytes, ' ')), UsageError);
    EXPECT_THROW(parse_page_request(std::string(most_request_bytes, '[')), UsageError);
}

} // namespace
} // namespace sparselens
