#include "base/error.h"
#include "io/display/colour.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>

namespace sparselens {
namespace {

// One pixel with these values.
Image pixel(std::vector<Channel> channels, const std::vector<float> &values) {
    Image image(windows_of_size(1, 1), std::move(channels));
    image.values = LargeArray<float>(values.begin(), values.end());
    return image;
}

Image transformed(const ColourTransform &transform, Image image) {
    transform_colours(transform, image);
    return image;
}

const Channel red{"R", PixelType::half}, green{"G", PixelType::half}, blue{"B", PixelType::half},
    alpha{"A", PixelType::half};

double srgb_to_linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

TEST(Colour, SrgbIsTheStandards) {
    const ColourTransform transform = ColourConfig().between("sRGB", "Linear Rec.709");
    for (const float v : {0.0f, 0.02f, 0.25f, 0.5f, 1.0f, 2.0f}) {
        const Image out = transformed(transform, pixel({red, green, blue}, {v, v / 2, v / 4}));
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(out.values[k], srgb_to_linear(double(v) / (1 << k)), 1e-5 * (1 + double(v)));
    }
}

// White stays white between all linear spaces, and a round trip changes nothing.
TEST(Colour, LinearSpacesShareTheirWhite) {
    const ColourConfig config;
    for (const char *space :
         {"ACEScg", "ACES2065-1", "Linear Rec.2020", "Linear P3-D65", "Display P3", "Rec.1886"}) {
        const ColourTransform out = config.between(config.scene_linear(), space);
        const ColourTransform back = config.between(space, config.scene_linear());
        const Image white = transformed(out, pixel({red, green, blue}, {1, 1, 1}));
        for (const float v : white.values) EXPECT_NEAR(v, 1, 1e-5) << space;
        const Image colour = pixel({red, green, blue}, {0.7f, 0.1f, 1.5f});
        const Image again = transformed(back, transformed(out, colour));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(again.values[k], colour.values[k], 1e-4) << space;
    }
    EXPECT_TRUE(config.between("ACEScg", "acescg").changes_nothing());
}

// The ACES technical documents give AP1's primaries, and so Rec.709 red in ACEScg.
TEST(Colour, RedInAcescg) {
    const ColourConfig config;
    const Image out =
        transformed(config.between("lin_rec709", "ACEScg"), pixel({red, green, blue}, {1, 0, 0}));
    EXPECT_NEAR(out.values[0], 0.6131, 1e-4);
    EXPECT_NEAR(out.values[1], 0.0702, 1e-4);
    EXPECT_NEAR(out.values[2], 0.0206, 1e-4);
}

TEST(Colour, CoverageIsDividedOutAndStays) {
    const ColourTransform transform = ColourConfig().between("sRGB", "Linear Rec.709");
    const Image out = transformed(transform, pixel({red, green, blue, alpha}, {0.25f, 0.125f, 0, 0.5f}));
    EXPECT_NEAR(out.values[0], 0.5 * srgb_to_linear(0.5), 1e-5);
    EXPECT_NEAR(out.values[1], 0.5 * srgb_to_linear(0.25), 1e-5);
    EXPECT_EQ(out.values[3], 0.5f);
    // Light without coverage.
    const Image glow = transformed(transform, pixel({red, green, blue, alpha}, {0.5f, 0.5f, 0.5f, 0}));
    EXPECT_NEAR(glow.values[0], srgb_to_linear(0.5), 1e-5);
}

TEST(Colour, LayersAreColoursAndAllElseIsNot) {
    const ColourTransform transform = ColourConfig().between("sRGB", "Linear Rec.709");
    const float id = std::bit_cast<float>(0x7fc12345u);
    const std::vector<Channel> channels{
        {"light.R", PixelType::half},    {"light.G", PixelType::half},    {"light.B", PixelType::half},
        {"light.A", PixelType::half},    {"N.X", PixelType::float32},     {"N.Y", PixelType::float32},
        {"Z", PixelType::float32},       {"crypto.R", PixelType::uint32}, {"crypto.G", PixelType::uint32},
        {"crypto.B", PixelType::uint32}, {"lonely.R", PixelType::float32}};
    const Image in = pixel(channels, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, id, id, id, 0.5f});
    const Image out = transformed(transform, in);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(out.values[k], srgb_to_linear(0.5), 1e-5);
    for (std::size_t k = 3; k < channels.size(); ++k)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(out.values[k]), std::bit_cast<std::uint32_t>(in.values[k]))
            << channels[k].name;
}

