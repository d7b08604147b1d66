#include "base/image.h"
#include "base/matte.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

namespace sparselens {
namespace {

std::vector<Channel> found(std::vector<Channel> channels, const std::vector<std::string> &mattes = {}) {
    find_kinds(channels, mattes);
    return channels;
}

ChannelKind kind_of(const std::string &name, PixelType type = PixelType::float32) {
    return found({{name, type}})[0].kind;
}

TEST(ChannelKind, ColoursAreLight) {
    for (const char *name :
         {"R", "A", "AR", "Y", "diffuse.R", "ViewLayer.Combined.B", "CryptoObject.R", "mask.A"})
        EXPECT_EQ(kind_of(name), ChannelKind::light) << name;
}

TEST(ChannelKind, PositionsNormalsAndMotionAreData) {
    for (const char *name : {"N.R",
                             "N.X",
                             "P.B",
                             "ViewLayer.Normal.X",
                             "uv.R",
                             "UV.U",
                             "motionvector.R",
                             "velocity.R",
                             "Z",
                             "other.Z",
                             "ViewLayer.Vector.W",
                             "depth.R",
                             "ViewLayer.Denoising Normal.X",
                             "VRayNormals.R",
                             "VRayBumpNormals.R",
                             "VRayVelocity.G",
                             "world_normal.B",
                             "Pworld.R",
                             "P_world.R",
                             "rest.R",
                             "Nn.R",
                             "mv2d.R",
                             "BumpNormals.R",
                             "SHADING_NORMAL.R",
                             "GeoNormal.R",
                             "FinalImageWorldNormal.R",
                             "Tangents.R",
                             "Normal (geometric).R",
                             "hitP.R",
                             "dPdu.R",
                             "MotionVectorsAndDepth.R",
                             "WPP.R",
                             "ObjectPos.R",
                             "TextureUV.R",
                             "AOV_P.R",
                             "aov_N_cam.R"})
        EXPECT_EQ(kind_of(name), ChannelKind::data) << name;
    for (const char *name : {"point_lights.R", "abnormal.R", "rest_of_lights.R", "uv_lamps.R", "normalised.R",
                             "demotion.R", "diffuse_depth1.R", "p.diffuse.R", "North.R", "n_lights.R",
                             "proposition.R", "UV_light.R", "aov_diffuse.R"})
        EXPECT_EQ(kind_of(name), ChannelKind::light) << name;
    EXPECT_FALSE(is_light(found({{"N.R"}})[0]));
    EXPECT_FALSE(holds_ids(found({{"N.R"}})[0]));
}

TEST(ChannelKind, IntegersAreIds) {
    EXPECT_TRUE(holds_ids({"objectId", PixelType::uint32}));
    EXPECT_FALSE(is_light({"objectId", PixelType::uint32}));
    EXPECT_FALSE(is_in_matte({"objectId", PixelType::uint32}));
}

TEST(ChannelKind, NumbersOfLayersNamedSoAreIds) {
    for (const char *name :
         {"ViewLayer.IndexOB.X", "ViewLayer.IndexMA.X", "ViewLayer.Object Index.X", "a.Material Index.X",
          "ID", "objectid", "ObjectID.Y", "fg.materialID", "primid"}) {
        const Channel channel = found({{name, PixelType::float32}})[0];
        EXPECT_TRUE(holds_ids(channel)) << name;
        EXPECT_FALSE(is_light(channel)) << name;
        EXPECT_FALSE(is_in_matte(channel)) << name;
    }
    for (const char *name : {"grid", "valid.R", "R", "Index.X", "objectID.Z", "IndexOB.N.X", "ab.grid.X"})
        EXPECT_FALSE(holds_ids(found({{name, PixelType::float32}})[0])) << name;
    for (const Channel &channel : found({{"objectID.R"}, {"objectID.G"}, {"objectID.B"}}))
        EXPECT_TRUE(is_light(channel)) << "colours that stand for ids";
}

TEST(ChannelKind, RanksOfACryptomatteByNameOrByTheHeader) {
    const auto channels =
        found({{"CryptoObject01.B", PixelType::float32}, {"ViewLayer.CryptoAsset00.g", PixelType::float32}});
    EXPECT_EQ(channels[0].kind, ChannelKind::matte_id);
    EXPECT_EQ(channels[0].matte, "CryptoObject");
    EXPECT_EQ(channels[0].rank, 3);
    EXPECT_EQ(channels[1].kind, ChannelKind::matte_coverage);
    EXPECT_EQ(channels[1].matte, "ViewLayer.CryptoAsset");
    EXPECT_EQ(channels[1].rank, 0);
    EXPECT_EQ(kind_of("objects00.R"), ChannelKind::light);
    EXPECT_EQ(found({{"objects00.R", PixelType::float32}}, {"objects"})[0].kind, ChannelKind::matte_id);
    // A half cannot hold a hash, but two of them still tell objects apart.
    EXPECT_EQ(kind_of("CryptoObject00.R", PixelType::half), ChannelKind::matte_id);
    EXPECT_EQ(kind_of("VRayCryptomatte00.R"), ChannelKind::matte_id);
    EXPECT_EQ(kind_of("uCryptoAsset01.A"), ChannelKind::matte_coverage);
    EXPECT_EQ(kind_of("VRayCryptomatte.R"), ChannelKind::light); // the picture to look at
}

TEST(ChannelKind, IsWhatTheUserStates) {
    std::vector<Channel> channels{{"fg.secret.R"}, {"secret.G"}, {"heat"}, {"N.X"}, {"R"}};
    find_kinds(channels, {}, {.data = {"secret", "heat"}, .light = {"N"}});
    for (const std::size_t k : {0u, 1u, 2u})
        EXPECT_EQ(channels[k].kind, ChannelKind::data) << channels[k].name;
    for (const std::size_t k : {3u, 4u}) EXPECT_EQ(channels[k].kind, ChannelKind::light) << channels[k].name;
    std::vector<Channel> one{{"secret.R"}, {"other.R"}};
    find_kinds(one, {}, {.data = {"secret.R"}});
    EXPECT_EQ(one[0].kind, ChannelKind::data);
    EXPECT_EQ(one[1].kind, ChannelKind::light);
}

TEST(NamesOfColours, TheCoverageOfEachColourAsOthersNameIt) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(names_of_colours(found({{"RA"}, {"GA"}, {"BA"}, {"R"}})), (Names{"AR", "AG", "AB", "R"}));
    EXPECT_EQ(names_of_colours(found({{"f.RA"}, {"f.GA"}, {"f.BA"}})), (Names{"f.AR", "f.AG", "f.AB"}));
    EXPECT_EQ(names_of_colours(found({{"RA"}, {"GA"}, {"R"}})), (Names{"RA", "GA", "R"})); // not all three
}

TEST(Matte, IsFoundInAnyOrderOfItsChannels) {
    const auto channels = found({{"CryptoObject00.A", PixelType::float32},
                                 {"CryptoObject00.B", PixelType::float32},
                                 {"R"},
                                 {"CryptoObject00.G", PixelType::float32},
                                 {"CryptoObject00.R", PixelType::float32},
                                 {"CryptoObject01.R", PixelType::float32}}); // without its coverage
    const std::vector<Matte> mattes = find_mattes(channels);
    ASSERT_EQ(mattes.size(), 1u);
    ASSERT_EQ(mattes[0].ranks.size(), 2u);
    EXPECT_EQ(mattes[0].ranks[0].id, 4u);
    EXPECT_EQ(mattes[0].ranks[0].coverage, 3u);
    EXPECT_EQ(mattes[0].ranks[1].id, 1u);
    EXPECT_EQ(mattes[0].ranks[1].coverage, 0u);
}

// A header made to take long: comparing each channel with all others would take minutes.
TEST(ChannelKind, OfManyChannelsAreFoundAtOnce) {
    std::vector<Channel> channels;
    for (int i = 0; i < 100'000; ++i) channels.push_back({fmt::format("layer{}.y", i)});
    channels.push_back({"layer99.X"});
    for (int i = 0; i < 50'000; ++i)
        for (const char *c : {"r", "g"})
            channels.push_back({fmt::format("crypto{:05}.{}", i, c), PixelType::float32});
    find_kinds(channels);
    EXPECT_EQ(channels[98].kind, ChannelKind::light);
    EXPECT_EQ(channels[99].kind, ChannelKind::data);
    const std::vector<Matte> mattes = find_mattes(channels);
    ASSERT_EQ(mattes.size(), 500u); // of 100 ranks
    EXPECT_EQ(mattes[3].name, "crypto003");
    ASSERT_EQ(mattes[3].ranks.size(), 100u);
    EXPECT_EQ(mattes[3].ranks[7].id, 100'001u + 2 * 307);
    EXPECT_EQ(mattes[3].ranks[7].coverage, 100'001u + 2 * 307 + 1);
}

// Many ids in one pixel have the same sums as few, and cost no more than sorting.
TEST(IdCoverage, AddsManyIds) {
    const std::uint32_t n = 500'000;
    IdCoverage sum;
    for (const double coverage : {0.25, 0.5, -0.125})
        for (std::uint32_t i = 0; i < n; ++i)
            sum.add(std::bit_cast<float>(std::uint32_t(std::uint64_t(i) * 7919 % n)),
                    coverage * (1 + double(i % 7 == 0)));
    const auto pairs = sum.ranked();
    ASSERT_EQ(pairs.size(), n);
    const std::size_t twice = (n + 6) / 7;
    for (std::size_t k = 0; k < n; ++k) ASSERT_EQ(pairs[k].coverage, k < twice ? 1.25 : 0.625) << k;
    for (std::size_t k = 1; k < n; ++k) {
        const auto bits = [&](std::size_t i) { return std::bit_cast<std::uint32_t>(pairs[i].id); };
        ASSERT_TRUE(k == twice || bits(k - 1) < bits(k)) << k;
    }
    sum.clear();
    sum.add(2, 0.5);
    EXPECT_EQ(sum.ranked().size(), 1u);
}

TEST(IdCoverage, AddsByBitsAndRanks) {
    const float huge = std::bit_cast<float>(0x7f123456u), tiny = std::bit_cast<float>(3u), minus_zero = -0.0f;
    IdCoverage sum;
    sum.add(huge, 0.25);
    sum.add(tiny, 0.5);
    sum.add(huge, 0.5);
    sum.add(minus_zero, 0.125); // another id than 0
    sum.add(0.0f, 0.0625);
    sum.add(2, 0.5);
    sum.add(2, -0.5);
    const auto pairs = sum.ranked();
    ASSERT_EQ(pairs.size(), 4u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(pairs[0].id), 0x7f123456u);
    EXPECT_EQ(pairs[0].coverage, 0.75);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(pairs[1].id), 3u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(pairs[2].id), 0x80000000u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(pairs[3].id), 0u);
}

} // namespace
} // namespace sparselens
