// Up to which difference of perceptive depth, in pixels, samples show one surface.
#pragma once

namespace sparselens {

// Seen from the rim of the lens, samples that differ by less move apart by less than half a pixel, so that pictures of both
// fall into the same pixels.
inline constexpr float one_surface_px = 0.5f;

// Samples a few pixels apart on a mirror or glass.
inline constexpr float one_mirror_px = 1;

} // namespace sparselens
