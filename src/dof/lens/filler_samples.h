// Fillers as the lens gather needs them: in blocks, with their colours; and those that hide lamps.
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

// Returns the fillers that hide lamps in a picture of one view (highlight_shadows.h). Such a picture shows a surface as
// far as something nearer hides the rest. A lens point that looks behind the nearer thing would see lamps beside the
// surface, but the surface may continue there. So its filler hides lamps. This holds if the ground, in the last pixel
// that shows it, is one surface with most of the three by three pixels around: hair is thinner, and covers less than its
// pixels show. It does not hold if the ground is a highlight. `samples` and `highlights` are as in Highlights::sample.
// The result's `source` is the front sample of the pixel.
BlockedSamples place_hiding_fillers(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                                    const BlockedSamples &samples, std::span<const std::uint32_t> highlights);

} // namespace sparselens
