// The beauty in a layer, as Blender and other renderers write it.
#include "base/error.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/open_view.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using Names = std::vector<std::string>;

std::vector<Channel> layer(const std::string &name) {
    return {{name + ".R"}, {name + ".G"}, {name + ".B"}, {name + ".A"}};
}

std::vector<Channel> layers(const Names &names) {
    std::vector<Channel> all;
    for (const std::string &name : names)
        for (const Channel &channel : layer(name)) all.push_back(channel);
    return all;
}

Names names_of(const std::vector<Channel> &channels) {
    Names names;
    for (const Channel &channel : channels) names.push_back(channel.name);
    return names;
}

TEST(Beauty, TheNamesOfTheRenderersInAnyCaseAndAnyLayer) {
    for (const char *name :
         {"RGBA", "rgba", "C", "Ci", "beauty", "Combined", "default", "ViewLayer.Combined", "a.b.CI"})
        EXPECT_TRUE(is_beauty_name(name)) << name;
    for (const char *name : {"", "diffuse", "Combined.diffuse", "BeautyMask", "Cia"})
        EXPECT_FALSE(is_beauty_name(name)) << name;
}

Names beauties(const std::vector<Channel> &channels) {
    Names names;
    for (const PictureLayer &picture : pictures_in(channels)) names.push_back(picture.beauty);
    return names;
}

TEST(Beauty, IsALayerOnlyWhereNoColourIsOutsideOfLayers) {
    EXPECT_EQ(beauties(layers({"diffuse", "Ci"})), (Names{"Ci"}));
    EXPECT_EQ(beauties(layers({"diffuse", "spec"})), Names());
    std::vector<Channel> with_plain = layers({"Ci"});
    with_plain.push_back({"G"});
    EXPECT_EQ(beauties(with_plain), Names());
    EXPECT_EQ(beauties({{"Ci.R"}, {"Ci.G"}}), Names()) << "no B";
    EXPECT_EQ(beauties({{"Ci.R", PixelType::uint32}, {"Ci.G"}, {"Ci.B"}}), Names()) << "ids";
}

// Blender writes the compositor's result beside the render layers, and before them.
TEST(Beauty, OfSeveralItIsTheOneWithADepth) {
    std::vector<Channel> channels = layers({"Composite.Combined", "ViewLayer.Combined"});
    EXPECT_EQ(beauties(channels), (Names{"Composite.Combined", "ViewLayer.Combined"}));
    channels.push_back({"ViewLayer.Depth.Z", PixelType::float32});
    EXPECT_EQ(beauties(channels), (Names{"ViewLayer.Combined"}));
    EXPECT_FALSE(chosen_picture(channels, "", "x.exr"));
}

// Two view layers, and channels that belong to neither.
std::vector<Channel> two_pictures() {
    std::vector<Channel> channels = layers({"bg.Combined", "fg.Combined", "fg.Diffuse"});
    for (const char *name :
         {"bg.Depth.Z", "fg.Depth.Z", "fg.CryptoObject00.r", "bg.CryptoObject00.r", "Z", "mask"})
        channels.push_back({name, PixelType::float32});
    return channels;
}

TEST(Beauty, SeveralPicturesNeedAChoice) {
    EXPECT_EQ(what_of<UsageError>([] { chosen_picture(two_pictures(), "", "x.exr"); }),
              "x.exr: holds several pictures, bg.Combined and fg.Combined: give `layer` with one of bg, fg");
    EXPECT_EQ(what_of<Error>([] { chosen_picture(two_pictures(), "hero", "x.exr"); }),
              "x.exr: has no layer 'hero' with R, G and B (`layer`): its layers are bg, fg");
    EXPECT_EQ(what_of<Error>([] {
                  chosen_picture(layer("R"), "hero", "x.exr");
              }).find("x.exr: has no layer 'hero'"),
              0u);
    for (const char *name : {"fg", "fg.Combined"})
        EXPECT_EQ(chosen_picture(two_pictures(), name, "x.exr")->beauty, "fg.Combined") << name;
    EXPECT_EQ(chosen_picture(two_pictures(), "fg.Diffuse", "x.exr")->beauty, "fg.Diffuse");
}

