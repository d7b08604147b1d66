// Builds one LDI from another, pixel by pixel: every stage that sorts, merges or drops samples expresses a new sample
// as a weighted sum of old ones and builds its result row by row, in parallel.
#pragma once

#include "base/light.h"
#include "base/matte.h"
#include "deep/ldi.h"

#include <functional>
#include <span>

namespace sparselens {

// value = sum of coefficient * (value of sample `index`), in every channel including alpha. Integer ids come from the
// first term. The pairs of Cryptomattes are united by id, with the same weighted sum for their coverage (base/matte.h).
struct Term {
    std::uint64_t index;
    double coefficient;
};

struct MergedSample {
    float z, z_back, dx, dy, weight, image_z, solid;
    std::span<const Term> terms; // never empty
};

// The depth, position and weight of a sample, without terms.
MergedSample sample_at(const Ldi &ldi, std::uint64_t index);

// Appends the sample to the last pixel of `out`.
void append(Ldi &out, const Ldi &from, const MergedSample &sample);
void append(Ldi &out, const Ldi &from, std::uint64_t index); // an unchanged copy

// The same samples without channels.
Ldi without_channels(const Ldi &ldi);

// An LDI with the channels and windows of `like`, without samples and pixels: all arrays of samples and `begin` are
// empty.
Ldi empty_like(const Ldi &like);

// `fill(pixel, out)` appends the samples of each pixel to `out`; rows run in parallel, each to its own piece.
Ldi build_by_pixels(const Ldi &like, const std::function<void(std::size_t pixel, Ldi &out)> &fill);

// Like build_by_pixels(), but in place and in the memory of a few rows, for LDIs in which most pixels stay as they are.
// `fill` gives the samples of those pixels for which `changes(pixel)` is true, never more than the pixel has; the
// others keep theirs. Both functions see the samples of that pixel as they were.
void rebuild_pixels(Ldi &ldi, const std::function<bool(std::size_t pixel)> &changes,
                    const std::function<void(std::size_t pixel, Ldi &out)> &fill);

// Joins pieces that follow each other in pixel order, each with a `begin` that starts at 0. Frees them as it goes.
Ldi concatenate(const Ldi &like, std::vector<Ldi> pieces);

// Appends the pixels of the next piece, as concatenate() does. `whole` begins as a piece without pixels, with a `begin`
// of 0. Pieces that come one by one are never held twice.
void append_pixels(Ldi &whole, const Ldi &piece);

// Adds the samples of `added` to `ldi`, each to the same pixel, in place and sorted by depth. At equal depths, samples
// of `ldi` come first. Both must have the same windows and arrays, and their samples must be sorted.
void insert_samples(Ldi &ldi, const Ldi &added);

// The solid of a sample made of others: the smallest solid among those that cover half or more.
float solid_of(const Ldi &ldi, std::size_t alpha_channel, std::span<const Term> terms);

inline float alpha_at(const Ldi &ldi, std::size_t alpha_channel, std::uint64_t index) {
    return alpha_channel == npos ? 1.0f : ldi.values[alpha_channel][index];
}
inline float back_at(const Ldi &ldi, std::uint64_t index) {
    return ldi.z_back.empty() ? ldi.z[index] : ldi.z_back[index];
}

inline bool is_volume(const Ldi &ldi, std::uint64_t index) { return back_at(ldi, index) > ldi.z[index]; }

// Calls visit(sample, left) for each sample, front to back; `left` is what the samples in front of it let through.
// Returns what all samples let through.
template <typename Samples, typename Visit>
double for_shares(const Samples &in, std::size_t alpha_channel, const SampleRange &range,
                  const Visit &visit) {
    double left = 1; // double: thousands of thin samples may add up
    for (const std::uint64_t i : range) {
        visit(i, left);
        left *= 1 - double(alpha_at(in, alpha_channel, i));
    }
    return left;
}
template <typename Samples>
bool lets_through(const Samples &in, std::size_t alpha_channel, const SampleRange &range) {
    return lets_through(for_shares(in, alpha_channel, range, [](std::uint64_t, double) {}));
}

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
    if (!from.image_z.empty()) out.image_z.push_back(sample.image_z);
    if (!from.solid.empty()) out.solid.push_back(sample.solid);
    merge_values(out, from.channels, sample.terms, value_at);
    ++out.begin.back();
}

} // namespace sparselens
