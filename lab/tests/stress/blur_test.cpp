#include "lab/tests/stress/stress.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens::stress {

namespace {

// A lens that can blur by any radius behind the focus.
constexpr ThinLens wide_lens{.radius = 100, .focal_px = 1000, .focus = 5};

Result constant_at(double coc) { return constant_plane(wide_lens, depth_of(wide_lens, coc), 0.3, 128, 96); }
Result at_the_threshold() {
    const Result below = constant_plane(plain_lens, depth_of(plain_lens, 0.4999), 0.3);
    Result above = constant_plane(plain_lens, depth_of(plain_lens, 0.5001), 0.3);
    above.error = std::max(above.error, below.error);
    return above;
}

// A texture in front of a texture in focus; all samples of the front one have this CoC.
Result front_at(double coc) {
    return against_reference(grey_ldi(40, 28, [&](int x, int y) {
        const bool front = (x - 20) * (x - 20) + (y - 14) * (y - 14) < 60;
        return Pixel{{front ? depth_of(plain_lens, coc) : 5, texture(x, y)}};
    }));
}

// A floor that rises from before the focus to the horizon within 28 rows.
Result grazing_floor() {
    return against_reference(grey_ldi(40, 28, [](int x, int y) {
        return Pixel{{(120 + 0.1 * x) / (28.5 - y), texture(x, y), 1, 0.3f * texture(y, x)}};
    }));
}
// The same floor within two rows: from CoC -30 to 7 from one pixel to the next.
Result steep_floor() {
    return against_reference(grey_ldi(40, 28, [](int x, int y) {
        const double t = std::clamp((y - 13.0) / 2, 0.0, 1.0);
        return Pixel{{1 / ((1 - t) * 0.95 + t * 0.025), texture(x, y)}};
    }));
}

// 4000 surfaces of coverage 0.001 in every pixel, from before the focus to behind it; their coverage is 1 - 0.999^4000.
Result thousands() {
    constexpr int count = 4000;
    constexpr float alpha = 0.001f, colour = 0.0005f;
    const Ldi ldi = grey_ldi(24, 20, [&](int, int) {
        Pixel pixel;
        for (int i = 0; i < count; ++i) pixel.push_back({4.0 + 0.0005 * i, colour, alpha});
        return pixel;
    });
    const long double covered = -std::expm1((long double)count * std::log1p(-(long double)alpha));
    const double light = double(covered * (long double)colour / (long double)alpha);
    return {off_plane(gather(ldi, plain_lens, 32), light, double(covered), 6)};
}

// The picture of one lit pixel in the middle of a plane at that CoC: in A, R, G, B a lamp, in Y an ordinary pixel.
Image lit_pixel(int coc, bool lamp) {
    const int size = 4 * coc + 24;
    const auto pixel = [&](int x, int y) {
        return Pixel{{depth_of(wide_lens, coc), x == size / 2 && y == size / 2 ? 1.0f : 0.0f}};
    };
    return lamp ? gather(colour_ldi(size, size, pixel), wide_lens, 0)
                : gather(grey_ldi(size, size, pixel), wide_lens);
}

// The lamp's disc compared with exact areas, relative to the disc's own brightness.
Result lamp_disc(int coc) {
    const Image image = lit_pixel(coc, true);
    const int size = image.windows.width();
    const Psf psf{{size / 2 + 0.5, size / 2 + 0.5}, double(coc), 1};
    Result result{.energy = sum_of(image, 0) - 1};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double share = psf_share(psf, {{double(x), double(y)}, {x + 1.0, y + 1.0}});
            result.error = std::max(result.error, std::abs(double(image.at(0, x, y)) - share));
        }
    result.error *= std::numbers::pi * coc * coc;
    return result;
}

Result pixel_energy(int coc) {
    const double energy = sum_of(lit_pixel(coc, false), 0) - 1;
    return {std::abs(energy), energy};
}

