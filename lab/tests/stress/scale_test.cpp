#include "deep/flatten.h"
#include "dof/selective/selective.h"
#include "lab/methods/scatter.h"
#include "lab/tests/stress/stress.h"

namespace sparselens::stress {

namespace {

// A scene of the plain lens, in a unit of length that is `unit` of its own units. With colours a few pixels are lamps.
Ldi scene_in(double unit, bool colours) {
    const auto pixel = [=](int x, int y) {
        const bool front = (x - 30) * (x - 30) + (y - 24) * (y - 24) < 150;
        const float light = x % 17 == 0 && y % 13 == 0 ? 40 : texture(x, y);
        return Pixel{
            {depth_of(plain_lens, front ? -5 : 5 + 0.02 * x) / unit, light, 1, 0.4f * texture(y, x)}};
    };
    return colours ? colour_ldi(80, 56, pixel) : grey_ldi(80, 56, pixel);
}

Image picture_in(double unit, bool colours) {
    ThinLens lens = plain_lens;
    lens.radius /= unit;
    lens.focus /= unit;
    return gather(scene_in(unit, colours), lens, 0);
}
Result in_unit(double unit, bool colours) {
    const Image expected = picture_in(1, colours), image = picture_in(unit, colours);
    return {off_from(image, expected), sum_of(image, 0) / sum_of(expected, 0) - 1};
}

ThinLens of_radius(double radius) {
    ThinLens lens = plain_lens;
    lens.radius = radius;
    return lens;
}
Result radius_so_small() {
    const Ldi ldi = scene_in(1, true);
    return {off_from(gather(ldi, of_radius(1e-300), 0), flatten(ldi))};
}

using Gather = Image (*)(const Ldi &, const ThinLens &);
Result constant_by(Gather gather_by, double coc) {
    constexpr ThinLens lens{.radius = 100, .focal_px = 1000, .focus = 5};
    const Ldi ldi = colour_ldi(48, 32, [&](int, int) { return Pixel{{depth_of(lens, coc), 0.3f}}; });
    return against_plane(gather_by(ldi, lens), double(0.3f));
}
Image by_selective(const Ldi &ldi, const ThinLens &lens) {
    Progress silent;
    return selective_gather(ldi, lens, {}, silent);
}
Image by_scatter(const Ldi &ldi, const ThinLens &lens) {
    Progress silent;
    return scatter(ldi, lens, {}, silent);
}

constexpr Limit float_depth{
    1e-4, "a depth stored as float is off by 6e-8, its CoC by 1e-6 pixels: at an edge of 40 that is 4e-5"};
constexpr Limit constant{1e-4, "docs/tolerances.md, section 3: a constant picture stays constant"};

constexpr Case cases[] = {
    {"millimetres", "a scene in millimetres, against the same in metres", float_depth,
     [] { return in_unit(1e-3, true); }},
    {"kilometres", "a scene in kilometres, against the same in metres", float_depth,
     [] { return in_unit(1e3, true); }},
    {"2^-20",
     "a scene in units of 2^-20, against the same in metres",
     {0, "powers of two scale floats without rounding"},
     [] { return in_unit(0x1p-20, false); }},
    {"radius_1e-300",
     "a lens of next to no radius gives the flattened picture",
     {0, "tiles are copied"},
     radius_so_small},
    // Everything out of focus is spread over more than the picture.
    {"radius_1e6",
     "a constant plane through a lens of radius 1e6 stays",
     {rounding, "sums in float, each rounded at 6e-8"},
     [] { return constant_plane(of_radius(1e6), 5.5, 0.3); }},
    {"selective_coc_1e-6", "--method selective: a constant plane at CoC 1e-6 stays", constant,
     [] { return constant_by(by_selective, 1e-6); }},
    {"selective_coc_30", "--method selective: a constant plane at CoC 30 stays", constant,
     [] { return constant_by(by_selective, 30); }},
    {"selective_coc_1e4", "--method selective: a constant plane at CoC 1e4 stays", constant,
     [] { return constant_by(by_selective, 1e4); }},
    {"scatter_coc_1e-6", "--method scatter: a constant plane at CoC 1e-6 stays", constant,
     [] { return constant_by(by_scatter, 1e-6); }},
    {"scatter_coc_30", "--method scatter: a constant plane at CoC 30 stays", constant,
     [] { return constant_by(by_scatter, 30); }},
    {"scatter_coc_1e4", "--method scatter: a constant plane at CoC 1e4 stays", constant,
     [] { return constant_by(by_scatter, 1e4); }},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(scale, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
