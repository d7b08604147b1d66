// Files of several parts and views, as others write them.
#include "base/error.h"
#include "deep/flatten.h"
#include "deep/tidy.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/exr/exr_parts.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

namespace sparselens {
namespace {

// One part of a file to write: flat if `depth` has no samples' depth.
struct TestPart {
    std::string name, view;
    Ldi ldi;
    std::string depth = "Z";
};

class ExrParts : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("parts.exr");

    Imf::Header header_of(const TestPart &part) {
        Imf::Header header(part.ldi.windows.display, part.ldi.windows.data);
        header.setName(part.name);
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        if (!part.view.empty()) header.setView(part.view);
        if (!part.depth.empty()) header.channels().insert(part.depth, Imf::Channel(Imf::FLOAT));
        for (const Channel &channel : part.ldi.channels)
            header.channels().insert(
                channel.name, Imf::Channel(channel.type == PixelType::uint32 ? Imf::UINT : Imf::FLOAT));
        return header;
    }

    void write_deep(Imf::MultiPartOutputFile &file, int number, TestPart &part) {
        Ldi &ldi = part.ldi;
        const std::size_t width = std::size_t(ldi.windows.width());
        std::vector<unsigned> counts;
        for (std::size_t i = 0; i + 1 < ldi.begin.size(); ++i)
            counts.push_back(unsigned(ldi.pixel(i).size()));
        std::vector<std::vector<char *>> pointers;
        pointers.reserve(ldi.channels.size() + 1);
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts.data(), ldi.windows.data,
                                                       sizeof(unsigned), sizeof(unsigned) * width));
        const auto add = [&](const std::string &name, PixelType as, std::vector<float> &values) {
            std::vector<char *> &to = pointers.emplace_back();
            for (std::size_t i = 0; i + 1 < ldi.begin.size(); ++i)
                to.push_back(reinterpret_cast<char *>(values.data() + ldi.begin[i]));
            const auto type = as == PixelType::uint32 ? Imf::UINT : Imf::FLOAT;
            const Imf::Slice base =
                Imf::Slice::Make(type, to.data(), ldi.windows.data, sizeof(char *), sizeof(char *) * width);
            buffer.insert(name, Imf::DeepSlice(type, base.base, base.xStride, base.yStride, sizeof(float)));
        };
        if (!part.depth.empty()) add(part.depth, PixelType::float32, ldi.z);
        for (std::size_t k = 0; k < ldi.channels.size(); ++k)
            add(ldi.channels[k].name, ldi.channels[k].type, ldi.values[k]);
        Imf::DeepScanLineOutputPart output(file, number);
        output.setFrameBuffer(buffer);
        output.writePixels(ldi.windows.height());
    }

    void write(std::vector<TestPart> parts) {
        std::vector<Imf::Header> headers;
        for (const TestPart &part : parts) headers.push_back(header_of(part));
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
        for (std::size_t i = 0; i < parts.size(); ++i) write_deep(file, int(i), parts[i]);
    }

    // One row of pixels, each channel with one value; a `multiView` file if there are views.
    void write_flat(const std::vector<std::pair<std::string, float>> &channels,
                    const std::vector<std::string> &views) {
        Imf::Header header(3, 1);
        if (!views.empty()) Imf::addMultiView(header, views);
        Imf::FrameBuffer pixels;
        std::vector<std::vector<float>> values;
        values.reserve(channels.size());
        for (const auto &[name, value] : channels) {
            values.emplace_back(3, value);
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            pixels.insert(name, Imf::Slice::Make(Imf::FLOAT, values.back().data(), header.dataWindow(),
                                                 sizeof(float), 3 * sizeof(float)));
        }
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(pixels);
        file.writePixels(1);
    }

    std::vector<std::string> names_in(const std::string &view) {
        std::vector<std::string> names;
        for (const Channel &channel : read_flat_exr(path, {view}).image.channels)
            names.push_back(channel.name);
        return names;
    }
};

using Names = std::vector<std::string>;

Ldi object(float z, float colour, float alpha = 1) {
    return ldi_of({{{.z = z, .colour = colour, .alpha = alpha}}, {{.z = z + 1, .colour = colour}}});
}

TEST_F(ExrParts, DeepPartsAreObjectsOfOnePicture) {
    write({{"hero", "", object(4, 0.5f)}, {"fog", "", object(2, 0.25f, 0.5f)}});
    const LdiFile file = read_ldi(path);
    EXPECT_EQ(file.ldi.z, (std::vector<float>{4, 2, 5, 3}));
    EXPECT_EQ(tidy(file.ldi).z, (std::vector<float>{2, 4, 3, 5}));
    EXPECT_EQ(flatten(tidy(file.ldi)).plane(0)[0], 0.25f + 0.5f * 0.5f);
    EXPECT_FALSE(file.header.hasName());
    EXPECT_EQ(file.notes,
              (Names{"beauty: R, G, B; coverage: A (part hero)", "depth: Z", "2 deep parts are merged"}));
}

