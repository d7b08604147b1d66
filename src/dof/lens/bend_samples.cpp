#include "dof/lens/bend_samples.h"

#include "base/parallel.h"

#include <algorithm>
#include <limits>

namespace sparselens {

namespace {

void bound(SampleBlock &block, const BlockedSamples &samples) {
    constexpr float most = std::numeric_limits<float>::max();
    block.x_min = block.y_min = block.coc_min = most;
    block.x_max = block.y_max = block.coc_max = -most;
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
        block.x_min = std::min(block.x_min, samples.x[i]);
        block.x_max = std::max(block.x_max, samples.x[i]);
        block.y_min = std::min(block.y_min, samples.y[i]);
        block.y_max = std::max(block.y_max, samples.y[i]);
        block.coc_min = std::min(block.coc_min, samples.coc[i]);
        block.coc_max = std::max(block.coc_max, samples.coc[i]);
    }
}

} // namespace

void bend_samples(BlockedSamples &samples, const FocusField &field, double coc, const PictureFrame &frame,
                  double magnification, const Imath::V2i &corner) {
    parallel_for(samples.blocks.size(), [&](std::size_t b) {
        SampleBlock &block = samples.blocks[b];
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            const Imath::V2d p = Imath::V2d(double(samples.x[i]), double(samples.y[i])) + Imath::V2d(corner);
            const Imath::V2d at = frame.magnified(p, magnification) - Imath::V2d(corner);
            samples.coc[i] = float(magnification * (double(samples.coc[i]) + coc + field.coc_offset(p)));
            samples.x[i] = float(at.x);
            samples.y[i] = float(at.y);
        }
        bound(block, samples);
    });
}

} // namespace sparselens
