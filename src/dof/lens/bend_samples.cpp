#include "dof/lens/bend_samples.h"

#include "base/parallel.h"

namespace sparselens {

void bend_samples(BlockedSamples &samples, const FocusField &field, double coc, const PictureFrame &frame,
                  double magnification, const Imath::V2i &corner) {
    parallel_for(samples.blocks.size(), [&](std::size_t b) {
        SampleBlock &block = samples.blocks[b];
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            const Imath::V2d p = Imath::V2d(double(samples.x[i]), double(samples.y[i])) + Imath::V2d(corner);
            const Imath::V2d at = frame.magnified(p, magnification) - Imath::V2d(corner);
            const auto bent = [&](float of) {
                return float(magnification * (double(of) + coc + field.coc_offset(p)));
            };
            samples.coc[i] = bent(samples.coc[i]);
            if (!samples.surface_coc.empty()) samples.surface_coc[i] = bent(samples.surface_coc[i]);
            samples.x[i] = float(at.x);
            samples.y[i] = float(at.y);
        }
        bound(block, samples);
    });
}

} // namespace sparselens
