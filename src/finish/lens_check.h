// Whether the rays and the gathered picture differ as a mistake would make them: another exposure, or a picture that lies beside the
// other. Finishing would blur over it.
//
// The difference of each render from the gathered picture is fitted by what the mistake would change: the picture itself, or its
// slope across or down. The product of the two fits holds no noise of the renders, and its share of the product of the two
// differences says how much of them the mistake explains. Another radius, focus or shape of the lens is not told from what
// gathered pictures are wrong in anyway: of good pictures the Laplacian explains up to a quarter.
#pragma once

#include "finish/finish.h"

#include <optional>
#include <string>

namespace sparselens {

struct LensMistakes {
    std::optional<double> brightness;  // that of the gathered picture, over that of the rays
    std::optional<double> right, down; // how far the gathered picture lies from the rays', pixels

    std::vector<std::string> warnings() const;
};

LensMistakes check_lens(const LayerToFinish &layer);

} // namespace sparselens
