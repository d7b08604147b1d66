#include "dof/lens/beyond/picked.h"

#include "base/parallel.h"
#include "deep/packed_rows.h"
#include "dof/lens/sample_colours.h"

namespace sparselens {

namespace {

std::vector<float> picked(const std::vector<float> &of, const std::vector<std::uint32_t> &from) {
    std::vector<float> values(of.empty() ? 0 : from.size());
    parallel_ranges(values.size(), 65536, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) values[i] = of[from[i]];
    });
    return values;
}

} // namespace

void pick(const Ldi &of, Picked by, Ldi &to) {
    const std::vector<std::size_t> light = light_channels(of).all;
    to.channels = of.channels;
    to.values.resize(of.values.size());
    const std::vector<const std::vector<float> *> from = arrays_of(of);
    const std::vector<std::vector<float> *> into = arrays_of(to);
    for (std::size_t k = 0; k < from.size(); ++k) *into[k] = picked(*from[k], by.from);
    for (const auto &[sample, left] : by.dimmed)
        for (const std::size_t k : light) to.values[k][sample] *= left;
    to.begin = std::move(by.begin);
}

} // namespace sparselens
