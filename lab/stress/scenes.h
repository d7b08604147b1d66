// Small LDIs made from formulas, and ways to judge their pictures.
#pragma once

#include "deep/ldi.h"
#include "lab/stress/stress_case.h"
#include "lens/thin_lens.h"

#include <functional>
#include <vector>

namespace sparselens::lab::stress {

struct Sample {
    double z;
    float colour = 1; // premultiplied
    float alpha = 1;
    float dx = 0, dy = 0;
};
using Pixel = std::vector<Sample>;
using PixelAt = std::function<Pixel(int x, int y)>; // EXR coordinates

// Channels Y and A: seen only by lens points, neither spread as highlights nor sharpened, because only R, G, B are.
Ldi grey_ldi(const Windows &windows, const PixelAt &pixel);
// R, G, B are colour, colour / 2, colour / 4.
Ldi colour_ldi(const Windows &windows, const PixelAt &pixel);

// 5 units of focus, CoC up to 8 pixels behind it.
ThinLens plain_lens();
double depth_of(const ThinLens &lens, double coc); // coc < R F / focus
float texture(int x, int y);                       // [0, 1), random

Windows window(int width, int height);
Imath::Box2i inner(const Windows &windows, int margin);

// The default gather with this many lens points everywhere (0: as many as the tiles need). Adds its time to `result`.
Image gather(const Ldi &ldi, const ThinLens &lens, StressResult &result, int lens_points = 64);

// Largest relative difference from `value` in the channel, over the box; infinite if a value is not finite.
double off_from(const Image &image, std::size_t channel, const Imath::Box2i &box, double value);
// Largest difference of two pictures over the box, relative to the largest value of `expected`.
double off_from(const Image &image, const Image &expected, const Imath::Box2i &box);
double sum_of(const Image &image, std::size_t channel);

// Compares the fast gather with lens_gather_reference.h: how far a value is outside the range that the reference
// allows, relative to the largest value.
StressResult against_reference(const Ldi &ldi, const ThinLens &lens, int lens_points = 64);
// A plane of one colour at that depth, which must keep its colour.
StressResult constant_plane(const ThinLens &lens, double z, double colour, int width = 48, int height = 32);

} // namespace sparselens::lab::stress
