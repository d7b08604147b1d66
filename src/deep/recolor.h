// Gives the samples of a deep picture the colours of a flat picture of the same frame: studios keep deep alpha, and one
// flat beauty with its passes. After flattening, every channel of light equals the flat picture's again.
//
// In each pixel V is a channel of the flat picture and F its coverage; D is the coverage of all samples together, and a
// the coverage of one:
//
//   F agrees with D      a sample becomes V a / D, by what it shows of the pixel. D stays as it is
//   F is more            the rest of the coverage, (F - D) / (1 - D), becomes a sample at infinity behind the others,
//                        for a sky that the deep picture left out; all of them share V as above, with F in place of D
//   F is less            V a / D: the light is right, and the coverage stays
//   there is no sample   light becomes a sample at infinity with coverage F, which is 0 if the light covers nothing
//   nothing covers       the last sample gets all light
//
// If the deep picture has AR, AG and AB, they share the light that they cover, and A shares the rest. Samples behind an
// opaque one get its colour. Depths, volumes, coverage, ids, Cryptomattes and data come from the deep picture, all
// light from the flat one. A flat picture without A has the coverage of the deep one. The result has the pixels of the
// flat picture only.
#pragma once

#include "ldi.h"

namespace sparselens {

struct Recolored {
    Ldi ldi;                  // tidy
    std::size_t differ = 0;   // pixels whose coverage does not agree (base/coverage.h)
    std::size_t beyond = 0;   // pixels with samples outside the flat picture, which are left out
    std::size_t infinite = 0; // pixels that got a sample at infinity
};

// `ldi` must be tidy, the values of both valid (sanitize.h), and the display windows the same.
Recolored recolor(Ldi ldi, const Image &flat);

// Whether recolor() takes the channel from the flat picture: every channel of light except coverage.
bool is_recolored(std::span<const Channel> channels, std::size_t k);

} // namespace sparselens
