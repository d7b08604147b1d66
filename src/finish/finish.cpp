#include "finish/finish.h"

#include "finish/regression.h"
#include "finish/similar_pixels.h"
#include "finish/trust.h"
#include "finish/tuning.h"

namespace sparselens {

namespace {

Halves regressed(const LayerToFinish &layer, const Values &weights, int radius) {
    Halves predicted;
    for (std::size_t c = 0; c < layer.gathered.size(); ++c) {
        const Regression on_guide(layer.gathered[c], weights, layer.grid, radius);
        for (std::size_t k = 0; k < 2; ++k) predicted[k].push_back(on_guide.of(layer.rays[k][c]));
    }
    return predicted;
}

} // namespace

FinishedLayer finish_layer(const LayerToFinish &layer, Progress &progress) {
    const RayEvidence evidence{layer.rays, layer.samples, layer.grid};
    FinishedLayer finished;
    finished.kept.assign(layer.grid.size(), 1.0f);
    Trio pictures{layer.gathered, layer.gathered, layer.gathered};
    const auto offer = [&](const Halves &candidate) {
        blend_in(pictures, candidate, evidence, finished.kept);
        progress.advance();
    };
    progress.start("finish", layer.given.size() + FinishTuning::regression_radius.size() + 2);
    for (const Halves &given : layer.given) offer(given);
    const Values weights = tone_weights(layer.gathered);
    for (const int radius : FinishTuning::regression_radius) offer(regressed(layer, weights, radius));
    offer(layer.rays);
    offer(means_of_similar(layer.rays, pictures[2], layer.grid));
    finished.picture = std::move(pictures[2]);
    finished.of_one = {std::move(pictures[0]), std::move(pictures[1])};
    return finished;
}

} // namespace sparselens
