#include "base/error.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_deep_part.h"
#include "io/exr/exr_flat.h"
#include "io/photograph.h"
#include "lens/photograph.h"
#include "support/scratch_folder.h"

#include <ImfStandardAttributes.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {
namespace {

// The disparity of a pixel of the frame, counted from its corner: no two pixels near each other have the same.
float disparity(int x, int y) { return float(16 * y + x) / 255; }

constexpr int width = 16, height = 12;

class PhotographFiles : public testing::Test {
protected:
    ScratchFolder folder;

    std::string shown(const char *name, const Windows &windows = windows_of_size(width, height)) {
        return write(name, windows,
                     [](const std::string &path, const Image &image) { write_shown_picture(path, image); });
    }
    std::string exr(const char *name, const Windows &windows) {
        return write(name, windows, [](const std::string &path, const Image &image) {
            write_flat_exr(path, image, Imf::Header(image.windows.display, image.windows.data));
        });
    }
    // The depth in the pixels of the picture.
    static std::vector<float> depths(const std::string &picture, const std::string &depth) {
        return read_photograph(picture, {.depth_file = depth}).ldi.z;
    }
    // The same, if every pixel of the frame has its own depth, and others have that of the nearest pixel of the frame.
    static std::vector<float> expected(const Windows &windows) {
        std::vector<float> all;
        const Imath::V2i &corner = windows.display.min;
        for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
            for (int x = windows.data.min.x; x <= windows.data.max.x; ++x)
                all.push_back(disparity(std::clamp(x - corner.x, 0, width - 1),
                                        std::clamp(y - corner.y, 0, height - 1)));
        return all;
    }
    static void expect_near(const std::vector<float> &found, const std::vector<float> &wanted) {
        ASSERT_EQ(found.size(), wanted.size());
        for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], wanted[i], 1e-6) << i;
    }

private:
    template <typename Write>
    std::string write(const char *name, const Windows &windows, const Write &write_to) {
        Image image(windows,
                    {{"R", PixelType::float32}, {"G", PixelType::float32}, {"B", PixelType::float32}});
        const Imath::V2i &corner = windows.display.min;
        for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
            for (int x = windows.data.min.x; x <= windows.data.max.x; ++x)
                for (std::size_t k = 0; k < 3; ++k)
                    image.at(k, x, y) = std::clamp(disparity(x - corner.x, y - corner.y), 0.0f, 1.0f);
        const std::string path = folder.file(name);
        write_to(path, image);
        return path;
    }
};

// The frame with a data window that is larger, smaller, beside its corner, or all of that.
const std::vector<Windows> &windows_of_exr() {
    const auto at = [](Imath::V2i corner, Imath::Box2i data) {
        return Windows{{corner, corner + Imath::V2i(width - 1, height - 1)}, data, 1};
    };
    static const std::vector<Windows> all{
        at({0, 0}, {{0, 0}, {width - 1, height - 1}}), at({0, 0}, {{-4, -3}, {width + 5, height + 1}}),
        at({0, 0}, {{3, 2}, {width - 2, height - 4}}), at({100, -50}, {{100, -50}, {115, -39}}),
        at({100, -50}, {{90, -48}, {110, -30}}),       at({0, 0}, {{0, 0}, {width + 40, height + 90}})};
    return all;
}

TEST_F(PhotographFiles, DepthBelongsToTheFrameOfTheColours) {
    const std::string depth = shown("depth.png");
    for (const Windows &windows : windows_of_exr()) {
        SCOPED_TRACE(size_text(windows.data));
        expect_near(depths(exr("picture.exr", windows), depth), expected(windows));
    }
}

TEST_F(PhotographFiles, DepthInAnExrMayHaveAnyWindow) {
    const std::string picture = shown("picture.png");
    for (const Windows &windows : windows_of_exr()) {
        SCOPED_TRACE(size_text(windows.data));
        std::vector<float> wanted = expected(windows_of_size(width, height));
        const Imath::V2i &corner = windows.display.min;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (!windows.data.intersects(corner + Imath::V2i(x, y)))
                    wanted[std::size_t(y * width + x)] = 0;
        expect_near(depths(picture, exr("depth.exr", windows)), wanted);
    }
}