TEST_F(ExrParts, ALayerIsReadOfItsDeepPartsAlone) {
    write({{"hero", "", object(4, 0.5f)}, {"fog", "", object(2, 0.25f, 0.5f)}});
    const LdiFile fog = read_ldi(path, {.layer = "fog"});
    EXPECT_EQ(fog.ldi.z, (std::vector<float>{2, 3}));
    EXPECT_EQ(fog.ldi.values[fog.ldi.alpha()], (std::vector<float>{0.5f, 1}));
    EXPECT_THROW(read_ldi(path, {.layer = "rain"}), Error);
    write({{"fg.Combined", "", object(4, 0.5f)},
           {"bg.Combined", "", object(2, 0.25f)},
           {"fg.Diffuse", "", object(4, 0.125f)}});
    const Ldi fg = read_ldi(path, {.layer = "fg"}).ldi;
    EXPECT_EQ(fg.z, (std::vector<float>{4, 5}));
    EXPECT_EQ(fg.values[find_channel(fg.channels, "fg.Diffuse.R")][0], 0.125f);
}

TEST_F(ExrParts, ADeepPartOfTheSameSamplesIsALayer) {
    Ldi diffuse = object(4, 0.125f), ids = object(4, 0);
    ids.channels = {{"id", PixelType::uint32}};
    ids.values = {{3, 5}};
    write({{"hero", "", object(4, 0.5f)}, {"diffuse", "", diffuse}, {"ids", "", ids, ""}});
    const Ldi ldi = read_ldi(path).ldi;
    EXPECT_EQ(ldi.z, (std::vector<float>{4, 5}));
    EXPECT_EQ(ldi.values[find_channel(ldi.channels, "R")], (std::vector<float>{0.5f, 0.5f}));
    EXPECT_EQ(ldi.values[find_channel(ldi.channels, "diffuse.R")], (std::vector<float>{0.125f, 0.125f}));
    EXPECT_EQ(ldi.values[find_channel(ldi.channels, "id")], ids.values[0]);
}

TEST_F(ExrParts, OneBeautyIsTheWholePicture) {
    write(
        {{"fog", "", object(2, 1, 0.5f)}, {"RGBA", "", object(4, 0.5f)}, {"diffuse", "", object(4, 0.25f)}});
    const LdiFile file = read_ldi(path);
    EXPECT_EQ(file.ldi.z, (std::vector<float>{4, 5}));
    EXPECT_NE(find_channel(file.ldi.channels, "diffuse.R"), npos);
    EXPECT_EQ(file.warnings, (Names{"part fog is left out: its samples are not those of the beauty"}));
}

TEST_F(ExrParts, APartThatLiesNowhereIsAnError) {
    Ldi other = object(4, 1);
    other.begin = {0, 2, 2};
    write({{"hero", "", object(4, 1)}, {"ids", "", other, ""}});
    EXPECT_EQ(what_of<Error>([&] { read_ldi(path); }),
              path + ": part ids has neither a depth channel nor the samples of an earlier part");
    Ldi ids = object(3, 1);
    ids.channels[0].type = PixelType::uint32;
    write({{"hero", "", object(4, 1)}, {"ids", "", ids}});
    EXPECT_EQ(what_of<Error>([&] { read_ldi(path); }),
              path + ": channel R holds integers in one deep part but not in another");
}

TEST_F(ExrParts, DeepViewsAreChosen) {
    write({{"rgba.left", "left", object(4, 0.5f)}, {"rgba.right", "right", object(2, 0.25f)}});
    EXPECT_EQ(read_ldi(path).ldi.z[0], 4);
    EXPECT_EQ(read_ldi(path, {"right"}).ldi.z[0], 2);
    EXPECT_EQ(read_ldi(path, {"right"}).header.view(), "right");
    EXPECT_EQ(what_of<Error>([&] { read_ldi(path, {"middle"}); }),
              path + ": has no stereo view 'middle' (`stereo_view`): its views are left, right");
}

