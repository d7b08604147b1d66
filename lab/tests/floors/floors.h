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
    {"fence in cells, doubled", 41.23, 39.29, 1.0000},
    {"mist as a deep file", 58.20, 56.91, 1.0000},
    {"fence from five views", 38.46, 42.52, 1.0000},
    {"fence from one view", 31.01, 36.93, 1.0000},
    {"grass from five views", 37.60, 39.36, 1.0000},
    {"grass from one view", 36.01, 37.00, 1.0000},
    {"mist from five views", 54.70, 53.14, 1.0000},
    {"mist from one view", 49.12, 49.36, 1.0000},
    {"mirror from five views", 42.41, 43.23, 1.0000},
    {"mirror from one view", 41.41, 36.62, 1.0000},
    {"plane-mirror from five views", 48.49, 50.29, 1.0000},
    {"plane-mirror from one view", 32.89, 46.03, 1.0000},
    {"element from five views", 39.63, 47.32, 0.0000},
    {"element from one view", 36.14, 47.38, 0.0000},
    {"macro from five views", 37.60, 26.72, 1.0000},
    {"macro from one view", 32.75, 22.57, 1.0000},
    {"relief of macro", 56.55, 53.84, 1.0000},
    {"fence doubled", 43.92, 48.02, 1.0000},
    {"grass doubled", 43.14, 44.35, 1.0000},
    {"element doubled", 44.27, 54.45, 0.0000},
    {"macro doubled", 37.64, 26.77, 1.0000},
};

} // namespace sparselens
