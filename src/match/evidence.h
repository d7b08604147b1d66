// Whether a plate shows what a gathered picture shows: a block that does is fitted better in its own place than in
// other places of the plate. In a plate of another shot, one block in nine is, by chance.
#pragma once

#include "match/blocks.h"

namespace sparselens {

struct Evidence {
    int textured = 0; // blocks of the plate that a fit explains, in some place
    int matched = 0;  // of these: blocks that are fitted best in their own place
    double matched_share() const { return textured > 0 ? double(matched) / textured : 0; }
};

Evidence find_evidence(const Grey &plate, std::span<const std::uint8_t> usable, const Rgb &gathered);

} // namespace sparselens