// Whatever its file, and wherever the colours of an EXR lie. A cell of it is 4 x 3 pixels.
TEST_F(PhotographFiles, DepthOfAnotherSizeIsFitted) {
    const Windows cells = windows_of_size(4, 4);
    const std::string by_png = shown("small.png", cells), by_tiff = shown("small.tif", cells),
                      by_exr = exr("small.exr", cells);
    const std::string photo = shown("picture.png");
    const std::vector<float> found = depths(photo, by_png);
    expect_near(depths(photo, by_tiff), found);
    expect_near(depths(photo, by_exr), found);
    EXPECT_EQ(std::ranges::count_if(found, [](float d) { return d < 0 || d > 51.0f / 255; }), 0);
    EXPECT_LT(found.front(), found.back());
    expect_near(depths(photo, exr("cornered.exr", {{{7, 8}, {10, 11}}, {{7, 8}, {10, 11}}, 1})), found);
    for (const Windows &windows : windows_of_exr()) {
        SCOPED_TRACE(size_text(windows.data));
        const std::vector<float> of_exr = depths(exr("picture.exr", windows), by_png);
        ASSERT_EQ(of_exr.size(), windows.pixels());
        EXPECT_LE(std::ranges::max(of_exr), 51.0f / 255 + 1e-6f);
    }
    const LdiFile larger =
        read_photograph(photo, {.depth_file = shown("large.png", windows_of_size(48, 36))});
    EXPECT_EQ(larger.ldi.z[0], 17.0f / 255); // the pixel in the middle of 3 x 3
    EXPECT_NE(larger.notes[0].find("48x36 pixels, fitted to the colours of 16x12"), std::string::npos);
}

// A cell of an EXR beyond its data window has no depth.
TEST_F(PhotographFiles, SmallDepthInAnExrMayHaveAnyWindow) {
    const Windows part{{{0, 0}, {3, 2}}, {{-1, 0}, {1, 5}}, 1};
    const std::vector<float> found = depths(shown("picture.png"), exr("part.exr", part));
    EXPECT_GT(found.front(), -1e-6f);
    EXPECT_EQ(found[std::size_t(width - 1)], 0);
    EXPECT_GT(found[std::size_t((height - 1) * width)], 16.0f / 255);
}

TEST_F(PhotographFiles, DepthOfAnotherShapeIsRefused) {
    const std::string picture = shown("picture.png");
    const auto said = [&](int w, int h) {
        const std::string name = fmt::format("{}x{}.png", w, h);
        return what_of<Error>([&] { depths(picture, shown(name.c_str(), windows_of_size(w, h))); });
    };
    EXPECT_NE(said(8, 4).find("8x4.png: is 8x4 pixels large"), std::string::npos);
    EXPECT_NE(said(8, 4).find("--resize 8x6 -o NEW"), std::string::npos);
    EXPECT_NE(said(6, 8).find("turn it"), std::string::npos);
    EXPECT_NE(said(12, 16).find("turn it"), std::string::npos);
    for (const auto &[w, h] : {std::pair(8, 6), {9, 7}, {5, 4}, {15, 12}, {16, 11}, {17, 12}, {1, 1}})
        EXPECT_EQ(said(w, h), "(nothing was thrown)") << w << ' ' << h;
}

TEST_F(PhotographFiles, DepthThatWasNotTurnedIsTurned) {
    Image picture(windows_of_size(width, height), rgba_channels()), depth = picture;
    for (std::size_t i = 0; i < depth.windows.pixels(); ++i)
        for (std::size_t k = 0; k < 3; ++k) depth.plane(k)[i] = float(i % 200) / 255;
    std::ranges::fill(depth.plane(3), 1.0f);
    std::ranges::fill(picture.plane(3), 1.0f);
    const std::string exif("II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0\6\0\0\0\0\0\0\0", 26); // orientation 6
    std::string bytes = shown_picture("a", "png", picture, {8, {}, exif});
    bytes.replace(bytes.find("eXIf") + 4, exif.size(), exif); // whether or not a writer turns it
    put_contents(folder.file("a.png"), bytes);
    write_shown_picture(folder.file("depth.png"), depth);
    const LdiFile read = read_photograph(folder.file("a.png"), {.depth_file = folder.file("depth.png")});
    ASSERT_EQ(read.ldi.windows.width(), height);
    EXPECT_EQ(read.ldi.z[0],
              depth.at(0, 0, height - 1)); // the lower left corner is upright the upper left one
    EXPECT_EQ(read.ldi.z[1], depth.at(0, 0, height - 2));
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_NE(read.warnings[0].find("the depth is turned, too"), std::string::npos);
    write_shown_picture(folder.file("small.png"), Image(windows_of_size(8, 6), {{"R"}, {"G"}, {"B"}}));
    const LdiFile fitted = read_photograph(folder.file("a.png"), {.depth_file = folder.file("small.png")});
    ASSERT_EQ(fitted.warnings.size(), 1u);
    EXPECT_NE(fitted.warnings[0].find("the depth is turned, too"), std::string::npos);
}

