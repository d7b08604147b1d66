#include "base/error.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepImageStateAttribute.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfDeepTiledOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <cmath>

namespace sparselens {
namespace {

class ExrDeep : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("deep.exr");

    LdiFile round_trip(const Ldi &ldi) {
        write_ldi(path, ldi, Imf::Header());
        return read_ldi(path);
    }
};

float as_half(float value) { return float(Imath::half(value)); }

// The LDI with colours, offsets and weights rounded to half.
Ldi rounded(Ldi ldi) {
    for (std::vector<float> *values : {&ldi.dx, &ldi.dy, &ldi.weight})
        for (float &value : *values) value = as_half(value);
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        if (ldi.channels[k].type == PixelType::half)
            for (float &value : ldi.values[k]) value = as_half(value);
    return ldi;
}

void expect_equal(const Ldi &a, const Ldi &b) {
    EXPECT_EQ(a.windows, b.windows);
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.begin, b.begin);
    EXPECT_EQ(a.z, b.z);
    EXPECT_EQ(a.z_back, b.z_back);
    EXPECT_EQ(a.dx, b.dx);
    EXPECT_EQ(a.dy, b.dy);
    EXPECT_EQ(a.weight, b.weight);
    EXPECT_EQ(a.image_z, b.image_z);
    EXPECT_EQ(a.solid, b.solid);
    EXPECT_EQ(a.values, b.values);
}

TEST_F(ExrDeep, SamplesComeBack) {
    for (const double volumes : {0.0, 0.5}) {
        const Ldi ldi = random_ldi({.width = 40, .height = 300, .volume_share = volumes, .shuffled = true});
        const LdiFile read = round_trip(ldi);
        EXPECT_TRUE(read.deep);
        expect_equal(read.ldi, rounded(ldi));
    }
}

TEST_F(ExrDeep, NegativeOriginsAndDataWindowsApartFromTheDisplay) {
    Ldi ldi = random_ldi({.width = 7, .height = 5});
    ldi.windows = {Imath::Box2i({-100, -50}, {-1, -1}), Imath::Box2i({-3, 40}, {3, 44}), 0.5f};
    expect_equal(round_trip(ldi).ldi, rounded(ldi));
}

TEST_F(ExrDeep, EmptyPixelsEmptyRowsAndAPictureOfNothing) {
    Ldi ldi = ldi_of({{}, {{.z = 2}}, {}, {{.z = 1}, {.z = 3}}, {}, {}});
    ldi.windows = windows_of_size(2, 3);
    expect_equal(round_trip(ldi).ldi, rounded(ldi));
    const Ldi nothing = ldi_of(std::vector<TestPixel>(12));
    expect_equal(round_trip(nothing).ldi, nothing);
    EXPECT_EQ(round_trip(nothing).ldi.samples(), 0u);
}

TEST_F(ExrDeep, OnePixelAndTwoHundredSamplesInIt) {
    TestPixel many;
    for (int i = 0; i < 200; ++i)
        many.push_back({.z = 1 + float(i) / 16, .colour = float(i), .alpha = 0.01f});
    for (const TestPixel &pixel : {TestPixel{}, TestPixel{{.z = 5}}, many})
        expect_equal(round_trip(ldi_of({pixel})).ldi, rounded(ldi_of({pixel})));
}

TEST_F(ExrDeep, WithoutOffsetsAndWeightsThereAreNone) {
    Ldi ldi = ldi_of({{{.z = 2}}});
    ldi.dx = ldi.dy = ldi.weight = {};
    const LdiFile read = round_trip(ldi);
    expect_equal(read.ldi, ldi);
    EXPECT_EQ(read.header.channels().findChannel("ldi.dx"), nullptr);
    EXPECT_EQ(read.header.channels().findChannel("ldi.optical"), nullptr);
}

