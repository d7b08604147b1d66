// An LDI in the form that the lens gather uses.
#pragma once

#include "dof/lens/sample_blocks.h"

namespace sparselens {

struct BlockedLdi {
    Ldi ldi;
    BlockedSamples samples;
    SampleColours colours; // in the order of the LDI's channels

    BlockedLdi(const Ldi &from, const ThinLens &lens)
        : ldi(from), samples(make_blocks(ldi, lens, ldi.windows.data)) {
        const std::size_t channels = ldi.channels.size();
        colours = {(channels + 3) / 4, samples.count(), {}};
        colours.values.resize(colours.groups * colours.count * 4, 0.0f);
        for (std::size_t i = 0; i < samples.count(); ++i)
            for (std::size_t k = 0; k < channels && samples.source[i] != BlockedSamples::background; ++k)
                colours.at(k, i) = ldi.values[k][samples.source[i]];
    }
};

} // namespace sparselens
