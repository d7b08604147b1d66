// What the whole way from views to the picture is worth today, in dB of the tone-mapped picture against a ray-traced
// reference. This table is the one place of it. A figure may fall by `floor_below` before the test fails, and is raised here
// when the picture becomes better, so that what was won cannot be lost unseen (docs/tolerances.md, section 5). Where it is lowered,
// section 8 has the reason.
//
//   build/bin/sparselens-lab-tests --gtest_filter='*Floors*'     prints each row as it is measured now
//
// The scenes are those of dof-trace at 240x135 with their own lens, views of 16 samples a pixel, quality final. Border: the 16
// pixels along it. The references, in references/SCENE.exr, are 4096 rays a pixel, which at 256 rays stand above 47 dB
// already, so their noise is some 12 dB below what is measured:
//
//   dof-trace SCENE --size 240x135 --views 0 --spp 1 --reference 4096 -o FOLDER
//   oiiotool FOLDER/reference.exr --compression piz -o SCENE.exr
#pragma once

namespace sparselens {

inline constexpr double floor_below = 0.3; // dB, 7 % of the squared error: other rounding may change as much

// dB inside and along the border.
struct Decibels {
    double inside, border;
};

struct MeasuredScene {
    const char *scene;
    Decibels five_views, one_view;
    double least_alpha; // of the picture from five views: 1 where the scene is opaque, 0 where nothing is
};

// clang-format off
inline constexpr MeasuredScene measured_scenes[] = {
    {"fence", {38.46, 42.56}, {31.05, 36.93}, 1},
    {"grass", {37.66, 39.35}, {36.02, 37.00}, 1},
    {"mist", {53.60, 52.34}, {49.21, 49.40}, 1},
    {"mirror", {42.49, 43.04}, {41.52, 36.68}, 1},
    {"plane-mirror", {47.90, 49.08}, {32.90, 46.15}, 1},
    {"element", {39.57, 47.32}, {36.15, 47.38}, 0},
    {"macro", {37.59, 26.74}, {33.30, 22.65}, 1},
};
// clang-format on

// The same from five views of twice the size and 4 samples for each of their pixels, at normal quality.
struct MeasuredDoubled {
    const char *scene;
    Decibels five_views;
};

inline constexpr MeasuredDoubled measured_doubled[] = {
    {"fence", {43.91, 48.01}},
    {"grass", {43.11, 44.31}},
    {"element", {44.45, 54.45}},
    {"macro", {37.55, 26.72}},
};

// Fence by --lens-radius 0.15 --focus-distance 0.5, where each tile is gathered in cells; and from views of twice the size. The
// reference's own noise, 43 dB, is most of that: a picture that is 45 dB from the truth would stand 1 dB lower.
inline constexpr Decibels measured_cells{41.55, 39.73}, measured_doubled_cells{41.25, 39.33};

// The steep relief of macro alone, before lamps of radiance 200.
inline constexpr double measured_macro_relief = 54.70;

// Mist as a deep file holds it, volumes and all: four layers, 16 rays a pixel.
inline constexpr Decibels measured_deep_mist{57.42, 56.85};

} // namespace sparselens
