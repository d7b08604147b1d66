// Colours stored as luminance and chroma, written by OpenEXR, and as a renderer would write them beside a depth.
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/exr/luminance_chroma.h"
#include "support/scratch_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
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

// Colours that change from pixel to pixel, some of them saturated, in a window that does not begin at 0.
void write_by_openexr(const std::string &path, const Imath::Box2i &data,
                      const Imf::Chromaticities *primaries) {
    const Grid grid(data);
    std::vector<Imf::Rgba> pixels;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Imath::V2i at = grid.pixel(i);
        pixels.emplace_back(0.25f + 0.01f * float(at.x & 15), 0.5f,
                            at.x % 7 == 3 ? 0.0f : 0.7f + 0.1f * float(at.y & 1), 1.0f);
    }
    Imf::Header header(data, data);
    if (primaries) Imf::addChromaticities(header, *primaries);
    Imf::RgbaOutputFile file(path.c_str(), header, Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data() - data.min.x - data.min.y * grid.width(), 1, std::size_t(grid.width()));
    file.writePixels(grid.height());
}

// Equals OpenEXR's own reader of such files, to the bit.
TEST_F(LuminanceChroma, OfOpenExrIsReadAsItsReaderReadsIt) {
    const Imf::Chromaticities aces({0.713f, 0.293f}, {0.165f, 0.83f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});
    for (const Imath::Box2i &data :
         {Imath::Box2i({0, 0}, {31, 15}), Imath::Box2i({-6, 4}, {35, 49}), Imath::Box2i({2, 2}, {3, 3})})
        for (const Imf::Chromaticities *primaries :
             {static_cast<const Imf::Chromaticities *>(nullptr), &aces}) {
            write_by_openexr(path, data, primaries);
            const Grid grid(data);
            std::vector<Imf::Rgba> expected(grid.size());
            Imf::RgbaInputFile file(path.c_str());
            file.setFrameBuffer(expected.data() - data.min.x - data.min.y * grid.width(), 1,
                                std::size_t(grid.width()));
            file.readPixels(data.min.y, data.max.y);
            const Image image = read_flat_exr(path).image;
            ASSERT_EQ(image.channels, (std::vector<Channel>{{"R"}, {"G"}, {"B"}}));
            for (std::size_t i = 0; i < grid.size(); ++i) {
                const Imath::V2i at = grid.pixel(i);
                ASSERT_EQ(image.at(0, at.x, at.y), float(expected[i].r)) << at;
                ASSERT_EQ(image.at(1, at.x, at.y), float(expected[i].g)) << at;
                ASSERT_EQ(image.at(2, at.x, at.y), float(expected[i].b)) << at;
            }
        }
}

// Y, RY, BY of one colour (Rec. 709) and A, with Z in the same part or in an earlier one.
TEST_F(LuminanceChroma, KeepsTheOtherChannels) {
    const std::array<float, 3> rgb{0.5f, 0.25f, 0.125f};
    const float luminance = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
    std::vector<half> y(width * height, half(luminance)), a(width * height, half(0.5f)),
        ry(width * height / 4, half((rgb[0] - luminance) / luminance)),
        by(width * height / 4, half((rgb[2] - luminance) / luminance));
    std::vector<float> z(width * height);
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = float(i + 1);
    for (const std::size_t parts : {1u, 2u}) {
        std::vector<Imf::Header> headers(parts, Imf::Header(width, height));
        std::vector<Imf::FrameBuffer> pixels(parts);
        for (std::size_t part = 0; part < parts; ++part) {
            headers[part].setName(part + 1 == parts ? "beauty" : "depth");
            headers[part].setType(Imf::SCANLINEIMAGE);
        }
        const auto add = [&](std::size_t part, const char *name, Imf::PixelType type, auto &values,
                             int sampling) {
            headers[part].channels().insert(name, Imf::Channel(type, sampling, sampling));
            const std::size_t size = sizeof values[0];
            pixels[part].insert(name, Imf::Slice(type, reinterpret_cast<char *>(values.data()), size,
                                                 size * std::size_t(width / sampling), sampling, sampling));
        };
        add(0, "Z", Imf::FLOAT, z, 1);
        add(parts - 1, "Y", Imf::HALF, y, 1);
        add(parts - 1, "RY", Imf::HALF, ry, 2);
        add(parts - 1, "BY", Imf::HALF, by, 2);
        add(parts - 1, "A", Imf::HALF, a, 1);
        {
            Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(parts));
            for (std::size_t part = 0; part < parts; ++part) {
                Imf::OutputPart output(file, int(part));
                output.setFrameBuffer(pixels[part]);
                output.writePixels(height);
            }
        }
        const Ldi ldi = read_ldi(path).ldi; // a flat file with depth
        ASSERT_EQ(ldi.channels, rgba_channels());
        for (std::size_t i = 0; i < ldi.samples(); ++i) {
            EXPECT_EQ(ldi.z[i], z[i]);
            EXPECT_EQ(ldi.values[3][i], 0.5f);
            for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(ldi.values[k][i], rgb[k], 2e-3) << i;
        }
    }
}

} // namespace
} // namespace sparselens
