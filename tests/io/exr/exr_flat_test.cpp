#include "base/error.h"
#include "io/exr/compression.h"
#include "io/exr/exr_flat.h"
#include "support/scratch_folder.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

class ExrFlat : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("picture.exr");

    Image round_trip(const Image &image) {
        write_flat_exr(path, image, Imf::Header());
        return read_flat_exr(path).image;
    }
};

Image one_pixel(PixelType type, float value) {
    Image image(windows_of_size(1, 1), {{"X", type}});
    image.values[0] = value;
    return image;
}

TEST_F(ExrFlat, WindowsChannelsAndValuesComeBack) {
    Image image({Imath::Box2i({-10, -20}, {30, 40}), Imath::Box2i({-15, 3}, {2, 9}), 2},
                {{"R"},
                 {"G"},
                 {"B"},
                 {"A"},
                 {"N.x", PixelType::float32, ChannelKind::data},
                 {"diffuse.R"},
                 {"id", PixelType::uint32}});
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = float(i % 2048);
    const Image read = round_trip(image);
    EXPECT_EQ(read.windows, image.windows);
    EXPECT_EQ(read.channels, image.channels);
    EXPECT_EQ(read.values, image.values);
}

// R, G, B, A come first, although the file's order is alphabetical.
TEST_F(ExrFlat, ColourLeadsThenTheAlphabet) {
    const Image read =
        round_trip(Image(windows_of_size(1, 1), {{"Z", PixelType::float32}, {"G"}, {"a"}, {"R"}, {"A"}}));
    std::string names;
    for (const Channel &channel : read.channels) names += channel.name;
    EXPECT_EQ(names, "RGAZa");
}

TEST_F(ExrFlat, FloatsAndIdsKeepEveryBit) {
    for (const float value : {0.0f, -0.0f, 1e-45f, 0.1f, 65505.0f, 3e38f, inf, -inf, std::nanf("5")})
        EXPECT_EQ(std::bit_cast<std::uint32_t>(round_trip(one_pixel(PixelType::float32, value)).values[0]),
                  std::bit_cast<std::uint32_t>(value))
            << value;
    for (const std::uint32_t id : {0u, 1u, 0x7f800001u, 0x80000000u, 0xffffffffu}) // some are signalling NaNs
        EXPECT_EQ(std::bit_cast<std::uint32_t>(
                      round_trip(one_pixel(PixelType::uint32, std::bit_cast<float>(id))).values[0]),
                  id);
}

TEST_F(ExrFlat, HalvesAreRoundedToTheNearest) {
    EXPECT_EQ(round_trip(one_pixel(PixelType::half, 0.1f)).values[0], float(Imath::half(0.1f)));
    EXPECT_EQ(round_trip(one_pixel(PixelType::half, 1 + 0x1p-11f)).values[0], 1); // to even
    EXPECT_EQ(round_trip(one_pixel(PixelType::half, 1 + 0x1.8p-11f)).values[0], 1 + 0x1p-10f);
}

TEST_F(ExrFlat, WhatHalfCannotHoldBecomesItsLargest) {
    for (const float large : {65504.0f, 65505.0f, 65520.0f, 1e30f}) {
        EXPECT_EQ(round_trip(one_pixel(PixelType::half, large)).values[0], 65504);
        EXPECT_EQ(round_trip(one_pixel(PixelType::half, -large)).values[0], -65504);
    }
    EXPECT_EQ(round_trip(one_pixel(PixelType::half, inf)).values[0], inf); // infinite, not overflowed
    EXPECT_TRUE(std::isnan(round_trip(one_pixel(PixelType::half, std::nanf(""))).values[0]));
}

TEST_F(ExrFlat, WhatHalfCannotHoldIsCounted) {
    const auto clamped = [&](float value, PixelType type = PixelType::half) {
        return write_flat_exr(folder.file("x.exr"), one_pixel(type, value), Imf::Header());
    };
    for (const float fits : {0.0f, -65504.0f, 65519.0f, inf, std::nanf("")})
        EXPECT_EQ(clamped(fits), 0u) << fits;
    for (const float large : {65520.0f, -1e30f}) {
        EXPECT_EQ(clamped(large), 1u) << large;
        EXPECT_EQ(clamped(large, PixelType::float32), 0u) << large;
    }
}

