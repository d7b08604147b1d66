// The current quality of the whole chain from views to the picture, in dB of the tone-mapped picture against a
// ray-traced reference. Only this table holds it, and a command writes it:
//
//   lab/tests/floors/write.sh BIN_DIR
//
// The test fails if a figure is more than `floor_below` worse, and also if it is more than `floor_above` better, so that
// an improvement cannot be lost unnoticed (docs/tolerances.md, section 5). Where a figure is lowered, section 7 has the
// reason. Random changes of all values of the views by 2e-7 (4 roundings of a float) to 1e-5 move figures by 0.04 dB at
// most, except element doubled: 44.27 to 44.47 dB, because rounding decides how two pixels look. The table has the least.
//
// The scenes are those of dof-trace at 240x135 with their own lens, views of 16 samples per pixel, quality final. The
// references, in references/SCENE.exr, have 4096 rays per pixel. At 256 rays a reference is already above 47 dB, so its
// noise at 4096 rays is about 12 dB below the measured error:
//
//   dof-trace SCENE --size 240x135 --views 0 --spp 1 --reference 4096 -o FOLDER
//   oiiotool FOLDER/reference.exr --compression piz -o SCENE.exr
//
// Doubled: from five views of twice the size with 4 samples in each of their pixels, at normal quality. Fence in cells:
// with --lens-radius 0.15 --focus-distance 0.5, for which each tile is gathered in cells. Most of that error is the
// reference's own noise, 43 dB: a picture that is 45 dB from the truth would have 1 dB less. Mist as a deep file: with
// volumes, four layers, 16 rays per pixel.
#pragma once

namespace sparselens {

inline constexpr double floor_below = 0.1, floor_above = 0.3; // dB

struct Floor {
    const char *picture;
    double inside, border; // dB; the border is the 16 pixels along it
    double least_alpha;    // 1 for an opaque picture, 0 where parts are empty
};

inline constexpr Floor floors[] = {
    {"fence in cells", 41.57, 39.74, 1.0000},
    {"fence in cells, doubled", 41.21, 39.28, 1.0000},
    {"mist as a deep file", 58.18, 56.94, 1.0000},
    {"fence from five views", 38.52, 42.60, 1.0000},
    {"fence from one view", 30.98, 36.96, 1.0000},
    {"grass from five views", 37.61, 39.34, 1.0000},
    {"grass from one view", 36.05, 37.03, 1.0000},
    {"mist from five views", 54.70, 53.23, 1.0000},
    {"mist from one view", 49.12, 49.36, 1.0000},
    {"mirror from five views", 42.47, 43.27, 1.0000},
    {"mirror from one view", 41.45, 36.63, 1.0000},
    {"plane-mirror from five views", 48.54, 50.38, 1.0000},
    {"plane-mirror from one view", 32.88, 46.06, 1.0000},
    {"element from five views", 39.68, 47.33, 0.0000},
    {"element from one view", 36.11, 47.38, 0.0000},
    {"macro from five views", 37.60, 26.73, 1.0000},
    {"macro from one view", 32.76, 22.57, 1.0000},
    {"relief of macro", 56.46, 53.76, 1.0000},
    {"fence doubled", 44.01, 48.17, 1.0000},
    {"grass doubled", 43.17, 44.39, 1.0000},
    {"element doubled", 44.32, 54.44, 0.0000},
    {"macro doubled", 37.64, 26.77, 1.0000},
};

} // namespace sparselens
