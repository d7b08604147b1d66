// Adds the scatter to the methods of the program that this file is linked into.
#include "deep/channel_alpha.h"
#include "dof/methods.h"
#include "lab/methods/scatter.h"

namespace sparselens {

namespace {

Image by_scatter(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window, const GatherOptions &,
                 Progress &progress) {
    return composited(ldi, [&](const Ldi &one) { return crop(scatter(one, lens, {}, progress), window); });
}

[[maybe_unused]] const bool joined = join_gather_methods(
    {"scatter",
     "spreads each sample exactly, a slow check of selective that takes minutes where the blur is large",
     false, false, by_scatter});

} // namespace

} // namespace sparselens
