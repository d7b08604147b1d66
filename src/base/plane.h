// The values of one channel of a picture, bit by bit in little memory: one value if all are the same, as in the
// coverage of an opaque picture; halves if these hold every value, as colours of most files; otherwise floats.
#pragma once

#include <half.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// Halves (16 bits) of floats, bit by bit.
inline std::uint16_t bits_of_half(float value) { return Imath::half(value).bits(); } // rounded

inline float of_half(std::uint16_t bits) { return float(Imath::half(Imath::half::FromBits, bits)); }

// Whether a half holds every bit of the value.
inline bool is_half(float value) {
    return std::bit_cast<std::uint32_t>(of_half(bits_of_half(value))) == std::bit_cast<std::uint32_t>(value);
}

class Plane {
public:
    Plane() = default;
    Plane(Plane &&) = default; // a copy would refer to the values of the original
    Plane &operator=(Plane &&) = default;

    // Copies the values and packs them.
    static Plane packed(std::span<const float> values);
    // Refers to the values, which must outlive the plane.
    static Plane of(std::span<const float> values);

    float operator[](std::size_t i) const { return floats_ ? floats_[i & mask_] : of_half(halves_[i]); }

    // Copies the values of out.size() pixels, beginning at pixel `first`.
    void copy(std::size_t first, std::span<float> out) const;

    std::size_t bytes() const {
        return halves_.size() * sizeof(halves_[0]) + own_.size() * sizeof(float);
    } // held by this plane

private:
    std::vector<std::uint16_t> halves_;
    std::vector<float> own_;
    const float *floats_ = nullptr;      // `own_`, or values of others; null: halves
    std::size_t mask_ = ~std::size_t{0}; // 0: one value
};

} // namespace sparselens
