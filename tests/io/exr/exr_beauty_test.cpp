// The beauty in a layer, as Blender and other renderers write it.
#include "base/error.h"
#include "io/exr/exr_beauty.h"
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

TEST(Beauty, IsALayerOnlyWhereNoColourIsOutsideOfLayers) {
    EXPECT_EQ(beauty_layer(layers({"diffuse", "Ci"})), "Ci");
    EXPECT_EQ(beauty_layer(layers({"diffuse", "spec"})), "");
    std::vector<Channel> with_plain = layers({"Ci"});
    with_plain.push_back({"G"});
    EXPECT_EQ(beauty_layer(with_plain), "");
    EXPECT_EQ(beauty_layer({{"Ci.R"}, {"Ci.G"}}), "") << "no B";
    EXPECT_EQ(beauty_layer({{"Ci.R", PixelType::uint32}, {"Ci.G"}, {"Ci.B"}}), "") << "ids";
}

// Blender writes the result of its compositor beside the render layers, and before them.
TEST(Beauty, OfSeveralItIsTheOneWithADepth) {
    std::vector<Channel> channels = layers({"Composite.Combined", "ViewLayer.Combined"});
    EXPECT_EQ(beauty_layer(channels), "Composite.Combined");
    channels.push_back({"ViewLayer.Depth.Z", PixelType::float32});
    EXPECT_EQ(beauty_layer(channels), "ViewLayer.Combined");
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

TEST_F(BeautyInFile, LayersWithoutABeautyAreAWarningThatListsThem) {
    write_flat(layers({"diffuse", "spec"}));
    const FlatFile file = read_flat_exr(path);
    EXPECT_EQ(names_of(file.image.channels).front(), "diffuse.A");
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_NE(file.warnings[0].find("its layers are diffuse, spec"), std::string::npos) << file.warnings[0];
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
