#include "dof/lens/beyond/picked.h"

#include "base/parallel.h"
#include "deep/packed_rows.h"
#include "dof/lens/sample_colours.h"

namespace sparselens {

namespace {

std::vector<float> picked(const std::vector<float> &of, const std::vector<std::uint32_t> &from) {
    std::vector<float> values(of.empty() ? 0 : from.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = of[from[i]];
    return values;
}

} // namespace

void Picked::keep_pixels(const Ldi &of, std::size_t first, std::size_t count) {
    const std::uint64_t begin_of = of.begin[first], end_of = of.begin[first + count];
    const std::uint64_t before = from.size() - begin_of; // may wrap round
    for (std::uint64_t i = begin_of; i < end_of; ++i) from.push_back(std::uint32_t(i));
    for (std::size_t pixel = first; pixel < first + count; ++pixel)
        begin.push_back(before + of.begin[pixel + 1]);
}

void pick(const Ldi &of, Picked by, Ldi &to) {
    const std::vector<std::size_t> light = light_channels(of).all;
    to.channels = of.channels;
    to.values.resize(of.values.size());
    const std::vector<const std::vector<float> *> from = arrays_of(of);
    const std::vector<std::vector<float> *> into = arrays_of(to);
    parallel_for(from.size(), [&](std::size_t k) { *into[k] = picked(*from[k], by.from); });
    for (const auto &[sample, left] : by.dimmed)
        for (const std::size_t k : light) to.values[k][sample] *= left;
    to.begin = std::move(by.begin);
}

} // namespace sparselens
