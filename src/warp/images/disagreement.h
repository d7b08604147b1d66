// How far the views of a block of pixels disagree, if what they show lies on its surface.
#pragma once

#include <cstdint>

namespace sparselens {

enum class Disagreement : std::uint8_t {
    none,   // no more than noise
    slight, // like an image that moves a little against its surface, or a sharp edge of texture
    clear   // more than that
};

} // namespace sparselens
