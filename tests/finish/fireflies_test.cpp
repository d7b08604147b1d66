// Bright pixels of one render: fireflies are left out, lamps stay.
#include "finish/fireflies.h"
#include "finish/synthetic.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

const ArrayGrid grid(96, 64);
const Colours truth = synthetic_truth(grid);

LayerToFinish layer() { return layer_of(grid, truth, blurred(truth, grid, 1), {16, 16}); }

void light(Colours &colours, const Position &at, float value) {
    for (Values &channel : colours) channel[grid.index(at)] = value;
}

bool is_left_out(const LayerToFinish &layer, const Position &at) {
    const std::size_t i = grid.index(at);
    return layer.rays[0][0][i] == layer.gathered[0][i] && layer.rays[1][0][i] == layer.gathered[0][i];
}

TEST(Fireflies, RendersWithoutThemStayToTheBit) {
    LayerToFinish with = layer();
    const Halves before = with.rays;
    leave_out_fireflies(with);
    EXPECT_EQ(with.rays, before);
}

TEST(Fireflies, AreLeftOutWhicheverHalfHasThem) {
    for (const std::size_t half : {0u, 1u})
        for (const float value : {1e3f, 65504.0f})
            for (const Position &at : {Position(40, 30), Position(0, 0), Position(95, 63)}) {
                LayerToFinish with = layer();
                light(with.rays[half], at, value);
                light(with.rays[1 - half], Position(at.column < 50 ? at.column + 3 : at.column - 3, at.row),
                      value);
                leave_out_fireflies(with);
                EXPECT_TRUE(is_left_out(with, at)) << half << ' ' << value << ' ' << at.column;
            }
}

TEST(Fireflies, LampsThatAnotherPictureShowsStay) {
    const Position at(40, 30);
    for (const int shown_by : {0, 1, 2}) {
        LayerToFinish with = layer();
        light(with.rays[0], at, 1000);
        if (shown_by == 0) light(with.rays[1], at, 400); // that half's pixel
        if (shown_by == 1) light(with.gathered, at, 300);
        for (int k = 0; shown_by == 2 && k < 4; ++k)
            light(with.rays[1], Position(34 + 3 * k, 27), 500); // its rays nearby
        leave_out_fireflies(with);
        EXPECT_EQ(with.rays[0][0][grid.index(at)], 1000) << shown_by;
    }
}

// A path to a lamp weighs more in a render of fewer samples.
TEST(Fireflies, RaysOfALampMayBeBrighterWhereThereAreFewer) {
    const Position at(40, 30);
    for (const float samples : {16.0f, 4.0f}) {
        LayerToFinish with = layer();
        with.samples = std::array<double, 2>{16, double(samples)};
        light(with.rays[1], at, 100);
        for (int k = 0; k < 4; ++k) light(with.rays[0], Position(34 + 3 * k, 27), 10);
        leave_out_fireflies(with);
        EXPECT_EQ(is_left_out(with, at), samples == 16) << samples;
    }
}

TEST(Fireflies, CostNothingAndDoNotShow) {
    const auto finished = [](const LayerToFinish &with) {
        Progress silent;
        return finish_layer(with, silent).picture;
    };
    const double without = decibels_of(finished(layer()), truth);
    LayerToFinish with = layer();
    for (int k = 0; k < 12; ++k)
        light(with.rays[std::size_t(k % 2)], Position(7 + (k * 37) % 83, 5 + (k * 23) % 55),
              10 * std::pow(10.0f, float(k % 4)));
    leave_out_fireflies(with);
    EXPECT_GT(decibels_of(finished(with), truth), without - 0.3);
}

} // namespace
} // namespace sparselens
