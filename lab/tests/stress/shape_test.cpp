#include "dof/lens/lens_gather.h"
#include "lab/tests/stress/stress.h"

namespace sparselens::stress {

namespace {

// A texture with a disc in front of it, defined for any window.
Pixel scene_at(int x, int y) {
    const bool front = (x - 20) * (x - 20) + (y - 14) * (y - 14) < 50;
    const double coc = (front ? -3 : 4) + 0.01 * double(texture(x, y + 50)); // no two overlap at one depth
    return {{depth_of(plain_lens, coc), texture(x, y), 1, 0.4f * texture(y, x)}};
}

Result of_size(int width, int height) { return against_reference(grey_ldi(width, height, scene_at)); }

Result constant_of_size(int width, int height) {
    return constant_plane(plain_lens, depth_of(plain_lens, 5), 0.3, width, height);
}

Result in_window(const Imath::Box2i &display, const Imath::Box2i &data, float aspect = 1) {
    ThinLens lens = plain_lens;
    lens.pixel_aspect = double(aspect);
    return against_reference(grey_ldi({display, data, aspect}, scene_at), lens);
}
const Imath::Box2i frame({0, 0}, {39, 27});

// A window far from the origin shows the same as at the origin, because floats count from the window's own corner.
Result far_origin() {
    const Imath::V2i away(1 << 28, -(1 << 28));
    const Ldi near_by = grey_ldi(40, 28, scene_at);
    Ldi far_off = near_by;
    far_off.windows = {{away, away + frame.max}, {away, away + frame.max}, 1};
    Image image = gather(far_off, plain_lens);
    image.windows = near_by.windows;
    return {off_from(image, gather(near_by, plain_lens))};
}

// The picture of part of the data window equals that part of the whole picture, far from the part's border.
Result part_of_picture() {
    Progress silent;
    const Ldi ldi = grey_ldi(160, 140, [](int x, int y) {
        return Pixel{{depth_of(plain_lens, 3 + texture(x, y)), texture(y, x)}};
    });
    const Imath::Box2i part({64, 64}, {127, 127}); // one of its tiles
    const Image alone = lens_gather(ldi, plain_lens, part, {.lens_samples = 64}, silent);
    return {off_from(alone, crop(gather(ldi, plain_lens), part))};
}

Result empty_picture() {
    const Ldi ldi = grey_ldi(64, 48, [](int, int) { return Pixel{}; });
    return {off_plane(gather(ldi, plain_lens), 0, 0)};
}

constexpr Case cases[] = {
    {"1x1", "a picture of one pixel, against the reference", reorders, [] { return of_size(1, 1); }},
    {"1x40", "a picture one pixel wide, against the reference", reorders, [] { return of_size(1, 40); }},
    {"40x1", "a picture one pixel high, against the reference", reorders, [] { return of_size(40, 1); }},
    {"65x9", "a picture one pixel wider than a tile, against the reference", reorders,
     [] { return of_size(65, 9); }},
    {"16384_wide", "a constant plane of 16384x2 pixels stays", normalised,
     [] { return constant_of_size(16384, 2); }},
    {"16384_high", "a constant plane of 2x16384 pixels stays", normalised,
     [] { return constant_of_size(2, 16384); }},
    {"data_larger", "data window larger than the display window, against the reference", reorders,
     [] {
         return in_window({{8, 8}, {31, 19}}, frame);
     }},
    {"data_smaller", "data window smaller than the display window, against the reference", reorders,
     [] {
         return in_window(frame, {{11, 7}, {30, 22}});
     }},
    {"data_outside", "data window outside the display window, against the reference", reorders,
     [] {
         return in_window({{100, 100}, {139, 127}}, frame);
     }},
    {"negative_origin", "windows that begin below 0, against the reference", reorders,
     [] {
         return in_window({{-30, -20}, {9, 7}}, {{-30, -20}, {9, 7}});
     }},
    {"far_origin",
     "windows 2^28 pixels off show what they show at the origin",
     {0, "the same arithmetic from the window's corner"},
     far_origin},
    {"pixel_aspect_2", "pixels twice as wide as high, against the reference", reorders,
     [] { return in_window(frame, frame, 2); }},
    {"pixel_aspect_0.5", "pixels half as wide as high, against the reference", reorders,
     [] { return in_window(frame, frame, 0.5f); }},
    {"one_tile_alone",
     "a tile gathered alone is that tile of the picture",
     {0, "each tile is gathered alone anyway"},
     part_of_picture},
    {"empty", "a picture without samples is transparent", {0, "nothing to sum"}, empty_picture},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(shape, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
