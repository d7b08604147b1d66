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

TEST(Text, ParametersAreSpelledAndAllElseIsLeft) {
    const auto said = [](std::string_view message) {
        return spelled(message, [](const std::string &name, const std::string &value) {
            return "<" + name + "|" + value + ">";
        });
    };
    EXPECT_EQ(said("give `fstop` or `lens_radius`"), "give <fstop|> or <lens_radius|>");
    EXPECT_EQ(said("`depth=a=b`: `view=X,Y rim.exr`"), "<depth|a=b>: <view|X,Y rim.exr>");
    EXPECT_EQ(said("`fstop`"), "<fstop|>");
    for (const char *text : {"", "`", "a`b", "``", "`a b`", "`=1`", "--fstop", "`Fstop`"})
        EXPECT_EQ(said(text), text);
    EXPECT_EQ(said("it`s: give `fstop`"), "it`s: give <fstop|>");
}

TEST(Text, AWordIsAmongOthersOnlyWhenItIsEqual) {
    const std::vector<std::string> words{"one", "two"};
    EXPECT_TRUE(is_among(words, "two"));
    EXPECT_FALSE(is_among(words, "tw"));
    EXPECT_FALSE(is_among(std::array<const char *, 1>{"one"}, "One"));
    EXPECT_TRUE(is_among(std::array<const char *, 1>{"one"}, "one"));
}

TEST(Text, TheNearestWordIsTheOneThatWasMeant) {
    const std::vector<std::string> words{"--fstop", "--focus-distance", "--focal-length", "--far", "--stats"};
    EXPECT_EQ(nearest_word("--f-stop", words), "--fstop");
    EXPECT_EQ(nearest_word("-F_Stop", words), "--fstop");
    EXPECT_EQ(nearest_word("--focus-distnace", words), "--focus-distance"); // two letters exchanged
    EXPECT_EQ(nearest_word("--fstp", words), "--fstop");
    EXPECT_EQ(nearest_word("--state", words), "--stats");
    for (const char *other : {"--no-such-option", "", "--", "-q", "--holdout", "--fa-r-t-h-e-r"})
        EXPECT_EQ(nearest_word(other, words), "") << other;
    EXPECT_EQ(nearest_word(std::string(100'000, 'x'), words), "");
    EXPECT_EQ(nearest_word("fstop", {}), "");
}

} // namespace
} // namespace sparselens
