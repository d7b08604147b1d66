// How lamps move from moment to moment of a shutter.
//
// A lamp that moves fast is a streak, and S moments of it would be S discs. So each moment spreads its lamps along its
// part of their paths. A lamp is found again in the next moment by its light, colour and depth, if it moves by less
// than half of the distance to the next lamp at its depth. Other lamps stay discs.
//
// Positions are in pixels of the moments' pictures (EXR coordinates), times in moments.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

struct LampPathTuning {
    // Pixels. Parts of one lamp lie side by side, no farther apart.
    static constexpr float beside_px = 1.5f;
    // Ratios of depths: of parts of one lamp, and of one lamp in two moments.
    static constexpr float one_depth = 1.1f, depth_change = 1.25f;
    // A ratio: how much brighter or darker a lamp may become. Two lamps that merge are twice as bright.
    static constexpr float light_change = 1.6f;
    // The cosine between the colours of one lamp in two moments, as vectors of R, G and B.
    static constexpr float same_colour = 0.97f;
    // A lamp can be followed if the next lamp that is about as bright, at its depth, is this many times as far away as
    // it moves. If that lamp is nearer, one may be taken for the other, as the spokes of a wheel in a film.
    static constexpr float apart = 2;
    // The bend of a path, as a share of the velocity: a turn by 53 degrees from moment to moment.
    static constexpr float most_bend = 0.5f;
    // Lamps of a moment that are followed: the brightest. Noise in the dark stands out, too.
    static constexpr std::size_t most_lamps = 4096;
    // Parts of the lamps of a moment. More are a texture, and none of them is followed.
    static constexpr std::size_t most_parts = 1 << 18;
    // Pixels for each moment. A lamp that moves less stays a disc.
    static constexpr float least_px = 0.25f;
};

// A part of a lamp, for example one pixel of it.
struct LampPart {
    Imath::V2f at;
    float depth; // disparity, pixels: larger is nearer
    std::array<float, 3> light;

    bool operator==(const LampPart &) const = default;
};

// Where a lamp is, relative to its place in the moment: t velocity + t^2 bend, at time t in [-1/2, 1/2].
struct LampMotion {
    Imath::V2f velocity{0, 0}, bend{0, 0};

    Imath::V2f at(float t) const { return t * velocity + t * t * bend; }
};

// The lamps of one moment that move.
class LampPaths {
public:
    // The motion of the lamp that has this part; null: it does not move, or was not found in other moments.
    const LampMotion *of(const Imath::V2f &at, float depth) const;
    // How far a lamp goes from its place, pixels.
    float farthest() const { return farthest_; }
    bool empty() const { return parts_.empty(); }

    void add(const LampPart &part, const LampMotion &motion); // before sort()
    void sort();

private:
    struct Moving {
        Imath::V2f at;
        float depth;
        LampMotion motion;
    };
    std::vector<Moving> parts_; // by place and depth
    float farthest_ = 0;
};

// Follows lamps through the moments, [moment][part]; parts may be listed several times. Returns [moment].
std::vector<LampPaths> find_lamp_paths(std::vector<std::vector<LampPart>> moments);

} // namespace sparselens
