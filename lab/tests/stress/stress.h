// Extreme and numerically stiff cases, each with its expected result and a bound on the error: small LDIs made from
// formulas, and ways to judge their pictures. lab/results/stress.md is printed by them.
#pragma once

#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace sparselens::stress {

struct Result {
    double error = 0;                  // as the claim of the case defines it
    std::optional<double> energy = {}; // the relative change of the sum of light, where that has a meaning
};
struct Limit {
    double bound; // of the error
    const char *reason;
};
struct Case {
    const char *name;
    const char *claim; // what is compared with what
    Limit limit;
    Result (*run)();
};
// As the row of the page begins.
inline std::ostream &operator<<(std::ostream &out, const Case &c) {
    return out << "| " << c.name << " | " << c.claim << " |";
}

class Stress : public testing::TestWithParam<Case> {
protected:
    static void SetUpTestSuite();
};
std::string name_of(const testing::TestParamInfo<Case> &info);

// Light may not be lost or created: docs/tolerances.md, section 3.
constexpr double energy_bound = 1e-4;

// Limits of several families. Sums over lens points are in float (docs/tolerances.md, section 4).
constexpr double rounding = 1e-5;
constexpr Limit reorders{rounding,
                         "the kernel only reorders the reference's sums: docs/tolerances.md, section 4"};
constexpr Limit normalised{rounding,
                           "weights are renormalised; a few hundred are summed, each rounded at 6e-8"};
constexpr Limit closed{rounding, "a surface that goes on lets nothing through: what is summed is 0"};
constexpr Limit same_input{0, "after the repair the input is the same, bit for bit"};

struct Spot {
    double z;
    float colour = 1; // premultiplied
    float alpha = 1;
    float dx = 0, dy = 0;
};
using Pixel = std::vector<Spot>;
using PixelAt = std::function<Pixel(int x, int y)>; // EXR coordinates

// Channels Y and A: seen only by lens points, neither spread as highlights nor sharpened, because only R, G, B are.
Ldi grey_ldi(const Windows &windows, const PixelAt &pixel);
Ldi grey_ldi(int width, int height, const PixelAt &pixel);
// R, G, B are colour, colour / 2, colour / 4.
Ldi colour_ldi(int width, int height, const PixelAt &pixel);

// 5 units of focus, CoC up to 8 pixels behind it.
constexpr ThinLens plain_lens{.radius = 0.0625, .focal_px = 640, .focus = 5};
float texture(int x, int y); // [0, 1), random

// The default gather with this many lens points everywhere (0: as many as the tiles need).
Image gather(const Ldi &ldi, const ThinLens &lens, int lens_points = 64);

// Largest relative difference from `value` in the channel, over the box; infinite if a value is not finite.
double off_from(const Image &image, std::size_t channel, const Imath::Box2i &box, double value);
// Largest difference of two pictures, relative to the largest value of `expected`, over the window of that.
double off_from(const Image &image, const Image &expected);
// How far the first channel and A are from these values, relative to each, except so near to the border.
double off_plane(const Image &image, double colour, double alpha, int border = 0);
double sum_of(const Image &image, std::size_t channel);

// Compares the fast gather with lens_gather_reference.h: how far a value is outside the range that the reference
// allows, relative to the largest value.
Result against_reference(const Ldi &ldi, const ThinLens &lens = plain_lens, int lens_points = 64);
// A picture that should have one colour.
Result against_plane(const Image &image, double colour);
// The picture of a plane at that depth.
Result constant_plane(const ThinLens &lens, double z, double colour, int width = 48, int height = 32);

} // namespace sparselens::stress
