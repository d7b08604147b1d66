#include "plan/moments_needed.h"

#include "plan/tuning.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace sparselens {

namespace {

// The sharpest surface in a block, because its steps show first.
double least_coc(const View &view, const ThinLens &lens, const Imath::Box2i &box) {
    double least = std::numeric_limits<double>::infinity();
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x)
            least = std::min(
                least, std::abs(circle_of_confusion(lens, double(view.z[view.image.windows.index(x, y)]))));
    return least;
}

// The value that only a few of them exceed.
double nearly_largest(std::vector<double> values) {
    const auto few = std::size_t(PlanTuning::few_blocks * double(values.size()));
    const auto at = values.end() - 1 - std::ptrdiff_t(few);
    std::ranges::nth_element(values, at);
    return *at;
}

} // namespace

double longest_step(double coc) {
    return PlanTuning::step_in_focus + PlanTuning::step_of_coc * std::abs(coc);
}

std::optional<MomentsNeed> moments_needed(const View &first, const View &second, const ThinLens &lens,
                                          const ExpectedMotion &expected, double part, int across) {
    std::vector<double> motions, steps;
    for (const BlockMotion &block : block_motions(first, second, expected)) {
        motions.push_back(block.motion.length() / part / across);
        steps.push_back(motions.back() / longest_step(least_coc(first, lens, block.box) / across));
    }
    if (motions.empty()) return {};
    return MomentsNeed{nearly_largest(motions), std::max(1, int(std::ceil(nearly_largest(steps))))};
}

} // namespace sparselens
