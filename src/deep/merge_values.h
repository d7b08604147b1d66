// The values of a sample that is a weighted sum of others (deep/build.h).
#pragma once

#include "base/matte.h"
#include "deep/build.h"

namespace sparselens {

// Appends the values of the new sample to the channels of `out`. value_at(channel, sample) returns the value of a
// sample that a term names.
template <typename ValueAt>
void merge_values(Ldi &out, std::span<const Channel> channels, std::span<const Term> terms,
                  const ValueAt &value_at) {
    const bool unchanged = terms.size() == 1 && terms[0].coefficient == 1;
    bool in_mattes = false;
    for (std::size_t k = 0; k < channels.size(); ++k) {
        const bool copied = unchanged || holds_ids(channels[k]);
        in_mattes = in_mattes || (is_in_matte(channels[k]) && !unchanged);
        double sum = 0; // many small coefficients: float would lose the small ones
        if (!copied)
            for (const Term &term : terms) sum += term.coefficient * value_at(k, term.index);
        out.values[k].push_back(copied ? value_at(k, terms[0].index) : float(sum));
    }
    if (!in_mattes) return;
    const std::vector<Matte> mattes = find_mattes(channels);
    MatteSum pairs(mattes);
    for (const Term &term : terms)
        pairs.add(term.coefficient, [&](std::size_t k) { return value_at(k, term.index); });
    pairs.take([&](std::size_t k, float value) { out.values[k].back() = value; });
}

// Appends a sample to the last pixel of `out`, with values made from its terms.
template <typename ValueAt>
void append(Ldi &out, const Ldi &from, const MergedSample &sample, const ValueAt &value_at) {
    out.z.push_back(sample.z);
    if (!from.z_back.empty()) out.z_back.push_back(sample.z_back);
    if (!from.dx.empty()) out.dx.push_back(sample.dx);
    if (!from.dy.empty()) out.dy.push_back(sample.dy);
    if (!from.weight.empty()) out.weight.push_back(sample.weight);
    if (!from.optical.empty()) out.optical.push_back(sample.optical);
    if (!from.solid.empty()) out.solid.push_back(sample.solid);
    merge_values(out, from.channels, sample.terms, value_at);
    ++out.begin.back();
}

} // namespace sparselens
