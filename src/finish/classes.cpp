#include "finish/classes.h"

#include <algorithm>

namespace sparselens {

namespace {

constexpr std::size_t bins = 4096;

} // namespace

Classes::Classes(std::size_t count, float least, float most)
    : count_(count), least_(least), most_(most), bins_(bins, {0, 0}) {}

float Classes::bin_of(float value) const {
    return (std::clamp(value, least_, most_) - least_) / (most_ - least_) * float(bins);
}

void Classes::add(float value, double weight) {
    std::array<double, 2> &bin = bins_[std::min(std::size_t(bin_of(value)), bins - 1)];
    bin[0] += 1;
    bin[1] += weight;
}

void Classes::divide() {
    std::array<double, 2> all{0, 0};
    for (const auto &bin : bins_)
        for (std::size_t k = 0; k < 2; ++k) all[k] += bin[k];
    std::vector<std::size_t> edges(1, 0);
    double passed = 0;
    for (std::size_t i = 0; i < bins && edges.size() < count_; ++i) {
        passed += bins_[i][0] / std::max(all[0], 1e-300) + bins_[i][1] / std::max(all[1], 1e-300);
        while (edges.size() < count_ && passed >= 2 * double(edges.size()) / double(count_))
            edges.push_back(i + 1);
    }
    edges.resize(count_, bins);
    edges.push_back(bins);
    places_.assign(bins + 1, float(count_));
    for (std::size_t k = 0; k < count_; ++k)
        for (std::size_t i = edges[k]; i < edges[k + 1]; ++i)
            places_[i] = float(k) + float(i - edges[k]) / float(edges[k + 1] - edges[k]);
}

std::size_t Classes::of(float value) const { return std::min(std::size_t(place_of(value)), count_ - 1); }

float Classes::place_of(float value) const {
    const float bin = bin_of(value);
    const std::size_t i = std::min(std::size_t(bin), bins - 1);
    return places_[i] + (bin - float(i)) * (places_[i + 1] - places_[i]);
}

namespace {

constexpr std::size_t classes = trust_classes;

// Neighbouring classes of the table are alike, so each class borrows from them.
void soften(ClassTable &table) {
    constexpr double side = 0.21, middle = 1 - 2 * side; // a Gaussian of 0.7 classes
    const auto along = [&](std::size_t step, std::size_t other) {
        for (std::size_t line = 0; line < classes; ++line) {
            std::array<double, classes> values;
            for (std::size_t i = 0; i < classes; ++i) values[i] = table[line * other + i * step];
            for (std::size_t i = 0; i < classes; ++i)
                table[line * other + i * step] =
                    side * (values[i == 0 ? 0 : i - 1] + values[std::min(i + 1, classes - 1)]) +
                    middle * values[i];
        }
    };
    along(1, classes);
    along(classes, 1);
}

} // namespace

Shares shares_of(std::vector<ClassSums> blocks) {
    ClassTable answers{}, energies{}, variance{};
    for (ClassSums &block : blocks) {
        soften(block.answers);
        soften(block.energies);
        soften(block.unseen);
        for (std::size_t i = 0; i < answers.size(); ++i) {
            answers[i] += block.answers[i];
            energies[i] += block.energies[i];
            variance[i] += block.unseen[i];
        }
    }
    Shares shares{};
    for (std::size_t i = 0; i < shares.size(); ++i) {
        if (!(answers[i] > 0) || !(energies[i] > 0)) continue;
        const double share = answers[i] / energies[i];
        for (const ClassSums &block : blocks) {
            const double left = block.answers[i] - share * block.energies[i];
            variance[i] += left * left;
        }
        shares[i] = float(std::min(share, 1.0) * std::max(1 - variance[i] / (answers[i] * answers[i]), 0.0));
    }
    return shares;
}

} // namespace sparselens
