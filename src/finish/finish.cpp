#include "finish/finish.h"

#include "finish/regression.h"
#include "finish/similar_pixels.h"
#include "finish/trust.h"
#include "finish/tuning.h"

namespace sparselens {

namespace {

Halves regressed(const LayerToFinish &layer, const Halves &rays, const Values &weights,
                 const FinishTuning::Window &window) {
    Halves predicted;
    for (std::size_t c = 0; c < layer.gathered.size(); ++c) {
        const Regression on_guide(layer.gathered[c], weights, layer.grid, window);
        for (std::size_t k = 0; k < 2; ++k) predicted[k].push_back(on_guide.of(rays[k][c]));
    }
    return predicted;
}

// Keeps pixels on which picture and renders agree: nothing around an object stays nothing, however far windows reach,
// and coverage of 1 stays 1.
void keep_agreed(const LayerToFinish &layer, FinishedLayer &finished) {
    for (std::size_t i = 0; i < layer.grid.size(); ++i) {
        bool agreed = true;
        for (std::size_t c = 0; c < layer.gathered.size(); ++c)
            agreed &=
                layer.rays[0][c][i] == layer.gathered[c][i] && layer.rays[1][c][i] == layer.gathered[c][i];
        if (!agreed) continue;
        for (Colours *colours : {&finished.picture, &finished.of_one[0], &finished.of_one[1]})
            for (std::size_t c = 0; c < colours->size(); ++c) (*colours)[c][i] = layer.gathered[c][i];
        finished.kept[i] = 1;
    }
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
    progress.start("finish", layer.given.size() + FinishTuning::regression_windows.size() + 2);
    for (const Halves &given : layer.given) offer(given);
    const Halves &rays = layer.averaged[0].empty() ? layer.rays : layer.averaged;
    const Values weights = tone_weights(layer.gathered);
    for (const FinishTuning::Window &window : FinishTuning::regression_windows)
        offer(regressed(layer, rays, weights, window));
    offer(rays);
    offer(means_of_similar(rays, pictures[2], layer.grid));
    finished.picture = std::move(pictures[2]);
    finished.of_one = {std::move(pictures[0]), std::move(pictures[1])};
    keep_agreed(layer, finished);
    return finished;
}

} // namespace sparselens