TEST_F(ExrFlat, MetadataIsKeptExceptWhatDescribesThePixels) {
    Imf::Header header;
    header.insert("comments", Imf::StringAttribute("a comment"));
    header.insert("shot:number", Imf::IntAttribute(7));
    header.screenWindowWidth() = 3;
    header.compression() = Imf::PIZ_COMPRESSION;
    header.channels().insert("gone", Imf::Channel(Imf::HALF));
    const std::vector<std::string> of_pixels{"oiio:SHA-1", "oiio:AverageColor", "oiio:ConstantColor",
                                             "textureformat", "wrapmodes"};
    for (const std::string &name : of_pixels) header.insert(name, Imf::StringAttribute("of the pixels"));
    write_flat_exr(path, one_pixel(PixelType::half, 1), header);
    const Imf::Header read = read_flat_header(path);
    EXPECT_EQ(read.typedAttribute<Imf::StringAttribute>("comments").value(), "a comment");
    EXPECT_EQ(read.typedAttribute<Imf::IntAttribute>("shot:number").value(), 7);
    EXPECT_EQ(read.screenWindowWidth(), 3);
    EXPECT_EQ(read.compression(), Imf::PIZ_COMPRESSION);
    EXPECT_EQ(read.channels().findChannel("gone"), nullptr);
    for (const std::string &name : of_pixels) EXPECT_EQ(read.find(name), read.end()) << name;
    EXPECT_EQ(read.displayWindow(), Imath::Box2i({0, 0}, {0, 0}));
}

