// Four channels in one register. They are loaded and stored unchanged, and calculated like single floats.
#pragma once

#include <cstring>

namespace sparselens {

using Float4 [[gnu::vector_size(16)]] = float;

inline Float4 load4(const float *from) {
    Float4 value;
    std::memcpy(&value, from, sizeof(value));
    return value;
}
inline void store4(float *to, Float4 value) { std::memcpy(to, &value, sizeof(value)); }

} // namespace sparselens
