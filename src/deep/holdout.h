// A deep picture that holds another one out: it hides what lies behind its samples and is not shown itself. It stays
// sharp, as it will be where it is put back: the light is held out at the pixel where it arrives.
#pragma once

#include "ldi.h"

namespace sparselens {

class Holdout {
public:
    explicit Holdout(Ldi ldi); // tidy

    // The part of the light that passes of what lies at depth z (scene units), at pixel (x, y) in EXR coordinates. A
    // point hides what lies behind it, a volume as much as is in front of z: of its transmittance 1 - A the share
    // (1 - A)^t, t the part of its extent ("Interpreting OpenEXR Deep Pixels", F. Kainz, 2013). Depths that differ
    // by rounding are equal, and do not hide each other. Outside of the data window all passes.
    double passes(int x, int y, double z) const;

private:
    Ldi ldi_;
    std::size_t alpha_;
};

// flatten(ldi), each sample times what passes of it.
Image flatten_held_out(const Ldi &ldi, const Holdout &holdout);

} // namespace sparselens
