#include "lab/stress/scenes.h"
#include "lens/psf.h"

#include <algorithm>
#include <array>

namespace sparselens::lab {

namespace {

using namespace stress;

constexpr double rounding = 1e-5; // of sums over lens points, in float (docs/tolerances.md, section 4)

// A lens that can blur by any radius behind the focus.
ThinLens wide_lens() { return {.radius = 100, .focal_px = 1000, .focus = 5}; }

template <int Exponent>
StressResult constant_at_1e() {
    const ThinLens lens = wide_lens();
    return constant_plane(lens, depth_of(lens, std::pow(10.0, Exponent)), 0.3, 128, 96);
}
StressResult constant_at_the_threshold() {
    const ThinLens lens = plain_lens();
    const StressResult below = constant_plane(lens, depth_of(lens, 0.4999), 0.3);
    StressResult above = constant_plane(lens, depth_of(lens, 0.5001), 0.3);
    above.error = std::max(above.error, below.error);
    return above;
}

// A texture in front of a texture in focus; all samples of the front one have this CoC.
StressResult front_at(double coc) {
    const ThinLens lens = plain_lens();
    return against_reference(grey_ldi(window(40, 28),
                                      [&](int x, int y) {
                                          const bool front = (x - 20) * (x - 20) + (y - 14) * (y - 14) < 60;
                                          return Pixel{{front ? depth_of(lens, coc) : 5, texture(x, y)}};
                                      }),
                             lens);
}
StressResult front_1() { return front_at(-1); }
StressResult front_10() { return front_at(-10); }

// A floor that rises from before the focus to the horizon within 28 rows.
StressResult grazing() {
    return against_reference(
        grey_ldi(window(40, 28),
                 [](int x, int y) {
                     return Pixel{{(120 + 0.1 * x) / (28.5 - y), texture(x, y), 1, 0.3f * texture(y, x)}};
                 }),
        plain_lens(), 64);
}
// The same floor within two rows: from CoC -30 to 7 from one pixel to the next.
StressResult steep() {
    return against_reference(grey_ldi(window(40, 28),
                                      [](int x, int y) {
                                          const double t = std::clamp((y - 13.0) / 2, 0.0, 1.0);
                                          return Pixel{{1 / ((1 - t) * 0.95 + t * 0.025), texture(x, y)}};
                                      }),
                             plain_lens());
}

// 4000 surfaces of coverage 0.001 in every pixel, from before the focus to behind it; their coverage is 1 - 0.999^4000.
StressResult thousands() {
    StressResult result;
    const ThinLens lens = plain_lens();
    constexpr int count = 4000;
    constexpr float alpha = 0.001f, colour = 0.0005f;
    const Ldi ldi = grey_ldi(window(24, 20), [&](int, int) {
        Pixel pixel;
        for (int i = 0; i < count; ++i) pixel.push_back({4.0 + 0.0005 * i, colour, alpha});
        return pixel;
    });
    const Image image = gather(ldi, lens, result, 32);
    const long double covered = -std::expm1((long double)count * std::log1p(-(long double)alpha));
    const Imath::Box2i box = inner(ldi.windows, 6);
    result.error =
        std::max(off_from(image, 0, box, double(covered * (long double)colour / (long double)alpha)),
                 off_from(image, 1, box, double(covered)));
    return result;
}

// One lit pixel in a plane at that CoC. In A, R, G, B it is a lamp; in Y an ordinary pixel.
struct Lit {
    ThinLens lens = wide_lens();
    double coc;
    int size;
    Image image;
    StressResult result;

