#include "dof/methods.h"

#include "dof/scatter.h"
#include "dof/selective.h"

#include <array>

namespace sparselens {

namespace {

Image by_selective(const Ldi &ldi, const ThinLens &lens, const GatherOptions &options, Progress &progress) {
    return selective_gather(ldi, lens, {.layers = options.layers}, progress);
}

Image by_scatter(const Ldi &ldi, const ThinLens &lens, const GatherOptions &, Progress &progress) {
    return scatter(ldi, lens, {}, progress);
}

constexpr std::array methods{GatherMethod{"selective", by_selective}, GatherMethod{"scatter", by_scatter}};

} // namespace

std::span<const GatherMethod> gather_methods() { return methods; }

} // namespace sparselens
