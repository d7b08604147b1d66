#include "finish/shares.h"

namespace sparselens {

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
