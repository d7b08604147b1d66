// Whether the rays and the gathered picture differ as a mistake would make them: another exposure, or a picture that lies beside the
// other. Finishing would blur over it.
//
// The difference of each render from the gathered picture is fitted by what the mistake would change: the picture itself, or its
// slope across or down. The product of the two fits holds no noise of the renders, and its share of the product of the two
// differences says how much of them the mistake explains. Blocks that it explains badly count little, so that
// light that a gathered picture lacks is no exposure.
//
// Another radius, focus or shape of the lens cannot be told from what gathered pictures are wrong in anyway. Fitted in the same way by
// pictures that are gathered with 5 % more radius, 3 % more focus distance or six blades, good pictures of eleven scenes show up to
// .9, .75 and .9 of such a mistake, and of lamps more. So what headers say is compared (lens_headers.h).
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
