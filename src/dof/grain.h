// The grain of a photograph: the noise that blur takes away, given back.
//
// A pixel out of focus is the mean of many with weights w, which keeps sum w^2 of the variance of their noise. It gets the
// rest, so that the noise is that of a sharp pixel as bright: normal noise of variance (1 - sum w^2) s^2.
//
// s, in the linear values of R, G and B, is measured in blocks of 16 x 16 pixels: a pixel filtered by [1 -2 1] across and
// down has the variance 36 s^2 (J. Immerkaer, "Fast noise variance estimation", 1996). Texture adds to it, so a low quantile
// of blocks as bright is the noise, once it is divided by that quantile of noise alone. The variance of rounding is none of
// it, and less than half a step of 8 bits is no grain. Groups of as many blocks, sorted by brightness, need no scale of it.
//
// A disc of radius r in square pixels covers about pi r^2 + 1.5 r + 1 of them evenly, so that each sample keeps one part in
// as many, and sum w^2, which is the mean of w with weights w, is gathered as a further channel of the LDI.
#pragma once

#include "base/image.h"
#include "deep/ldi.h"
#include "dof/lens/lens_gather.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sparselens {

struct Grain {
    struct Group {
        float brightness, deviation; // the mean, and s
    };
    std::array<std::vector<Group>, 3> groups; // of R, G and B, by brightness
    float correlation = 0;                    // of two channels, [0, 1]

    bool none() const { return groups[0].empty(); }
    float deviation(std::size_t channel, float brightness) const;
};

// Measures the grain of the front samples. `bits`: of a value in the photograph's file, whose rounding is not grain; 0 for
// floats.
Grain measure_grain(const Ldi &photograph, int bits);

// Adds the channel of what is kept to the LDI that is gathered.
void add_kept_share(Ldi &photograph, const ThinLens &lens);

// Removes this channel, the last one, from the picture, and adds `strength` times the grain in the `tiles` of `gathered` that
// are out of focus. The noise follows from pixel and frame alone, and changes with the frame as that of a camera does: a
// pattern that stays would look like dirt before a moving picture.
void add_grain(const Grain &grain, float strength, std::uint32_t frame, const LensTiles &tiles,
               const Imath::Box2i &gathered, Image &picture);

} // namespace sparselens