TEST(Colour, FileRulesKnowOpenExr) {
    const ColourConfig config;
    EXPECT_EQ(config.scene_linear(), "Linear Rec.709");
    EXPECT_EQ(config.space_of_file("some/where/shot.0001.exr"), "Linear Rec.709");
    EXPECT_EQ(config.space_of_file("SHOT.EXR"), "Linear Rec.709");
    EXPECT_EQ(config.space_of_file("plate.png"), "sRGB");
}

TEST(Colour, DefaultDisplayIsSrgb) {
    const ColourConfig config;
    const Image in = pixel({red, green, blue}, {0.2f, 0.4f, 0.8f});
    EXPECT_EQ(transformed(config.to_display("", ""), in).values,
              transformed(config.between(config.scene_linear(), "sRGB"), in).values);
    EXPECT_EQ(transformed(config.to_display("sRGB", "Raw"), in).values, in.values);
}

std::string message(const std::function<void()> &work) {
    try {
        work();
    } catch (const Error &error) {
        return error.what();
    }
    return "";
}

TEST(Colour, WhatIsNotThereIsNamed) {
    const ColourConfig config;
    EXPECT_NE(message([&] { config.between("sRGB", "nowhere"); }).find("no colour space 'nowhere', only"),
              std::string::npos);
    EXPECT_NE(message([&] { config.to_display("wall", ""); }).find("no display 'wall', only sRGB"),
              std::string::npos);
    EXPECT_NE(message([&] { config.to_display("", "inverted"); }).find("no view of sRGB 'inverted'"),
              std::string::npos);
    EXPECT_NE(message([] { ColourConfig("missing.ocio"); }).find("missing.ocio (`colorconfig`)"),
              std::string::npos);
    const ScratchFolder folder;
    std::ofstream(folder.file("broken.ocio")) << "ocio_profile_version: 99\n";
    EXPECT_NE(message([&] { ColourConfig(folder.file("broken.ocio")); }).find("broken.ocio"),
              std::string::npos);
}

// Primaries and white in the form that renderers write, rounded.
TEST(Colour, ChromaticitiesNameALinearSpace) {
    const ColourConfig config;
    using V = Imath::V2f;
    const Imf::Chromaticities ap1(V(0.713f, 0.293f), V(0.165f, 0.83f), V(0.128f, 0.044f),
                                  V(0.3217f, 0.3377f));
    const Imf::Chromaticities ap0(V(0.7347f, 0.2653f), V(0, 1), V(0.0001f, -0.077f), V(0.32168f, 0.33767f));
    const Imf::Chromaticities odd(V(0.7f, 0.3f), V(0.2f, 0.7f), V(0.1f, 0.1f), V(0.33f, 0.33f));
    EXPECT_EQ(config.linear_space(ap1), "ACEScg");
    EXPECT_EQ(config.linear_space(ap0), "ACES2065-1");
    EXPECT_EQ(config.linear_space({}), "Linear Rec.709"); // the space of files without chromaticities
    EXPECT_EQ(config.linear_space(odd), std::nullopt);
}

TEST(Colour, LinearSpacesHaveChromaticitiesByAnyOfTheirNames) {
    const ColourConfig config;
    for (const char *name : {"ACEScg", "acescg", "lin_ap1"}) {
        const auto found = config.chromaticities_of(name);
        ASSERT_TRUE(found) << name;
        EXPECT_EQ(config.linear_space(*found), "ACEScg");
    }
    EXPECT_TRUE(config.chromaticities_of("scene_linear")); // a role
    for (const char *name : {"sRGB", "Gamma 2.2", "Raw", "nowhere", ""})
        EXPECT_FALSE(config.chromaticities_of(name)) << name;
}

// The configuration's matrices match the chromaticities in the table: white stays white, and red, green and blue of the
// space are at its primaries.
TEST(Colour, ChromaticitiesAreThoseOfTheMatrices) {
    const ColourConfig config;
    const Imath::M44f of_709 = Imf::RGBtoXYZ(Imf::Chromaticities(), 1);
    for (const char *name :
         {"Linear Rec.2020", "Linear P3-D65"}) { // they have the white of Rec.709: no adaptation
        const ColourTransform transform = config.between(name, "Linear Rec.709");
        const Imath::M44f own = Imf::RGBtoXYZ(config.chromaticities_of(name).value(), 1);
        for (int k = 0; k < 3; ++k) {
            Imath::V3f rgb(0, 0, 0);
            rgb[k] = 1;
            const Image out = transformed(transform, pixel({red, green, blue}, {rgb.x, rgb.y, rgb.z}));
            const Imath::V3f by_709 = Imath::V3f(out.values[0], out.values[1], out.values[2]) * of_709;
            EXPECT_TRUE(by_709.equalWithAbsError(rgb * own, 1e-4f)) << name << " " << k;
        }
    }
}

} // namespace
} // namespace sparselens
