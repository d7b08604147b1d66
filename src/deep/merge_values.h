// The values of a sample that is a weighted sum of others (deep/build.h).
#pragma once

#include "base/matte.h"
#include "deep/build.h"

namespace sparselens {

// Appends the value of each channel to those of `out`; value_at(channel, sample) is that of a sample which a term names.
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

} // namespace sparselens
