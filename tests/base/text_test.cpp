#include "base/text.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace sparselens {
namespace {

TEST(Text, OnlyLettersOfAsciiChangeTheirCase) {
    EXPECT_EQ(lower_case("Ab-Z[@`{9\xc3\x84"), "ab-z[@`{9\xc3\x84");
    EXPECT_EQ(upper_case("Ab-z[@`{9\xc3\xa4"), "AB-Z[@`{9\xc3\xa4");
    EXPECT_EQ(lower_case(""), "");
}

TEST(Text, SingleQuotesAreReadBackByAShell) {
    EXPECT_EQ(single_quoted(""), "''");
    EXPECT_EQ(single_quoted("a b\\$"), "'a b\\$'");
    EXPECT_EQ(single_quoted("it's"), "'it'\\''s'");
}

TEST(Text, AWordIsAmongOthersOnlyWhenItIsEqual) {
    const std::vector<std::string> words{"one", "two"};
    EXPECT_TRUE(is_among(words, "two"));
    EXPECT_FALSE(is_among(words, "tw"));
    EXPECT_FALSE(is_among(std::array<const char *, 1>{"one"}, "One"));
    EXPECT_TRUE(is_among(std::array<const char *, 1>{"one"}, "one"));
}

} // namespace
} // namespace sparselens
