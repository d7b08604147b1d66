// The current quality of the whole chain from views to the picture, in dB of the tone-mapped picture against a
// ray-traced reference. Only this table holds it. A figure may fall by `floor_below` before the test fails, and is
// raised here when the picture becomes better, so that an improvement cannot be lost unnoticed (docs/tolerances.md,
// section 5). Where it is lowered, section 7 has the reason.
//
//   build/bin/sparselens-lab-tests --gtest_filter='*Floors*'     prints each row as it is measured now
//
// The scenes are those of dof-trace at 240x135 with their own lens, views of 16 samples per pixel, quality final.
// Border: the 16 pixels along it. The references, in references/SCENE.exr, have 4096 rays per pixel. At 256 rays a
// reference is already above 47 dB, so its noise at 4096 rays is about 12 dB below the measured error:
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
    double least_alpha; // of the picture from five views: 1 for an opaque scene, 0 for empty parts
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

// The same from five views of twice the size with 4 samples in each of their pixels, at normal quality.
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

// Fence with --lens-radius 0.15 --focus-distance 0.5, for which each tile is gathered in cells; and from views of twice
// the size. Most of the error is the reference's own noise, 43 dB: a picture that is 45 dB from the truth would have 1
// dB less.
inline constexpr Decibels measured_cells{41.55, 39.73}, measured_doubled_cells{41.25, 39.33};

// Only the steep relief of macro, before lamps of radiance 200.
inline constexpr double measured_macro_relief = 54.70;

// Mist as a deep file with volumes: four layers, 16 rays per pixel.
inline constexpr Decibels measured_deep_mist{57.42, 56.85};

} // namespace sparselens
