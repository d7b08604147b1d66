// What counts as full coverage, and as none.
#pragma once

namespace sparselens {

// Half's last steps below 1 are rounding, not coverage; less than 1/2048 of a pixel left over is rounding too.
inline bool is_opaque(float alpha) { return alpha >= 0.9995f; }
inline bool lets_through(double transmittance) { return transmittance >= 1.0 / 2048; }

} // namespace sparselens