TEST(Beauty, APictureHasItsOwnChannelsAndThoseOfNone) {
    const std::vector<Channel> all = two_pictures();
    const ChannelsOfPicture fg(*chosen_picture(all, "fg", "x.exr"), all);
    Names names;
    for (const Channel &channel : all)
        if (const std::string name = fg.name_of(channel.name); !name.empty()) names.push_back(name);
    EXPECT_EQ(names, (Names{"R", "G", "B", "A", "fg.Diffuse.R", "fg.Diffuse.G", "fg.Diffuse.B",
                            "fg.Diffuse.A", "fg.Depth.Z", "fg.CryptoObject00.r", "mask"}));
    EXPECT_EQ(full_name("R", "fg.Combined", true), "fg.Combined.R");
    EXPECT_EQ(full_name("fg.Combined.R", "fg.Combined", true), "fg.Combined.R");
    EXPECT_EQ(full_name("fg.Combined.R", "whole", false), "fg.Combined.R");
}

TEST(Beauty, ALayerWhoseNameBeginsAnothersHasItsOwnChannelsOnly) {
    std::vector<Channel> all;
    for (const std::string layer : {"View.001", "View.001.b"})
        for (const char *name : {"Combined.R", "Combined.G", "Combined.B", "Depth.Z", "Diffuse.R"})
            all.push_back({layer + "." + name, PixelType::float32});
    for (const std::string layer : {"View.001", "View.001.b"}) {
        const ChannelsOfPicture picture(*chosen_picture(all, layer, "x.exr"), all);
        Names names;
        for (const Channel &channel : all)
            if (const std::string name = picture.name_of(channel.name); !name.empty()) names.push_back(name);
        EXPECT_EQ(names, (Names{"R", "G", "B", layer + ".Depth.Z", layer + ".Diffuse.R"}));
    }
}

TEST(Beauty, ALayerOfAllItsChannelsHasADepthToo) {
    std::vector<Channel> all = layers({"bg", "fg"});
    for (const char *name : {"fg.Z", "fg.ZBack", "Z"}) all.push_back({name, PixelType::float32});
    const ChannelsOfPicture fg(*chosen_picture(all, "fg", "x.exr"), all),
        bg(*chosen_picture(all, "bg", "x.exr"), all);
    EXPECT_EQ(fg.name_of("fg.R"), "R");
    EXPECT_EQ(fg.name_of("fg.Z"), "Z");
    EXPECT_EQ(fg.name_of("fg.ZBack"), "ZBack");
    EXPECT_EQ(fg.name_of("Z"), "") << "it is that of another picture";
    EXPECT_EQ(bg.name_of("Z"), "Z") << "bg has none of its own";
    for (const std::string depth : {"Z", "fg.Z"})
        EXPECT_EQ(ChannelsOfPicture(*chosen_picture(all, "fg", "x.exr"), all, depth).name_of(depth), depth);
}

class BeautyInFile : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("layers.exr");

    // One row of two pixels; every value of channel k is k + 1.
    void write_flat(const std::vector<Channel> &channels) {
        Image image(windows_of_size(2, 1), channels);
        for (std::size_t k = 0; k < channels.size(); ++k) std::ranges::fill(image.plane(k), float(k + 1));
        write_flat_exr(path, image, Imf::Header());
    }
};

TEST_F(BeautyInFile, BlendersCombinedIsThePicture) {
    std::vector<Channel> channels = layers({"ViewLayer.Combined", "ViewLayer.Diffuse"});
    channels.push_back({"ViewLayer.Depth.Z", PixelType::float32});
    write_flat(channels);
    const FlatFile file = read_flat_exr(path);
    EXPECT_EQ(names_of(file.image.channels),
              (Names{"R", "G", "B", "A", "ViewLayer.Depth.Z", "ViewLayer.Diffuse.A", "ViewLayer.Diffuse.B",
                     "ViewLayer.Diffuse.G", "ViewLayer.Diffuse.R"}));
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(file.image.plane(k)[0], float(k + 1));
    EXPECT_EQ(file.notes, (Names{"beauty: ViewLayer.Combined.R, ViewLayer.Combined.G, ViewLayer.Combined.B; "
                                 "coverage: ViewLayer.Combined.A"}));
    EXPECT_TRUE(file.warnings.empty());
    const OpenedView view = open_view(path);
    EXPECT_EQ(view.view.z, (std::vector<float>{9, 9}));
    EXPECT_EQ(view.notes.back(), "depth: ViewLayer.Depth.Z");
    const LdiFile ldi = read_ldi(path);
    EXPECT_EQ(ldi.ldi.values[ldi.ldi.alpha()][0], 4);
    EXPECT_EQ(ldi.notes, view.notes);
}

