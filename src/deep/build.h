// Builds one LDI from another, pixel by pixel: every stage that sorts, merges or drops samples expresses a new sample
// as a weighted sum of old ones and builds its result row by row, in parallel.
#pragma once

#include "deep/ldi.h"

#include <functional>
#include <span>

namespace sparselens {

// value = sum of coefficient * (value of sample `index`), in every channel including alpha. Integer ids come from the first
// term; the pairs of Cryptomattes are united by id, with such a sum of their coverage (base/matte.h).
struct Term {
    std::uint64_t index;
    double coefficient;
};

struct MergedSample {
    float z, z_back, dx, dy, weight, optical, solid;
    std::span<const Term> terms; // never empty
};

// The new sample without its terms.
MergedSample sample_at(const Ldi &ldi, std::uint64_t index);

// Appends to the last pixel of `out`.
void append(Ldi &out, const Ldi &from, const MergedSample &sample);
void append(Ldi &out, const Ldi &from, std::uint64_t index); // an unchanged copy

// The same samples without any channel.
Ldi without_channels(const Ldi &ldi);

// Channels, windows and the presence of z_back, dx, dy, weight, optical, solid as in `like`; no pixels yet.
Ldi empty_like(const Ldi &like);

// `fill(pixel, out)` appends the samples of each pixel to `out`; rows run in parallel, each to its own piece.
Ldi build_by_pixels(const Ldi &like, const std::function<void(std::size_t pixel, Ldi &out)> &fill);

// The same in place, where most pixels stay as they are, in the memory of a few rows: for the pixels that `changes(pixel)` says `fill` gives the
// samples, never more than the pixel has; the others keep theirs. Both see the LDI's samples of that pixel as they were.
void rebuild_pixels(Ldi &ldi, const std::function<bool(std::size_t pixel)> &changes,
                    const std::function<void(std::size_t pixel, Ldi &out)> &fill);

// Joins pieces that follow each other in pixel order, each with a `begin` that starts at 0. Frees them as it goes.
Ldi concatenate(const Ldi &like, std::vector<Ldi> pieces);

// Appends the pixels of a piece that follows, as in concatenate(); `whole` begins as a piece without pixels, with a `begin` of
// 0. Of what comes one by one no two whole copies are held.
void append_pixels(Ldi &whole, const Ldi &piece);

// The solid of samples that become one: the smallest of those that cover half or more.
float solid_of(const Ldi &ldi, std::size_t alpha_channel, std::span<const Term> terms);

inline float alpha_at(const Ldi &ldi, std::size_t alpha_channel, std::uint64_t index) {
    return alpha_channel == npos ? 1.0f : ldi.values[alpha_channel][index];
}
inline float back_at(const Ldi &ldi, std::uint64_t index) {
    return ldi.z_back.empty() ? ldi.z[index] : ldi.z_back[index];
}

} // namespace sparselens