TEST_F(ExrParts, ViewsOfOnePartAreToldByTheirChannels) {
    write_flat({{"R", 1},
                {"Z", 2},
                {"diffuse.R", 3},
                {"right.R", 4},
                {"right.Z", 5},
                {"diffuse.right.R", 6},
                {"right.spec.G", 7},
                {"N.x", 8},
                {"key.left.B", 9}},
               {"left", "right"});
    // diffuse.R and N.x belong to no view: the left view has both, the right one has its own diffuse.R.
    EXPECT_EQ(names_in(""), (Names{"R", "N.x", "Z", "diffuse.R", "key.B"}));
    EXPECT_EQ(names_in("left"), names_in(""));
    EXPECT_EQ(names_in("right"), (Names{"R", "N.x", "Z", "diffuse.R", "spec.G"}));
    const Image left = read_flat_exr(path).image, right = read_flat_exr(path, {"right"}).image;
    const auto value = [](const Image &image, const char *name) {
        return image.plane(find_channel(image.channels, name))[0];
    };
    EXPECT_EQ(value(left, "R"), 1);
    EXPECT_EQ(value(left, "diffuse.R"), 3);
    EXPECT_EQ(value(right, "R"), 4);
    EXPECT_EQ(value(right, "Z"), 5);
    EXPECT_EQ(value(right, "diffuse.R"), 6);
    EXPECT_EQ(value(right, "N.x"), 8);
    EXPECT_EQ(read_ldi(path, {"right"}).ldi.z[0], 5);
}

// Nuke's hero view, in a file that lists no views.
TEST_F(ExrParts, AnEyeWithADepthOfItsOwnIsAView) {
    for (const std::string depth : {"Z", "depth.Z"})
        for (const auto &[hero, other] : {std::pair("left", "right"), std::pair("right", "left")}) {
            const std::string eye = other + std::string(".");
            write_flat({{"R", 1}, {depth, 2}, {eye + "R", 4}, {eye + depth, 5}}, {});
            EXPECT_EQ(stereo_views(path), (std::vector<std::string>{hero, other})) << depth;
            EXPECT_EQ(names_in(""), (Names{"R", depth}));
            EXPECT_EQ(read_ldi(path).ldi.z[0], 2);
            EXPECT_EQ(read_ldi(path, {other}).ldi.z[0], 5);
            EXPECT_EQ(read_flat_exr(path, {other}).image.plane(0)[0], 4);
            EXPECT_EQ(read_flat_header(path, {other}).view(), other);
        }
    write_flat({{"R", 1}, {"Z", 2}, {"left.R", 3}, {"left.Z", 3}, {"right.R", 4}, {"right.Z", 5}}, {});
    EXPECT_TRUE(stereo_views(path).empty()); // R belongs to neither
}

TEST_F(ExrParts, ThePictureOfAViewSaysSo) {
    write_flat({{"R", 1}, {"right.R", 4}}, {"left", "right"});
    for (const char *view : {"left", "right"}) {
        const Imf::Header header = read_flat_header(path, {view});
        EXPECT_FALSE(Imf::hasMultiView(header));
        EXPECT_EQ(header.view(), view);
    }
    EXPECT_EQ(read_flat_header(path).view(), "left");
    write_flat_exr(path, read_flat_exr(path, {"right"}).image, read_flat_header(path, {"right"}));
    EXPECT_EQ(read_flat_exr(path, {"right"}).image.plane(0)[0], 4);
}

TEST_F(ExrParts, AFileWithoutViewsHasNone) {
    write_flat({{"R", 1}, {"right.R", 4}}, {});
    EXPECT_EQ(names_in(""), (Names{"R", "right.R"}));
    EXPECT_EQ(what_of<Error>([&] { read_flat_exr(path, {"right"}); }),
              path + ": has no stereo view 'right' (`stereo_view`): it names no views");
    EXPECT_THROW(read_flat_header(path, {"right"}), Error);
}

TEST_F(ExrParts, AIsMadeOfColouredAlphaWhereverItIsRead) {
    write_flat({{"R", 1}, {"AR", 0.25f}, {"AG", 0.5f}, {"AB", 0.75f}, {"Z", 1}}, {});
    EXPECT_EQ(names_in(""), (Names{"R", "A", "AB", "AG", "AR", "Z"}));
    EXPECT_EQ(read_flat_exr(path).image.plane(1)[2], 0.5f);
    const Ldi flat = read_ldi(path).ldi;
    EXPECT_EQ(flat.values[flat.alpha()], (std::vector<float>(3, 0.5f)));
    Ldi deep = object(1, 1);
    deep.channels = {{"AR"}, {"AG"}, {"AB"}, {"R"}};
    deep.values = {{0, 1}, {0, 1}, {0.75f, 1}, {1, 1}};
    write({{"glass", "", deep}});
    const Ldi read = read_ldi(path).ldi;
    EXPECT_EQ(read.values[read.alpha()], (std::vector<float>{0.25f, 1}));
}

} // namespace
} // namespace sparselens
