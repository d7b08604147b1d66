#include "chain/notices.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(LayerNotes, OneLineALayer) {
    const PixelType f = PixelType::float32;
    std::vector<Channel> channels{{"R"},
                                  {"G"},
                                  {"B"},
                                  {"A"},
                                  {"fg.DiffCol.R"},
                                  {"fg.DiffCol.G"},
                                  {"fg.Vector.X", f},
                                  {"fg.Vector.W", f},
                                  {"fg.IndexOB.X", f},
                                  {"id", PixelType::uint32},
                                  {"N", f},
                                  {"CryptoObject00.r", f},
                                  {"CryptoObject00.g", f},
                                  {"CryptoObject01.r", f}};
    find_kinds(channels);
    EXPECT_EQ(
        layer_notes(channels),
        (std::vector<std::string>{
            "layer of the picture: light: the lens blurs it", "layer fg.DiffCol: light: the lens blurs it",
            "layer fg.Vector: data: averaged like light, without highlights and colour management",
            "layer fg.IndexOB: ids: those of the front sample, never averaged",
            "layer id: ids: those of the front sample, never averaged",
            "layer N: data: averaged like light, without highlights and colour management",
            "layer CryptoObject: Cryptomatte: ids are copied, the lens blurs their coverage"}));
}

} // namespace
} // namespace sparselens