TEST_F(ExrDeep, DepthsOfImagesAreFloats) {
    Ldi ldi = ldi_of({{{.z = 2}}, {{.z = 2}, {.z = 3}}});
    ldi.image_z = {1234.567f, -8.001f, INFINITY};
    const LdiFile read = round_trip(ldi);
    expect_equal(read.ldi, ldi);
    ASSERT_NE(read.header.channels().findChannel("ldi.optical"), nullptr);
    EXPECT_EQ(read.header.channels().findChannel("ldi.optical")->type, Imf::FLOAT);
}

TEST_F(ExrDeep, WhatIsSolidIsHalves) {
    Ldi ldi = ldi_of({{{.z = 2}}, {{.z = 2}, {.z = 3}}});
    EXPECT_EQ(round_trip(ldi).header.channels().findChannel("ldi.solid"), nullptr);
    ldi.solid = {0.25f, 0, 6e4f};
    const LdiFile read = round_trip(ldi);
    expect_equal(read.ldi, ldi);
    ASSERT_NE(read.header.channels().findChannel("ldi.solid"), nullptr);
    EXPECT_EQ(read.header.channels().findChannel("ldi.solid")->type, Imf::HALF);
}

TEST_F(ExrDeep, ChannelsOfEveryTypeAreCarried) {
    Ldi ldi = ldi_of({{{.z = 2}, {.z = 3}}, {{.z = INFINITY}}});
    ldi.channels.insert(ldi.channels.end(), {{"N.x", PixelType::float32, ChannelKind::data},
                                             {"crypto.id", PixelType::uint32},
                                             {"light.R", PixelType::half}});
    ldi.values.insert(ldi.values.end(), 3, {1e3f, 0.1f, -3});
    for (const std::uint32_t id : {0xffffffffu, 0x7f800001u, 1u}) // the second is a signalling NaN
        ldi.values[5][id % 3] = std::bit_cast<float>(id);
    const Ldi read = round_trip(ldi).ldi;
    EXPECT_EQ(read.channels, ldi.channels);
    EXPECT_EQ(read.values[4], ldi.values[4]);
    EXPECT_EQ(read.values[6], rounded(ldi).values[6]);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(read.values[5][i]),
                  std::bit_cast<std::uint32_t>(ldi.values[5][i]));
}

TEST_F(ExrDeep, DepthsAreFloatsAndColoursClampToTheLargestHalf) {
    Ldi ldi = ldi_of({{{.z = 1e-30f, .colour = 1e6f}, {.z = 3.0000002f, .colour = -1e6f}, {.z = INFINITY}}});
    const Ldi read = round_trip(ldi).ldi;
    EXPECT_EQ(read.z, ldi.z);
    EXPECT_EQ(read.values[0][0], 65504);
    EXPECT_EQ(read.values[0][1], -65504);
}

// deepImageState is read and not written, because OpenEXR's module for Python opens no file that has it.
TEST_F(ExrDeep, IsAScanlineFileThatDoesNotStateTheOrderOfSamples) {
    Imf::Header metadata;
    metadata.insert("comments", Imf::StringAttribute("kept"));
    metadata.setType(Imf::DEEPTILE);
    metadata.setTileDescription(Imf::TileDescription(32, 32));
    metadata.compression() = Imf::NO_COMPRESSION;
    Imf::addDeepImageState(metadata, Imf::DIS_MESSY);
    write_ldi(path, ldi_of({{{.z = 1}}}), metadata);
    const Imf::Header header = read_ldi(path).header;
    EXPECT_EQ(header.type(), Imf::DEEPSCANLINE);
    EXPECT_EQ(header.compression(), Imf::NO_COMPRESSION);
    EXPECT_FALSE(Imf::hasDeepImageState(header));
    EXPECT_FALSE(header.hasTileDescription());
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("comments").value(), "kept");
}

// The channels of an LDI as in another program's deep file, as pointers for the frame buffer of `Writer`.
struct ForeignDeep {
    Imf::Header header;
    std::vector<unsigned> counts;
    std::vector<std::vector<char *>> pointers;
    Imf::DeepFrameBuffer buffer;

