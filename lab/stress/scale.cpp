#include "deep/flatten.h"
#include "dof/selective/selective.h"
#include "lab/methods/scatter.h"
#include "lab/stress/scenes.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace sparselens::lab {

namespace {

using namespace stress;

// The scene of the plain lens, in a unit of length that is `unit` of its own units.
Ldi scene_in(double unit, bool colours) {
    const ThinLens lens = plain_lens();
    const auto pixel = [=](int x, int y) {
        const bool front = (x - 30) * (x - 30) + (y - 24) * (y - 24) < 150;
        const float light = x % 17 == 0 && y % 13 == 0 ? 40 : texture(x, y);
        return Pixel{{depth_of(lens, front ? -5 : 5 + 0.02 * x) / unit, light, 1, 0.4f * texture(y, x)}};
    };
    return colours ? colour_ldi(window(80, 56), pixel) : grey_ldi(window(80, 56), pixel);
}
ThinLens lens_in(double unit) {
    ThinLens lens = plain_lens();
    lens.radius /= unit;
    lens.focus /= unit;
    return lens;
}

StressResult in_unit(double unit, bool colours) {
    StressResult result;
    const Image expected = gather(scene_in(1, colours), lens_in(1), result, 0);
    const Image image = gather(scene_in(unit, colours), lens_in(unit), result, 0);
    result.error = off_from(image, expected, expected.windows.data);
    result.energy = sum_of(image, 0) / sum_of(expected, 0) - 1;
    return result;
}
StressResult millimetres() { return in_unit(1e-3, true); }
StressResult kilometres() { return in_unit(1e3, true); }
StressResult binary_units() { return in_unit(0x1p-20, false); }

StressResult radius_so_small() {
    StressResult result;
    const Ldi ldi = scene_in(1, true);
    ThinLens lens = plain_lens();
    lens.radius = 1e-300;
    result.error = off_from(gather(ldi, lens, result, 0), flatten(ldi), ldi.windows.data);
    return result;
}

// With a lens as wide as the scene is deep, everything out of focus is spread over more than the picture.
StressResult radius_large() {
    ThinLens lens = plain_lens();
    lens.radius = 1e6;
    return constant_plane(lens, 5.5, 0.3);
}

using Gather = Image (*)(const Ldi &, const ThinLens &, Progress &);
StressResult constant_by(Gather gather_by, double coc) {
    StressResult result;
    Progress silent;
    const ThinLens lens{.radius = 100, .focal_px = 1000, .focus = 5};
    const Ldi ldi = colour_ldi(window(48, 32), [&](int, int) { return Pixel{{depth_of(lens, coc), 0.3f}}; });
    const auto start = std::chrono::steady_clock::now();
    const Image image = gather_by(ldi, lens, silent);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.pixels = double(ldi.windows.pixels());
    result.error = std::max(off_from(image, 0, image.windows.data, double(0.3f)),
                            off_from(image, 3, image.windows.data, 1));
    result.energy = sum_of(image, 0) / (double(0.3f) * result.pixels) - 1;
    return result;
}
Image by_selective(const Ldi &ldi, const ThinLens &lens, Progress &p) {
    return selective_gather(ldi, lens, {}, p);
}
Image by_scatter(const Ldi &ldi, const ThinLens &lens, Progress &p) { return scatter(ldi, lens, {}, p); }
StressResult selective_1() { return constant_by(by_selective, 1e-6); }
StressResult selective_2() { return constant_by(by_selective, 30); }
StressResult selective_3() { return constant_by(by_selective, 1e4); }
StressResult scatter_1() { return constant_by(by_scatter, 1e-6); }
StressResult scatter_2() { return constant_by(by_scatter, 30); }
StressResult scatter_3() { return constant_by(by_scatter, 1e4); }

constexpr const char *float_depth =
    "a depth stored as float is off by 6e-8, its CoC by 1e-6 pixels: at an edge of 40 that is 4e-5";
constexpr const char *constant = "docs/tolerances.md, section 3: a constant picture stays constant";

constexpr std::array cases{
    StressCase{"millimetres", "a scene in millimetres, against the same in metres", 1e-4, float_depth,
               millimetres},
    StressCase{"kilometres", "a scene in kilometres, against the same in metres", 1e-4, float_depth,
               kilometres},
    StressCase{"2^-20", "a scene in units of 2^-20, against the same in metres", 0,
               "powers of two scale floats without rounding", binary_units},
    StressCase{"radius_1e-300", "a lens of next to no radius gives the flattened picture", 0,
               "tiles are copied", radius_so_small},
    StressCase{"radius_1e6", "a constant plane through a lens of radius 1e6 stays", 1e-5,
               "sums in float, each rounded at 6e-8", radius_large},
    StressCase{"selective_coc_1e-6", "--method selective: a constant plane at CoC 1e-6 stays", 1e-4, constant,
               selective_1},
    StressCase{"selective_coc_30", "--method selective: a constant plane at CoC 30 stays", 1e-4, constant,
               selective_2},
    StressCase{"selective_coc_1e4", "--method selective: a constant plane at CoC 1e4 stays", 1e-4, constant,
               selective_3},
    StressCase{"scatter_coc_1e-6", "--method scatter: a constant plane at CoC 1e-6 stays", 1e-4, constant,
               scatter_1},
    StressCase{"scatter_coc_30", "--method scatter: a constant plane at CoC 30 stays", 1e-4, constant,
               scatter_2},
    StressCase{"scatter_coc_1e4", "--method scatter: a constant plane at CoC 1e4 stays", 1e-4, constant,
               scatter_3},
};

} // namespace

std::span<const StressCase> scale_stress() { return cases; }

} // namespace sparselens::lab