    Lit(double c, bool lamp, int points = 0) : coc(c), size(4 * int(c) + 24) {
        const auto pixel = [&](int x, int y) {
            return Pixel{{depth_of(lens, coc), x == size / 2 && y == size / 2 ? 1.0f : 0.0f}};
        };
        const Ldi ldi = lamp ? colour_ldi(window(size, size), pixel) : grey_ldi(window(size, size), pixel);
        image = gather(ldi, lens, result, points);
        result.energy = sum_of(image, 0) - 1;
    }
};

// The lamp's disc compared with exact areas, relative to the disc's own brightness.
StressResult lamp_disc(double coc) {
    Lit lit(coc, true);
    const Psf psf{{lit.size / 2 + 0.5, lit.size / 2 + 0.5}, coc, 1};
    for (int y = 0; y < lit.size; ++y)
        for (int x = 0; x < lit.size; ++x)
            lit.result.error = std::max(
                lit.result.error, std::abs(double(lit.image.at(0, x, y)) -
                                           psf_share(psf, {{double(x), double(y)}, {x + 1.0, y + 1.0}})));
    lit.result.error *= 3.14159265 * coc * coc;
    return lit.result;
}
StressResult lamp_3() { return lamp_disc(3); }
StressResult lamp_30() { return lamp_disc(30); }
StressResult lamp_100() { return lamp_disc(100); }

StressResult pixel_energy(double coc) {
    Lit lit(coc, false, 64);
    lit.result.error = std::abs(lit.result.energy);
    return lit.result;
}
StressResult pixel_5() { return pixel_energy(5); }
StressResult pixel_50() { return pixel_energy(50); }

// A wire one pixel wide, CoC 100 in front of a plane in focus. In every lens point's picture it covers one pixel,
// somewhere. In total this is less than a row of lens points can miss: its share sums to 1 along a row.
StressResult thin_wire() {
    StressResult result;
    const ThinLens lens = plain_lens();
    constexpr int width = 241, height = 32;
    const Ldi ldi = grey_ldi(window(width, height), [&](int x, int) {
        Pixel pixel{{5, 0}};
        if (x == width / 2) pixel.insert(pixel.begin(), {depth_of(lens, -100), 1});
        return pixel;
    });
    const Image image = gather(ldi, lens, result, 256);
    // Only lens points that move the wire up or down by less than half the picture's height keep it whole in the middle
    // rows. Beyond its ends the plane is seen instead, and unknown areas are left out. Per row:
    double worst = 0;
    for (int y = height / 2 - 1; y <= height / 2; ++y) {
        double share = 0;
        for (int x = 0; x < width; ++x) share += double(image.at(0, x, y));
        const double t = double(height / 2) / 100; // of the lens height that sees the wire in this row
        const double seen = 2 / 3.14159265 * (std::asin(t) + t * std::sqrt(1 - t * t));
        worst = std::max(worst, std::abs(share - seen) / seen);
    }
    result.error = worst;
    return result;
}

constexpr const char *normalised = "weights are renormalised; a few hundred are summed, each rounded at 6e-8";
constexpr const char *reorders =
    "the kernel only reorders the reference's sums: docs/tolerances.md, section 4";
constexpr const char *areas = "the disc of exact areas is a float formula: docs/tolerances.md, section 3";
constexpr const char *one_each =
    "each lens point moves the whole picture: what it brings sums to 1 but for float's rounding";

constexpr std::array cases{
    StressCase{"coc_1e-6", "a constant plane at CoC 1e-6 stays", rounding, normalised, constant_at_1e<-6>},
    StressCase{"coc_1e-3", "a constant plane at CoC 1e-3 stays", rounding, normalised, constant_at_1e<-3>},
    StressCase{"coc_half", "a constant plane just below and above CoC 1/2, where copying ends, stays",
               rounding, normalised, constant_at_the_threshold},
    StressCase{"coc_1", "a constant plane at CoC 1 stays", rounding, normalised, constant_at_1e<0>},
    StressCase{"coc_10", "a constant plane at CoC 10 stays", rounding, normalised, constant_at_1e<1>},
    StressCase{"coc_100", "a constant plane at CoC 100 stays", rounding, normalised, constant_at_1e<2>},
    StressCase{"coc_1e3", "a constant plane at CoC 1e3, larger than the picture, stays", rounding, normalised,
               constant_at_1e<3>},
    StressCase{"coc_1e4", "a constant plane at CoC 1e4 stays", rounding, normalised, constant_at_1e<4>},
    StressCase{"front_1", "a disc at CoC -1 before a plane in focus, against the reference", rounding,
               reorders, front_1},
    StressCase{"front_10", "a disc at CoC -10 before a plane in focus, against the reference", rounding,
               reorders, front_10},
    StressCase{"grazing_floor", "a floor through focus to the horizon, against the reference", rounding,
               reorders, grazing},
    StressCase{"steep_floor", "from CoC -30 to 7 within two rows, against the reference", rounding, reorders,
               steep},
    StressCase{
        "thousands_of_surfaces", "4000 surfaces in every pixel, against 1 - (1 - a)^4000", 1e-4,
        "4000 products and sums in float, each rounded at 6e-8, add up to at most 2.4e-4; at random to 4e-6",
        thousands},
    StressCase{"lamp_coc_3", "a lamp's disc at CoC 3, against exact areas", 1e-3, areas, lamp_3},
    StressCase{"lamp_coc_30", "a lamp's disc at CoC 30, against exact areas", 1e-3, areas, lamp_30},
    StressCase{"lamp_coc_100", "a lamp's disc at CoC 100, against exact areas", 1e-3, areas, lamp_100},
    StressCase{"pixel_coc_5", "a lit pixel at CoC 5 keeps its light", energy_bound, one_each, pixel_5},
    StressCase{"pixel_coc_50", "a lit pixel at CoC 50 keeps its light", energy_bound, one_each, pixel_50},
    StressCase{
        "thin_wire_coc_100", "the coverage of a wire one pixel wide at CoC -100, along a row", 0.1,
        "about 50 of 256 lens points see it in a row: their number is off by what an even set of 50 leaves",
        thin_wire},
};

} // namespace

std::span<const StressCase> blur_stress() { return cases; }

} // namespace sparselens::lab
