#include "warp/deepen.h"

#include "base/error.h"
#include "base/parallel.h"

#include <fmt/format.h>

namespace sparselens {

Ldi deepen(const View &view, std::span<const Channel> channels) {
    Ldi ldi;
    ldi.windows = view.image.windows;
    ldi.channels.assign(channels.begin(), channels.end());
    ldi.values.resize(channels.size());
    const std::size_t alpha = find_channel(view.image.channels, "A"), pixels = view.image.windows.pixels();
    ldi.begin.assign(pixels + 1, 0);
    for (std::size_t i = 0; i < pixels; ++i)
        ldi.begin[i + 1] =
            ldi.begin[i] + (view.z[i] > 0 && (alpha == npos || view.image.plane(alpha)[i] != 0) ? 1 : 0);
    const auto take = [&](std::span<const float> from, std::vector<float> &to) {
        if (ldi.begin.back() == pixels) return to.assign(from.begin(), from.end());
        to.resize(ldi.begin.back());
        for (std::size_t i = 0; i < pixels; ++i)
            if (!ldi.pixel(i).empty()) to[ldi.pixel(i).front()] = from[i];
    };
    take(view.z, ldi.z);
    ldi.weight.assign(ldi.z.size(), 1);
    parallel_for(channels.size(), [&](std::size_t k) {
        const std::size_t from = find_channel(view.image.channels, channels[k].name);
        if (from == npos)
            throw Error(
                fmt::format("{}: has no channel {}, which the centre view has", view.name, channels[k].name));
        take(view.image.plane(from), ldi.values[k]);
    });
    return ldi;
}

} // namespace sparselens