// JPEG rounds greys. Larger differences between the channels are those of a colour map.
TEST_F(PhotographFiles, DepthMustBeGrey) {
    const std::string picture = shown("picture.png");
    const auto of_colours = [&](float off) {
        Image depth(windows_of_size(width, height), {{"R"}, {"G"}, {"B"}});
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (std::size_t k = 0; k < 3; ++k) depth.at(k, x, y) = disparity(x, y) + (k == 2 ? off : 0);
        write_shown_picture(folder.file("depth.png"), depth);
        return what_of<Error>([&] { depths(picture, folder.file("depth.png")); });
    };
    EXPECT_EQ(of_colours(0.02f), "(nothing was thrown)");
    for (const float off : {0.05f, 0.2f})
        EXPECT_NE(of_colours(off).find("depth.png: has colours, and depth must be grey"), std::string::npos)
            << off;
}

// Colours are multiplied by A as in any picture; a depth is not.
TEST_F(PhotographFiles, AlphaIsKeptAndDarkensNoDepth) {
    Image cut(windows_of_size(width, height), rgba_channels());
    for (int x = 0; x < width; ++x)
        for (int y = 0; y < height; ++y) {
            const float a = float(x) / float(width - 1);
            cut.at(3, x, y) = a;
            for (std::size_t k = 0; k < 3; ++k) cut.at(k, x, y) = a * float(16 * y + 50) / 255;
        }
    for (const char *name : {"cut.png", "cut.tif", "cut.tga"}) {
        SCOPED_TRACE(name);
        const std::string file = folder.file(name);
        write_shown_picture(file, cut);
        const LdiFile read = read_photograph(file, {.depth_file = file});
        const std::size_t alpha = find_channel(read.ldi.channels, "A");
        ASSERT_NE(alpha, npos);
        for (int y = 0; y < height; ++y)
            for (int x = 1; x < width; ++x) {
                const std::size_t i = cut.windows.index(Imath::V2i(x, y));
                ASSERT_NEAR(read.ldi.values[alpha][i], cut.at(3, x, y), 0.003);
                ASSERT_NEAR(read.ldi.values[0][i], cut.at(0, x, y), 0.006);
                ASSERT_NEAR(read.ldi.z[i], float(16 * y + 50) / 255, 0.02) << x;
            }
    }
    write_shown_picture(folder.file("opaque.png"), Image(cut.windows, {{"R"}, {"G"}, {"B"}}));
    const LdiFile opaque = read_photograph(folder.file("opaque.png"), {.depth_file = folder.file("cut.png")});
    EXPECT_EQ(find_channel(opaque.ldi.channels, "A"), npos);
}

TEST_F(PhotographFiles, FloatingPointColoursAreLinear) {
    const std::string depth = shown("depth.png");
    for (const char *name : {"a.hdr", "a.pfm", "a.png"}) {
        if (std::string(name) == "a.pfm")
            put_contents(folder.file(name), "PF\n16 12\n-1.0\n" + std::string(16 * 12 * 12, '\0'));
        else
            shown(name);
        const Imf::Header header = read_photograph(folder.file(name), {.depth_file = depth}).header;
        EXPECT_EQ(Imf::hasChromaticities(header), std::string(name) != "a.png") << name;
        EXPECT_EQ(extras_of(header).has_value(), std::string(name) == "a.png") << name;
    }
}

TEST_F(PhotographFiles, FlatPicturesMayBeLarge) {
    write_shown_picture(folder.file("flat.png"), Image(windows_of_size(4000, 2500), {{"R"}, {"G"}, {"B"}}));
    EXPECT_EQ(read_shown_picture(folder.file("flat.png")).image.windows.width(), 4000);
}

// A part of a file is no picture. The last bytes of a file may say nothing about its pixels.
TEST_F(PhotographFiles, HalfAFileIsRefused) {
    for (const char *name : {"a.jpg", "a.png", "a.tif", "a.webp", "a.bmp"}) {
        const std::string whole = contents_of(shown(name, windows_of_size(60, 40)));
        for (const double part : {0.2, 0.5, 0.9}) {
            put_contents(folder.file(name), whole.substr(0, std::size_t(part * double(whole.size()))));
            EXPECT_NE(what_of<Error>([&] { read_shown_picture(folder.file(name)); }).find("cannot read: "),
                      std::string::npos)
                << name << ' ' << part;
        }
    }
}

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

struct Repaired {
    std::vector<float> depths;
    std::vector<std::string> warnings;
    bool says(const char *text) const {
        return std::ranges::any_of(warnings,
                                   [&](const std::string &w) { return w.find(text) != std::string::npos; });
    }
};
Repaired repaired(std::vector<float> depths, std::optional<DisparityRange> range = {}) {
    Repaired result{std::move(depths), {}};
    repair_disparities(result.depths, "a", result.warnings, range);
    return result;
}