    ForeignDeep(Ldi &ldi, const std::string &depth_name) : header(ldi.windows.display, ldi.windows.data) {
        const std::size_t width = std::size_t(ldi.windows.width());
        for (std::size_t i = 0; i + 1 < ldi.begin.size(); ++i)
            counts.push_back(unsigned(ldi.pixel(i).size()));
        buffer.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts.data(), ldi.windows.data,
                                                       sizeof(unsigned), sizeof(unsigned) * width));
        pointers.reserve(ldi.channels.size() + 1);
        const auto add = [&](const std::string &name, std::vector<float> &values) {
            std::vector<char *> &to = pointers.emplace_back();
            for (std::size_t i = 0; i + 1 < ldi.begin.size(); ++i)
                to.push_back(reinterpret_cast<char *>(values.data() + ldi.begin[i]));
            const Imf::Slice base = Imf::Slice::Make(Imf::FLOAT, to.data(), ldi.windows.data, sizeof(char *),
                                                     sizeof(char *) * width);
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            buffer.insert(name,
                          Imf::DeepSlice(Imf::FLOAT, base.base, base.xStride, base.yStride, sizeof(float)));
        };
        add(depth_name, ldi.z);
        for (std::size_t k = 0; k < ldi.channels.size(); ++k) add(ldi.channels[k].name, ldi.values[k]);
        header.compression() = Imf::ZIPS_COMPRESSION;
    }
};

Ldi third_party(int width, int height) {
    Ldi ldi = random_ldi({.width = width, .height = height, .shuffled = true});
    ldi.windows.data.min += Imath::V2i(-9, 4);
    ldi.windows.data.max += Imath::V2i(-9, 4);
    ldi.dx = ldi.dy = ldi.weight = {};
    for (Channel &channel : ldi.channels) channel.type = PixelType::float32;
    return ldi;
}