TEST_F(ExrFlat, TiledFilesAreRead) {
    Imf::Header header(Imath::Box2i({0, 0}, {39, 29}), Imath::Box2i({-3, 5}, {36, 24}));
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.setTileDescription(Imf::TileDescription(16, 8));
    std::vector<half> values(40 * 20);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i);
    {
        Imf::TiledOutputFile file(path.c_str(), header);
        Imf::FrameBuffer pixels;
        pixels.insert("R", Imf::Slice::Make(Imf::HALF, values.data(), header.dataWindow(), sizeof(half),
                                            40 * sizeof(half)));
        file.setFrameBuffer(pixels);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    const Image image = read_flat_exr(path).image;
    ASSERT_EQ(image.values.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(image.values[i], float(values[i]));
    EXPECT_EQ(image.at(0, -3, 5), 0);
    EXPECT_EQ(image.at(0, -2, 6), 41);
}

// Tolerances after compression for halves and floats of a smooth picture in [0, 1].
struct Compression {
    const char *name;
    Imf::Compression how;
    float half_error, float_error;
};

class Compressions : public ExrFlat, public testing::WithParamInterface<Compression> {};

TEST_P(Compressions, AreReadScanlinesAndTilesHalvesFloatsAndIds) {
    constexpr int width = 70, height = 45; // not a multiple of any block
    constexpr std::size_t pixels = std::size_t(width) * height;
    std::vector<half> halves(pixels);
    std::vector<float> floats(pixels);
    std::vector<std::uint32_t> ids(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        floats[i] = 0.5f + 0.25f * std::sin(float(i % width) / 9) + 0.25f * std::cos(float(i / width) / 7);
        halves[i] = floats[i];
        ids[i] = std::uint32_t(i) * 2654435761u; // uses all bits; some are NaNs
    }
    for (const bool tiled : {false, true}) {
        Imf::Header header(width, height);
        header.compression() = GetParam().how;
        if (tiled) header.setTileDescription(Imf::TileDescription(32, 16));
        Imf::FrameBuffer buffer;
        const auto add = [&](const char *name, Imf::PixelType type, auto &values) {
            header.channels().insert(name, Imf::Channel(type));
            constexpr std::size_t bytes = sizeof(values[0]);
            buffer.insert(name,
                          Imf::Slice::Make(type, values.data(), header.dataWindow(), bytes, bytes * width));
        };
        add("R", Imf::HALF, halves);
        add("Z", Imf::FLOAT, floats);
        add("id", Imf::UINT, ids);
        if (tiled) {
            Imf::TiledOutputFile file(path.c_str(), header);
            file.setFrameBuffer(buffer);
            file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
        } else {
            Imf::OutputFile file(path.c_str(), header);
            file.setFrameBuffer(buffer);
            file.writePixels(height);
        }
        const Image image = read_flat_exr(path).image;
        ASSERT_EQ(image.channels, (std::vector<Channel>{{"R", PixelType::half},
                                                        {"Z", PixelType::float32, ChannelKind::data},
                                                        {"id", PixelType::uint32}}));
        for (std::size_t i = 0; i < pixels; ++i) {
            ASSERT_NEAR(image.plane(0)[i], float(halves[i]), GetParam().half_error) << tiled << " " << i;
            ASSERT_NEAR(image.plane(1)[i], floats[i], GetParam().float_error) << tiled << " " << i;
            ASSERT_EQ(std::bit_cast<std::uint32_t>(image.plane(2)[i]), ids[i]) << tiled << " " << i;
        }
    }
}

// All that this version of OpenEXR has. PXR24 rounds floats to 24 bits; B44 compresses halves in blocks of 4x4; DWA
// removes invisible detail of halves and of colours in float.
std::vector<Compression> all_compressions() {
    std::vector<Compression> all;
    for (const NamedCompression &method : compressions()) {
        const std::string name = method.name;
        const float half_error = name.starts_with("b44") ? 0.02f : name.starts_with("dwa") ? 0.03f : 0;
        all.push_back({method.name, method.value, half_error, name == "pxr24" ? 0x1p-16f : 0});
    }
    return all;
}
INSTANTIATE_TEST_SUITE_P(ExrFlat, Compressions, testing::ValuesIn(all_compressions()),
                         [](const auto &compression) { return std::string(compression.param.name); });

TEST_F(ExrFlat, LuminanceAndChromaAreAnErrorThatSaysWhatToDo) {
    {
        const std::vector<Imf::Rgba> pixels(16);
        Imf::RgbaOutputFile file(path.c_str(), Imf::Header(4, 4), Imf::WRITE_YCA);
        file.setFrameBuffer(pixels.data(), 1, 4);
        file.writePixels(4);
    }
    const std::string expected =
        path +
        ": channel BY is subsampled, as in colours stored as luminance and chroma (Y, RY, BY): render R, G "
        "and B, or convert what needs no depth (from oiiotool 2.5.8 on: oiiotool --oiioattrib openexr:core 0 "
        "IN -o OUT.exr)";
    EXPECT_EQ(what_of<Error>([&] { read_flat_exr(path); }), expected);
    EXPECT_EQ(what_of<Error>([&] { read_flat_header(path); }), expected);
}

TEST_F(ExrFlat, ChannelsSubsampledInOneDirectionAreAnErrorThatNamesThem) {
    for (const auto &[across, down] : {std::pair(2, 1), std::pair(1, 2)}) {
        Imf::Header header(4, 4);
        header.channels().insert("u", Imf::Channel(Imf::HALF, across, down));
        std::vector<half> values(8, half(0.0f));
        {
            Imf::OutputFile file(path.c_str(), header);
            Imf::FrameBuffer pixels;
            pixels.insert("u", Imf::Slice(Imf::HALF, reinterpret_cast<char *>(values.data()), sizeof(half),
                                          sizeof(half) * std::size_t(4 / across), across, down));
            file.setFrameBuffer(pixels);
            file.writePixels(4);
        }
        EXPECT_TRUE(
            what_of<Error>([&] { read_flat_exr(path); }).starts_with(path + ": channel u is subsampled, "));
    }
}

TEST_F(ExrFlat, ErrorsNameTheFile) {
    const auto read = [&] { read_flat_exr(path); };
    EXPECT_EQ(what_of<Error>(read), path + ": cannot open: No such file or directory");
    for (const char *text : {"", "hello", "v/1\x01 but then nothing of an EXR file follows here"}) {
        put_contents(path, text);
        EXPECT_NE(what_of<Error>(read).find(path), std::string::npos) << what_of<Error>(read);
    }
}

TEST_F(ExrFlat, AFileCutAnywhereIsAnError) {
    Image image(windows_of_size(64, 64), {{"R"}, {"Z", PixelType::float32}});
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = std::sin(float(i * i));
    write_flat_exr(path, image, Imf::Header());
    const std::string whole = contents_of(path);
    for (std::size_t size = 0; size < whole.size(); size += 397) {
        put_contents(path, whole.substr(0, size));
        EXPECT_NE(what_of<Error>([&] { read_flat_exr(path); }).find(path), std::string::npos) << size;
    }
}

TEST_F(ExrFlat, TheOldFileSurvivesAFailure) {
    put_contents(path, "old");
    Imf::Header header;
    Image image = one_pixel(PixelType::half, 1);
    image.channels[0].name = ""; // an invalid channel name
    EXPECT_THROW(write_flat_exr(path, image, header), Error);
    EXPECT_EQ(contents_of(path), "old");
    EXPECT_EQ(folder.entries(), 1u);
}

Image with_depths(std::vector<Channel> channels) {
    Image image(windows_of_size(2, 1), std::move(channels));
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = float(i);
    return image;
}

TEST(TakeDepth, TakesTheUsualNamesAndLeavesTheRest) {
    Image image = with_depths({{"R"}, {"Z", PixelType::float32}, {"id", PixelType::uint32}});
    EXPECT_EQ(take_depth(image, "", "f"), (std::vector<float>{2, 3}));
    EXPECT_EQ(image.channels, (std::vector<Channel>{{"R"}, {"id", PixelType::uint32}}));
    EXPECT_EQ(image.values, (LargeArray<float>{0, 1, 4, 5}));
    for (const char *name : {"Z", "depth.Z", "ViewLayer.Depth.Z"}) {
        Image named = with_depths({{"R"}, {name, PixelType::float32}});
        EXPECT_EQ(take_depth(named, "", "f"), (std::vector<float>{2, 3})) << name;
    }
}

// Octane and Unreal write depth as a picture, with one value in R, G and B.
TEST(TakeDepth, TakesALayerOfThreeEqualChannels) {
    for (const std::string layer : {"Z-depth", "FinalImageMovieRenderQueue_WorldDepth"}) {
        Image image = with_depths({{"R"},
                                   {layer + ".A", PixelType::float32},
                                   {layer + ".B", PixelType::float32},
                                   {layer + ".G", PixelType::float32},
                                   {layer + ".R", PixelType::float32}});
        EXPECT_EQ(take_depth(image, "", "f"), (std::vector<float>{8, 9})) << layer;
    }
    Image two = with_depths({{"R"}, {"depth1.R", PixelType::float32}, {"depth2.R", PixelType::float32}});
    EXPECT_THROW(take_depth(two, "", "f"), Error);
}

TEST(TakeDepth, TakesTheOneThatIsAskedFor) {
    Image image = with_depths({{"P.z", PixelType::float32}, {"R"}});
    EXPECT_EQ(take_depth(image, "P.z", "f"), (std::vector<float>{0, 1}));
    EXPECT_EQ(what_of<Error>([&] { take_depth(image, "P.z", "f.exr"); }),
              "f.exr: has no channel P.z (`depth_channel`); its channels are R");
    EXPECT_EQ(what_of<Error>([&] { take_depth(image, "", "f.exr"); }),
              "f.exr: has no depth channel (Z, depth.Z, *.Depth.Z and the like): give `depth_file` where it "
              "is in a "
              "file of its own, else `depth_channel`; its channels are R");
}

// Readers of our files would take another Z for the depth.
TEST(TakeDepth, AnotherZIsNotCarried) {
    Image image = with_depths({{"R"}, {"Z", PixelType::float32}, {"depth.Z", PixelType::float32}});
    EXPECT_EQ(take_depth(image, "depth.Z", "f"), (std::vector<float>{4, 5}));
    EXPECT_EQ(image.channels, (std::vector<Channel>{{"R"}}));
    EXPECT_EQ(image.values, (LargeArray<float>{0, 1}));
}

TEST(TakeDepth, IdsAreNoDepth) {
    Image image = with_depths({{"Z", PixelType::uint32}});
    EXPECT_EQ(what_of<Error>([&] { take_depth(image, "", "f.exr"); }),
              "f.exr: the depth channel Z holds integers, not depths");
}

} // namespace
} // namespace sparselens