TEST(Disparities, AreScaledToTheirRange) {
    EXPECT_EQ(repaired({2, 3, 4, 6}).depths, (std::vector<float>{0, 0.25f, 0.5f, 1}));
    EXPECT_TRUE(repaired({2, 3, 4, 6}).says("goes from 2 to 6, and is scaled"));
    EXPECT_EQ(repaired({-1, -0.5f, 0, 0}).depths, (std::vector<float>{0, 0.5f, 1, 1})); // none above 1
    EXPECT_EQ(repaired({-3e38f, 0, 3e38f, 3e38f}).depths, (std::vector<float>{0, 0.5f, 1, 1}));
    EXPECT_EQ(repaired({0.25f, 0.5f, 1, 1}).depths, (std::vector<float>{0.25f, 0.5f, 1, 1}));
    EXPECT_TRUE(repaired({0.25f, 0.5f, 1, 1}).warnings.empty());
}

TEST(Disparities, OfASequenceHaveTheRangeOfItsFirstFrame) {
    EXPECT_EQ(repaired({2, 4, 6, 10}, DisparityRange{2, 6}).depths, (std::vector<float>{0, 0.5f, 1, 2}));
    EXPECT_TRUE(repaired({2, 4, 6, 10}, DisparityRange{2, 6}).warnings.empty());
    EXPECT_GT(repaired({-90, 4, 6, 10}, DisparityRange{2, 6}).depths[0], -1); // has a depth
}

TEST(Disparities, WhatIsNoNumberChangesNothingElse) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {nothing, infinity, -infinity}) {
        const Repaired found = repaired({bad, 2, 2, 3, 3, 4, 6, 6});
        EXPECT_TRUE(std::isnan(found.depths[0]));
        EXPECT_EQ(std::vector(found.depths.begin() + 1, found.depths.end()),
                  (std::vector<float>{0, 0, 0.25f, 0.25f, 0.5f, 1, 1}));
        EXPECT_FALSE(found.says("darker below")) << bad;
    }
    EXPECT_NE(what_of<Error>([] {
                  repaired({infinity, 1, 1, 1});
              }).find("the same everywhere"),
              std::string::npos);
}

TEST(Disparities, WhiteMustBeNear) {
    EXPECT_TRUE(repaired({1, 0.5f, 0.5f, 0}).says("darker below than above"));
    EXPECT_TRUE(repaired({0.7f, 1, 0, 0.3f}).says("darker below than above"));  // by .4 of the range
    EXPECT_FALSE(repaired({0.6f, 1, 0, 0.4f}).says("darker below than above")); // by .2
    EXPECT_FALSE(repaired({0, 0.5f, 0.5f, 1}).says("darker below than above"));
}

// A large thing at the border and a small one in front of it are nearer; the ground behind it is larger.
TEST(UsualFocus, IsOnTheNearestLargeThingNearTheMiddle) {
    for (const Imath::V2i &corner : {Imath::V2i(0, 0), Imath::V2i(100, -50)}) {
        const Imath::Box2i display(corner, corner + Imath::V2i(63, 47));
        Image picture({display, {display.min - Imath::V2i(20, 0), display.max}, 1},
                      {{"Z", PixelType::float32}});
        const auto fill = [&](Imath::V2i from, Imath::V2i to, double disparity) {
            for (int y = corner.y + from.y; y <= corner.y + to.y; ++y)
                for (int x = corner.x + from.x; x <= corner.x + to.x; ++x)
                    picture.at(0, x, y) = float(depth_of_disparity(disparity + 0.002 * (x - corner.x) / 64));
        };
        fill({-20, 0}, {63, 47}, 0.1);
        fill({-20, 0}, {14, 47}, 0.9);
        fill({34, 14}, {45, 40}, 0.7);
        fill({38, 20}, {40, 22}, 1);
        const auto focus = usual_focus(ldi_of_flat(picture, "Z"));
        ASSERT_TRUE(focus);
        EXPECT_NEAR(disparity_of_depth(focus->depth), 0.7, 0.01);
        EXPECT_EQ(float(focus->depth), picture.at(0, focus->pixel.x, focus->pixel.y));
        EXPECT_LT((focus->pixel - corner - Imath::V2i(40, 24)).length2(), 64);
    }
    Ldi empty;
    empty.windows = windows_of_size(8, 8);
    empty.begin.resize(65);
    EXPECT_FALSE(usual_focus(empty));
}

TEST(Disparities, LittleOfTheRangeIsTold) {
    EXPECT_TRUE(repaired({0, 0.01f, 0.02f, 0.03f}).says("goes from 0 to 0.03 of 0 to 1 only"));
    EXPECT_FALSE(repaired({0.5f, 0.6f, 0.7f, 0.8f}).says("only"));
}

} // namespace
} // namespace sparselens