// Only the full size of a mipmap is read; its reduced levels, which have other sample counts here, are ignored.
TEST_F(ExrDeep, OfMipmapsTheFullSizeIsRead) {
    Ldi ldi = third_party(50, 37);
    ForeignDeep foreign(ldi, "Z");
    foreign.header.setType(Imf::DEEPTILE);
    foreign.header.setTileDescription(Imf::TileDescription(16, 8, Imf::MIPMAP_LEVELS));
    {
        Imf::DeepTiledOutputFile file(path.c_str(), foreign.header);
        for (int level = 0; level < file.numLevels(); ++level) {
            file.setFrameBuffer(foreign.buffer); // its corner, for the smaller levels
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    }
    expect_equal(read_ldi(path).ldi, ldi);
}

TEST_F(ExrDeep, TiledFilesAndFilesThatStateTheirOrderAreRead) {
    Ldi ldi = third_party(50, 37);
    ForeignDeep foreign(ldi, "Z");
    foreign.header.setType(Imf::DEEPTILE);
    foreign.header.setTileDescription(Imf::TileDescription(16, 8));
    Imf::addDeepImageState(foreign.header, Imf::DIS_MESSY);
    {
        Imf::DeepTiledOutputFile file(path.c_str(), foreign.header);
        file.setFrameBuffer(foreign.buffer);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    expect_equal(read_ldi(path).ldi, ldi);
}

// First a flat part, then a deep one: the deep one is read.
TEST_F(ExrDeep, TheDeepPartIsTheOneThatIsRead) {
    Ldi ldi = third_party(20, 10);
    ForeignDeep foreign(ldi, "depth.Z");
    foreign.header.setType(Imf::DEEPSCANLINE);
    foreign.header.setName("layers");
    Imf::Header flat(ldi.windows.display, ldi.windows.data);
    flat.setType(Imf::SCANLINEIMAGE);
    flat.setName("beauty");
    flat.channels().insert("R", Imf::Channel(Imf::HALF));
    std::vector<half> values(200, half(0.25f));
    {
        const Imf::Header headers[] = {flat, foreign.header};
        Imf::MultiPartOutputFile file(path.c_str(), headers, 2);
        Imf::OutputPart beauty(file, 0);
        Imf::FrameBuffer pixels;
        pixels.insert("R", Imf::Slice::Make(Imf::HALF, values.data(), ldi.windows.data, sizeof(half),
                                            20 * sizeof(half)));
        beauty.setFrameBuffer(pixels);
        beauty.writePixels(10);
        Imf::DeepScanLineOutputPart layers(file, 1);
        layers.setFrameBuffer(foreign.buffer);
        layers.writePixels(10);
    }
    expect_equal(read_ldi(path).ldi, ldi);
    EXPECT_EQ(read_flat_exr(path).image.at(0, -9, 4), 0.25f); // a flat reader gets the flat part
    EXPECT_THROW(read_ldi(path, {.depth = "Z"}), Error);
}

TEST_F(ExrDeep, ADeepFileIsNoFlatPicture) {
    write_ldi(path, ldi_of({{{.z = 1}}}), Imf::Header());
    EXPECT_EQ(
        what_of<Error>([&] { read_flat_exr(path); }),
        path + ": contains deep samples but no flat picture; flatten it first (dof-gather --lens-radius 0)");
}

TEST_F(ExrDeep, AFlatPictureIsReadAsOneSampleAPixel) {
    Image image({Imath::Box2i({0, 0}, {9, 9}), Imath::Box2i({-1, 2}, {0, 3})},
                {{"R"}, {"A"}, {"Z", PixelType::float32}, {"id", PixelType::uint32}});
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = float(i);
    write_flat_exr(path, image, Imf::Header());
    const LdiFile read = read_ldi(path);
    EXPECT_FALSE(read.deep);
    EXPECT_EQ(read.ldi.windows, image.windows);
    EXPECT_EQ(read.ldi.begin, (std::vector<std::uint64_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(read.ldi.z, (std::vector<float>{8, 9, 10, 11}));
    EXPECT_EQ(read.ldi.channels, (std::vector<Channel>{{"R"}, {"A"}, {"id", PixelType::uint32}}));
    EXPECT_EQ(read.ldi.values[2], (std::vector<float>{12, 13, 14, 15}));
    EXPECT_TRUE(read.ldi.dx.empty() && read.ldi.weight.empty() && read.ldi.z_back.empty());
}

TEST_F(ExrDeep, TheDepthChannelIsFoundOrAskedFor) {
    Ldi ldi = third_party(4, 4);
    ldi.channels.push_back({"Z", PixelType::float32});
    ldi.values.push_back(ldi.values[0]);
    ForeignDeep foreign(ldi, "depth.Z");
    foreign.header.setType(Imf::DEEPSCANLINE);
    {
        Imf::MultiPartOutputFile file(path.c_str(), &foreign.header, 1);
        Imf::DeepScanLineOutputPart part(file, 0);
        part.setFrameBuffer(foreign.buffer);
        part.writePixels(4);
    }
    EXPECT_EQ(read_ldi(path).ldi.z, ldi.values[0]);
    const Ldi other = read_ldi(path, {.depth = "depth.Z"}).ldi;
    EXPECT_EQ(other.z, ldi.z);
    EXPECT_EQ(find_channel(other.channels, "Z"), npos); // two depths would share one name
    EXPECT_TRUE(what_of<Error>([&] {
                    read_ldi(path, {.depth = "N"});
                }).starts_with(path + ": has no channel N (`depth_channel`); its channels are "));
    expect_equal(round_trip(other).ldi, rounded(other));
}

TEST_F(ExrDeep, ErrorsNameTheFile) {
    const auto read = [&] { read_ldi(path); };
    EXPECT_EQ(what_of<Error>(read), path + ": cannot open: No such file or directory");
    write_ldi(path, random_ldi({.width = 64, .height = 40}), Imf::Header());
    const std::string whole = contents_of(path);
    for (std::size_t size = 0; size < whole.size(); size += 797) {
        put_contents(path, whole.substr(0, size));
        EXPECT_NE(what_of<Error>(read).find(path), std::string::npos) << size;
    }
    EXPECT_THROW(write_ldi(path + "/out.exr", ldi_of({{}}), Imf::Header()), Error); // the file is no folder
    EXPECT_EQ(folder.entries(), 1u);
}

} // namespace
} // namespace sparselens
