// Luminance: what a light of some colour contributes to brightness, as a weighted sum of scene-linear R, G and B.
#pragma once

#include <array>

namespace sparselens {

// Weights of R, G and B (Rec. 709).
inline constexpr std::array luma_weights{0.2126, 0.7152, 0.0722};

} // namespace sparselens
