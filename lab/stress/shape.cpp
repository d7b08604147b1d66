#include "dof/lens/lens_gather.h"
#include "lab/stress/scenes.h"

#include <algorithm>
#include <array>

namespace sparselens::lab {

namespace {

using namespace stress;

constexpr double rounding = 1e-5; // of sums over lens points, in float (docs/tolerances.md, section 4)

// A texture with a disc in front of it, defined for any window.
Pixel scene_at(int x, int y) {
    const ThinLens lens = plain_lens();
    const bool front = (x - 20) * (x - 20) + (y - 14) * (y - 14) < 50;
    const double coc = (front ? -3 : 4) + 0.01 * double(texture(x, y + 50)); // no two overlap at one depth
    return {{depth_of(lens, coc), texture(x, y), 1, 0.4f * texture(y, x)}};
}

StressResult of_size(int width, int height) {
    return against_reference(grey_ldi(window(width, height), scene_at), plain_lens());
}
StressResult size_1x1() { return of_size(1, 1); }
StressResult size_1x40() { return of_size(1, 40); }
StressResult size_40x1() { return of_size(40, 1); }
StressResult size_odd() { return of_size(65, 9); }

template <int Width, int Height>
StressResult constant_of_size() {
    const ThinLens lens = plain_lens();
    return constant_plane(lens, depth_of(lens, 5), 0.3, Width, Height);
}

StressResult in_window(const Imath::Box2i &display, const Imath::Box2i &data, float aspect = 1) {
    ThinLens lens = plain_lens();
    lens.pixel_aspect = double(aspect);
    return against_reference(grey_ldi({display, data, aspect}, scene_at), lens);
}
const Imath::Box2i frame({0, 0}, {39, 27});
StressResult data_larger() { return in_window({{8, 8}, {31, 19}}, frame); }
StressResult data_smaller() { return in_window(frame, {{11, 7}, {30, 22}}); }
StressResult data_outside() { return in_window({{100, 100}, {139, 127}}, frame); }
StressResult negative_origin() { return in_window({{-30, -20}, {9, 7}}, {{-30, -20}, {9, 7}}); }
StressResult wide_pixels() { return in_window(frame, frame, 2); }
StressResult high_pixels() { return in_window(frame, frame, 0.5f); }

// A window far from the origin shows the same as at the origin, because floats count from the window's own corner.
StressResult far_origin() {
    StressResult result;
    const Imath::V2i away(1 << 28, -(1 << 28));
    const Ldi near_by = grey_ldi(window(40, 28), scene_at);
    Ldi far_off = near_by;
    far_off.windows = {{away, away + frame.max}, {away, away + frame.max}, 1};
    const Image expected = gather(near_by, plain_lens(), result);
    Image image = gather(far_off, plain_lens(), result);
    image.windows = near_by.windows;
    result.error = off_from(image, expected, frame);
    return result;
}

// The picture of part of the data window equals that part of the whole picture, far from the part's border.
StressResult part_of_picture() {
    StressResult result;
    Progress silent;
    const ThinLens lens = plain_lens();
    const Ldi ldi = grey_ldi(window(160, 140), [&](int x, int y) {
        return Pixel{{depth_of(lens, 3 + texture(x, y)), texture(y, x)}};
    });
    const Image whole = gather(ldi, lens, result);
    const Imath::Box2i part({64, 64}, {127, 127}); // one of its tiles
    const Image alone = lens_gather(ldi, lens, part, {.lens_samples = 64}, silent);
    result.error = off_from(alone, crop(whole, part), part);
    return result;
}

StressResult empty_picture() {
    StressResult result;
    const Ldi ldi = grey_ldi(window(64, 48), [](int, int) { return Pixel{}; });
    const Image image = gather(ldi, plain_lens(), result);
    result.error = std::max(off_from(image, 0, ldi.windows.data, 0), off_from(image, 1, ldi.windows.data, 0));
    return result;
}

constexpr const char *normalised = "weights are renormalised; a few hundred are summed, each rounded at 6e-8";
constexpr const char *reorders =
    "the kernel only reorders the reference's sums: docs/tolerances.md, section 4";

constexpr std::array cases{
    StressCase{"1x1", "a picture of one pixel, against the reference", rounding, reorders, size_1x1},
    StressCase{"1x40", "a picture one pixel wide, against the reference", rounding, reorders, size_1x40},
    StressCase{"40x1", "a picture one pixel high, against the reference", rounding, reorders, size_40x1},
    StressCase{"65x9", "a picture one pixel wider than a tile, against the reference", rounding, reorders,
               size_odd},
    StressCase{"16384_wide", "a constant plane of 16384x2 pixels stays", rounding, normalised,
               constant_of_size<16384, 2>},
    StressCase{"16384_high", "a constant plane of 2x16384 pixels stays", rounding, normalised,
               constant_of_size<2, 16384>},
    StressCase{"data_larger", "data window larger than the display window, against the reference", rounding,
               reorders, data_larger},
    StressCase{"data_smaller", "data window smaller than the display window, against the reference", rounding,
               reorders, data_smaller},
    StressCase{"data_outside", "data window outside the display window, against the reference", rounding,
               reorders, data_outside},
    StressCase{"negative_origin", "windows that begin below 0, against the reference", rounding, reorders,
               negative_origin},
    StressCase{"far_origin", "windows 2^28 pixels off show what they show at the origin", 0,
               "the same arithmetic from the window's corner", far_origin},
    StressCase{"pixel_aspect_2", "pixels twice as wide as high, against the reference", rounding, reorders,
               wide_pixels},
    StressCase{"pixel_aspect_0.5", "pixels half as wide as high, against the reference", rounding, reorders,
               high_pixels},
    StressCase{"one_tile_alone", "a tile gathered alone is that tile of the picture", 0,
               "each tile is gathered alone anyway", part_of_picture},
    StressCase{"empty", "a picture without samples is transparent", 0, "nothing to sum", empty_picture},
};

} // namespace

std::span<const StressCase> shape_stress() { return cases; }

} // namespace sparselens::lab