// A wire one pixel wide, CoC 100 in front of a plane in focus. In every lens point's picture it covers one pixel,
// somewhere. In total this is less than a row of lens points can miss: its share sums to 1 along a row.
Result thin_wire() {
    constexpr int width = 241, height = 32;
    const Ldi ldi = grey_ldi(width, height, [&](int x, int) {
        const Spot plane{5, 0};
        return x == width / 2 ? Pixel{{depth_of(plain_lens, -100)}, plane} : Pixel{plane};
    });
    const Image image = gather(ldi, plain_lens, 256);
    // Only lens points that move the wire up or down by less than half the picture's height keep it whole in the middle
    // rows. Beyond its ends the plane is seen instead, and unknown areas are left out. Per row:
    Result result;
    for (int y = height / 2 - 1; y <= height / 2; ++y) {
        double share = 0;
        for (int x = 0; x < width; ++x) share += double(image.at(0, x, y));
        const double t = double(height / 2) / 100; // of the lens height that sees the wire in this row
        const double seen = 2 / std::numbers::pi * (std::asin(t) + t * std::sqrt(1 - t * t));
        result.error = std::max(result.error, std::abs(share - seen) / seen);
    }
    return result;
}

constexpr Limit products{
    1e-4,
    "4000 products and sums in float, each rounded at 6e-8, add up to at most 2.4e-4; at random to 4e-6"};
constexpr Limit areas{1e-3, "the disc of exact areas is a float formula: docs/tolerances.md, section 3"};
constexpr Limit one_each{
    energy_bound,
    "each lens point moves the whole picture: what it brings sums to 1 but for float's rounding"};
constexpr Limit even_set{
    0.1, "about 50 of 256 lens points see it in a row: their number is off by what an even set of 50 leaves"};

constexpr Case cases[] = {
    {"coc_1e-6", "a constant plane at CoC 1e-6 stays", normalised, [] { return constant_at(1e-6); }},
    {"coc_1e-3", "a constant plane at CoC 1e-3 stays", normalised, [] { return constant_at(1e-3); }},
    {"coc_half", "a constant plane just below and above CoC 1/2, where copying ends, stays", normalised,
     at_the_threshold},
    {"coc_1", "a constant plane at CoC 1 stays", normalised, [] { return constant_at(1); }},
    {"coc_10", "a constant plane at CoC 10 stays", normalised, [] { return constant_at(10); }},
    {"coc_100", "a constant plane at CoC 100 stays", normalised, [] { return constant_at(100); }},
    {"coc_1e3", "a constant plane at CoC 1e3, larger than the picture, stays", normalised,
     [] { return constant_at(1e3); }},
    {"coc_1e4", "a constant plane at CoC 1e4 stays", normalised, [] { return constant_at(1e4); }},
    {"front_1", "a disc at CoC -1 before a plane in focus, against the reference", reorders,
     [] { return front_at(-1); }},
    {"front_10", "a disc at CoC -10 before a plane in focus, against the reference", reorders,
     [] { return front_at(-10); }},
    {"grazing_floor", "a floor through focus to the horizon, against the reference", reorders, grazing_floor},
    {"steep_floor", "from CoC -30 to 7 within two rows, against the reference", reorders, steep_floor},
    {"thousands_of_surfaces", "4000 surfaces in every pixel, against 1 - (1 - a)^4000", products, thousands},
    {"lamp_coc_3", "a lamp's disc at CoC 3, against exact areas", areas, [] { return lamp_disc(3); }},
    {"lamp_coc_30", "a lamp's disc at CoC 30, against exact areas", areas, [] { return lamp_disc(30); }},
    {"lamp_coc_100", "a lamp's disc at CoC 100, against exact areas", areas, [] { return lamp_disc(100); }},
    {"pixel_coc_5", "a lit pixel at CoC 5 keeps its light", one_each, [] { return pixel_energy(5); }},
    {"pixel_coc_50", "a lit pixel at CoC 50 keeps its light", one_each, [] { return pixel_energy(50); }},
    {"thin_wire_coc_100", "the coverage of a wire one pixel wide at CoC -100, along a row", even_set,
     thin_wire},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(blur, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
