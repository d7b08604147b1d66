#include "dof/methods.h"

#include "deep/channel_alpha.h"
#include "dof/gather_beyond.h"
#include "dof/lens_mattes.h"
#include "dof/merge_layers.h"
#include "dof/selective/selective.h"
#include "lens/perceptive_depth.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

Image by_lens(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window, const GatherOptions &options,
              Progress &progress) {
    const double tolerance = options.layer_tolerance;
    const auto gather = [&](const Ldi &one, const LensGatherOptions &by) {
        return lens_gather(one, lens, window, by, progress);
    };
    const auto gather_one = [&]<typename AnyLdi>(AnyLdi &&one) {
        if (tolerance == 0) return gather_beyond(std::forward<AnyLdi>(one), lens, window, options, gather);
        const double scale = perceptive_scale(lens.radius, lens.focal_px);
        return gather_beyond(merge_layers(std::forward<AnyLdi>(one), scale, tolerance), lens, window, options,
                             gather);
    };
    return composited(
        ldi, [&](const Ldi &one) { return gather_one(one); },
        [&](Ldi &&one) { return gather_one(std::move(one)); });
}

Image by_selective(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                   const GatherOptions &options, Progress &progress) {
    return composited(ldi, [&](const Ldi &one) {
        return crop(selective_gather(one, lens, {options.layers, options.lens.device}, progress), window);
    });
}

Ldi without_mattes(Ldi ldi) {
    for (std::size_t k = ldi.channels.size(); k-- > 0;)
        if (is_in_matte(ldi.channels[k])) {
            ldi.channels.erase(ldi.channels.begin() + std::ptrdiff_t(k));
            ldi.values.erase(ldi.values.begin() + std::ptrdiff_t(k));
        }
    return ldi;
}

std::vector<GatherMethod> &table() {
    static std::vector<GatherMethod> methods{
        {"lens", "what hides what is decided for every point of the lens", true, by_lens},
        {"selective", "a few blurred layers per pixel, the published method", true, by_selective}};
    return methods;
}

} // namespace

// Cryptomattes are always gathered by the lens gather, because the other methods only blend.
Image GatherMethod::gather(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                           const GatherOptions &options, Progress &progress) const {
    if (std::ranges::none_of(ldi.channels, is_in_matte)) return light(ldi, lens, window, options, progress);
    const Image lit = light(without_mattes(ldi), lens, window, options, progress);
    const Image mattes =
        gather_beyond(ldi, lens, window, options, [&](const Ldi &all, const LensGatherOptions &by) {
            return gather_mattes(all, lens, window, by, progress);
        });
    Image all(lit.windows, ldi.channels);
    for (std::size_t k = 0; k < all.channels.size(); ++k) {
        const Image &from = is_in_matte(all.channels[k]) ? mattes : lit;
        std::ranges::copy(from.plane(find_channel(from.channels, all.channels[k].name)),
                          all.plane(k).begin());
    }
    return all;
}

std::span<const GatherMethod> gather_methods() { return table(); }

bool join_gather_methods(const GatherMethod &method) {
    table().push_back(method);
    return true;
}

} // namespace sparselens
