// Finds the shape of a plate's lens: the blades and the squeeze that the discs of its lamps show.
#pragma once

#include "chain/match_lens.h"

#include <optional>

namespace sparselens {

struct MatchedShape {
    int blades = 0;      // 0: round
    double rotation = 0; // degrees, as ApertureShape has it
    double squeeze = 1;
};

// Without a value if the plate does not tell: it has no lens that can be found, or too little blur, or all shapes fit
// about as well. Throws as match_lens() does.
std::optional<MatchedShape> match_shape(const OpenedLdi &in, const Image &plate,
                                        const std::string &plate_name, const MatchRequest &request,
                                        Progress &progress);

// The request with this shape.
MatchRequest with_shape(MatchRequest request, const MatchedShape &shape);

} // namespace sparselens
