// Fillers as the lens gather needs them: in blocks, with their colours.
#pragma once

#include "dof/lens/fillers.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"

#include <span>

namespace sparselens {

struct FillerSamples {
    BlockedSamples samples; // `source` is the number of the filler, or `background` if it is nothing
    SampleColours colours;
};

// `samples`, `colours`: of the LDI that the fillers belong to. The light that highlights spread is no longer in the
// colours, so no lamp continues behind anything.
FillerSamples place_fillers(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                            const BlockedSamples &samples, const SampleColours &colours);

} // namespace sparselens
