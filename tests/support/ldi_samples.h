// LDIs for tests: written out pixel by pixel and sample by sample, or random.
#pragma once

#include "deep/ldi.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace sparselens {

struct Sample {
    double z;
    std::vector<float> values; // one for each channel
    float dx = 0, dy = 0;
    float z_back = 0; // 0: z
    float weight = 1;
    double image_z = 0; // 0: z
    double solid = 0;
};

// samples_at(x, y) returns the samples of a pixel, in EXR coordinates. z_back, image_z and solid exist only if a sample
// has one; dx, dy and weight always.
Ldi make_ldi(const Windows &windows, const std::vector<Channel> &channels,
             const std::function<std::vector<Sample>(int x, int y)> &samples_at);

// R, G and B are colour, colour / 2 and colour / 4 (premultiplied); a point unless z_back is given.
struct TestSample {
    float z;
    float colour = 1;
    float alpha = 1;
    float z_back = 0; // 0: z
    float weight = 1, dx = 0, dy = 0;
};
using TestPixel = std::vector<TestSample>;

// One row of pixels, channels R, G, B, A.
Ldi ldi_of(const std::vector<TestPixel> &pixels);

// The samples of a pixel of such an LDI, with z_back filled in.
TestPixel samples_of(const Ldi &ldi, std::size_t pixel);

struct RandomLdi {
    std::uint32_t seed = 1;
    int width = 16, height = 8;
    int most_samples = 6;    // per pixel; some have none
    double opaque_share = 0; // share of samples with A = 1
    double volume_share = 0;
    bool shuffled = false; // else sorted by z
    int depths = 1 << 20;  // number of different depths: few make equal ones likely
};

// Colours in [0, 1], alpha in [0, 1], z in [1, 10]. The same arguments give the same LDI.
Ldi random_ldi(const RandomLdi &how);

// A number in [0, 1) that depends only on the arguments.
double random_unit(int a, int b, std::uint32_t stream);

} // namespace sparselens
