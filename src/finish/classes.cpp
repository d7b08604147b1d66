#include "finish/classes.h"

#include <algorithm>

namespace sparselens {

namespace {

constexpr std::size_t bins = 4096;

} // namespace

Classes::Classes(std::size_t count, float least, float most)
    : count_(count), least_(least), most_(most), bins_(bins, {0, 0}) {}

std::size_t Classes::bin_of(float value) const {
    const float share = (std::clamp(value, least_, most_) - least_) / (most_ - least_);
    return std::min(std::size_t(share * float(bins)), bins - 1);
}

void Classes::add(float value, double weight) {
    std::array<double, 2> &bin = bins_[bin_of(value)];
    bin[0] += 1;
    bin[1] += weight;
}

void Classes::divide() {
    std::array<double, 2> all{0, 0};
    for (const auto &bin : bins_)
        for (std::size_t k = 0; k < 2; ++k) all[k] += bin[k];
    edges_.assign(1, least_);
    double passed = 0;
    for (std::size_t i = 0; i < bins && edges_.size() < count_; ++i) {
        passed += bins_[i][0] / std::max(all[0], 1e-300) + bins_[i][1] / std::max(all[1], 1e-300);
        const float edge = least_ + (most_ - least_) * float(i + 1) / float(bins);
        while (edges_.size() < count_ && passed >= 2 * double(edges_.size()) / double(count_))
            edges_.push_back(edge);
    }
    edges_.resize(count_, most_);
    edges_.push_back(most_);
}

std::size_t Classes::of(float value) const {
    const auto above = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, value);
    return std::size_t(above - edges_.begin()) - 1;
}

double Classes::place_of(float value) const {
    const std::size_t k = of(value);
    const float width = edges_[k + 1] - edges_[k];
    const double within = width > 0 ? double((value - edges_[k]) / width) : 0.5;
    return double(k) + std::clamp(within, 0.0, 1.0);
}

} // namespace sparselens
