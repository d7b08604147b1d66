// Colours stored as luminance and chroma, as OpenEXR writes them and as a renderer would beside a depth.
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/exr/luminance_chroma.h"
#include "support/scratch_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace sparselens {
namespace {

constexpr int width = 32, height = 16;

class LuminanceChroma : public ::testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("yc.exr");
};

TEST_F(LuminanceChroma, OfOpenExrIsReadAsColours) {
    std::vector<Imf::Rgba> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) // smooth, since chroma has half of the resolution
            pixels.emplace_back(0.25f + 0.01f * float(x), 0.5f, 0.75f - 0.02f * float(y), 1.0f);
    {
        Imf::RgbaOutputFile file(path.c_str(), width, height, Imf::WRITE_YC);
        file.setFrameBuffer(pixels.data(), 1, width);
        file.writePixels(height);
    }
    const Image image = read_flat_exr(path).image;
    ASSERT_EQ(image.channels, (std::vector<Channel>{{"R"}, {"G"}, {"B"}}));
    for (int y = 2; y < height - 2; ++y)
        for (int x = 2; x < width - 2; ++x) {
            const Imf::Rgba &pixel = pixels[std::size_t(y * width + x)];
            EXPECT_NEAR(image.at(0, x, y), float(pixel.r), 0.01) << x << " " << y;
            EXPECT_NEAR(image.at(1, x, y), float(pixel.g), 0.01) << x << " " << y;
            EXPECT_NEAR(image.at(2, x, y), float(pixel.b), 0.01) << x << " " << y;
        }
}

// Y, RY, BY of one colour (Rec. 709), with A and Z in all pixels.
TEST_F(LuminanceChroma, KeepsTheOtherChannels) {
    const std::array<float, 3> rgb{0.5f, 0.25f, 0.125f};
    const float luminance = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
    std::vector<half> y(width * height, half(luminance)), a(width * height, half(0.5f)),
        ry(width * height / 4, half((rgb[0] - luminance) / luminance)),
        by(width * height / 4, half((rgb[2] - luminance) / luminance));
    std::vector<float> z(width * height);
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = float(i + 1);
    {
        Imf::Header header(width, height);
        Imf::FrameBuffer pixels;
        const auto add = [&](const char *name, Imf::PixelType type, auto &values, int sampling) {
            header.channels().insert(name, Imf::Channel(type, sampling, sampling));
            const std::size_t size = sizeof values[0];
            pixels.insert(name, Imf::Slice(type, reinterpret_cast<char *>(values.data()), size,
                                           size * std::size_t(width / sampling), sampling, sampling));
        };
        add("Y", Imf::HALF, y, 1);
        add("RY", Imf::HALF, ry, 2);
        add("BY", Imf::HALF, by, 2);
        add("A", Imf::HALF, a, 1);
        add("Z", Imf::FLOAT, z, 1);
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(pixels);
        file.writePixels(height);
    }
    const Ldi ldi = read_ldi(path).ldi; // a flat file with depth
    ASSERT_EQ(ldi.channels, rgba_channels());
    for (std::size_t i = 0; i < ldi.samples(); ++i) {
        EXPECT_EQ(ldi.z[i], z[i]);
        EXPECT_EQ(ldi.values[3][i], 0.5f);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(ldi.values[k][i], rgb[k], 2e-3) << i;
    }
}

} // namespace
} // namespace sparselens
