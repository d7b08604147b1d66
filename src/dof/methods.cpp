#include "dof/methods.h"

#include "deep/channel_alpha.h"
#include "dof/selective/scatter.h"
#include "dof/selective/selective.h"

#include <array>

namespace sparselens {

namespace {

Image by_lens(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window, const GatherOptions &options,
              Progress &progress) {
    return composited(ldi,
                      [&](const Ldi &one) { return lens_gather(one, lens, window, options.lens, progress); });
}

Image by_selective(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                   const GatherOptions &options, Progress &progress) {
    return composited(ldi, [&](const Ldi &one) {
        return crop(selective_gather(one, lens, {.layers = options.layers}, progress), window);
    });
}

Image by_scatter(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window, const GatherOptions &,
                 Progress &progress) {
    return composited(ldi, [&](const Ldi &one) { return crop(scatter(one, lens, {}, progress), window); });
}

constexpr std::array methods{GatherMethod{"lens", by_lens}, GatherMethod{"selective", by_selective},
                             GatherMethod{"scatter", by_scatter}};

} // namespace

std::span<const GatherMethod> gather_methods() { return methods; }

} // namespace sparselens