TEST_F(BeautyInFile, OfSeveralPicturesOneIsRead) {
    write_flat(two_pictures());
    EXPECT_THROW(read_flat_exr(path), UsageError);
    EXPECT_THROW(read_flat_header(path), UsageError);
    EXPECT_THROW(read_ldi(path), UsageError);
    const std::vector<Channel> all = two_pictures();
    for (const std::string name : {"fg", "bg"}) {
        const FlatFile file = read_flat_exr(path, {.layer = name});
        EXPECT_EQ(file.image.plane(0)[0], float(find_channel(all, name + ".Combined.R") + 1));
        EXPECT_EQ(find_channel(file.image.channels, "mask") != npos, true);
        const LdiFile ldi = read_ldi(path, {.layer = name});
        EXPECT_EQ(ldi.ldi.z[0], float(find_channel(all, name + ".Depth.Z") + 1));
    }
    for (const std::string depth : {"bg.Depth.Z", "fg.Depth.Z"}) { // any picture's depth may be used
        const float value = float(find_channel(all, depth) + 1);
        const DepthOptions options{.picture = {.layer = "fg", .depth = depth}};
        EXPECT_EQ(read_ldi(path, options.picture).ldi.z[0], value) << depth;
        EXPECT_EQ(open_view(path, {.depth = options}).view.z[0], value) << depth;
    }
    EXPECT_EQ(picture_layers(path), (Names{"bg", "fg"}));
    write_flat({{"R"}, {"G"}, {"B"}});
    EXPECT_EQ(picture_layers(path), Names());
}

TEST_F(BeautyInFile, LayersWithoutABeautyAreAWarningThatListsThem) {
    write_flat(layers({"diffuse", "spec"}));
    const FlatFile file = read_flat_exr(path);
    EXPECT_EQ(names_of(file.image.channels).front(), "diffuse.A");
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_NE(file.warnings[0].find("its layers are diffuse, spec"), std::string::npos) << file.warnings[0];
    EXPECT_EQ(read_flat_exr(path, {.layer = "spec"}).image.plane(0)[0], 5);
    write_flat({{"A"}, {"N.x"}});
    EXPECT_TRUE(read_flat_exr(path).warnings.empty()) << "a mask and data";
}

TEST_F(BeautyInFile, OfADeepFileToo) {
    Ldi ldi = ldi_of({{{.z = 2, .colour = 0.5f, .alpha = 0.25f}}, {{.z = 3}}});
    for (Channel &channel : ldi.channels) channel.name = "RenderLayer.Ci." + channel.name;
    write_ldi(path, ldi, Imf::Header());
    const LdiFile file = read_ldi(path);
    EXPECT_EQ(names_of(file.ldi.channels), (Names{"R", "G", "B", "A"}));
    EXPECT_EQ(file.ldi.values[0][0], 0.5f);
    EXPECT_EQ(file.ldi.values[3][0], 0.25f);
    EXPECT_EQ(file.notes, (Names{"beauty: RenderLayer.Ci.R, RenderLayer.Ci.G, RenderLayer.Ci.B; "
                                 "coverage: RenderLayer.Ci.A",
                                 "depth: Z"}));
    for (Channel &channel : ldi.channels) channel.name.replace(0, 14, "diffuse.");
    write_ldi(path, ldi, Imf::Header());
    EXPECT_EQ(read_ldi(path).warnings.size(), 1u);
}

} // namespace
} // namespace sparselens
