#include "options/picture_options.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

// Parses the words as the options of a tool; exceptions of CLI11 reach the caller.
LensValues parsed(std::vector<std::string> words) {
    CLI::App app;
    LensValues options;
    add_parameters(app, lens_parameters(), options);
    std::reverse(words.begin(), words.end()); // as CLI11 wants them
    app.parse(words);
    return options;
}

TEST(LensOptions, AreRead) {
    const LensValues options = parsed({"--focal-length", "50", "--sensor-width", "36", "--fstop", "1.4",
                                       "--focus-distance", "2.5", "--scene-unit", "0.01"});
    EXPECT_EQ(options.focal_length_mm, 50);
    EXPECT_EQ(options.sensor_width_mm, 36);
    EXPECT_EQ(options.fstop, 1.4);
    EXPECT_EQ(options.focus_distance, 2.5);
    EXPECT_EQ(options.scene_unit, 0.01);
    EXPECT_FALSE(options.lens_radius);
    EXPECT_EQ(parsed({"--lens-radius", "0"}).lens_radius, 0);
    EXPECT_EQ(parsed({"--fstop", "inf"}).fstop, inf);
    EXPECT_EQ(parsed({"--focus-distance", "inf"}).focus_distance, inf);
}

TEST(LensOptions, WrongValuesAreRefused) {
    for (const char *option :
         {"--focal-length", "--sensor-width", "--fstop", "--focus-distance", "--scene-unit"})
        for (const char *value : {"abc", "nan", "0", "-1", "", "1x", "-inf"})
            EXPECT_THROW(parsed({option, value}), CLI::ParseError) << option << " " << value;
    for (const char *option : {"--focal-length", "--sensor-width", "--lens-radius", "--scene-unit"})
        EXPECT_THROW(parsed({option, "inf"}), CLI::ParseError) << option;
    for (const char *value : {"abc", "nan", "-0.1", ""})
        EXPECT_THROW(parsed({"--lens-radius", value}), CLI::ParseError) << value;
    EXPECT_THROW(parsed({"--fstop", "2", "--lens-radius", "0.1"}), CLI::ParseError);
}

} // namespace
} // namespace sparselens
