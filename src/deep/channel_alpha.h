// Per-channel alpha: coverage that differs between the colours, as for tinted glass and coloured smoke. By the
// conventions of OpenEXR ("Technical Introduction", channel names; "Interpreting OpenEXR Deep Pixels") AR, AG and AB
// are the coverage of R, G and B: when composited, the R of samples behind is attenuated by AR, not by A.
//
// Which channel covers which, by the last part of its name (R of "diffuse.R"):
//
//   R, AR; G, AG; B, AB     AR, AG, AB of the same layer if it has them, else those of the picture
//   all others              A, which is (AR + AG + AB) / 3 where the file has none (as in OpenImageIO)
//
// Alpha is per channel where all three exist. Code that composites does so once for each channel of coverage, each time
// with the colours that it covers; no other code has to know.
#pragma once

#include "ldi.h"

#include <functional>
#include <vector>

namespace sparselens {

// Adds A as the mean of AR, AG and AB if A is missing.
void add_mean_coverage(Ldi &ldi);
void add_mean_coverage(Image &image);

// The channel that covers channel k, or npos. A channel of coverage is covered by itself.
std::size_t coverage_of(std::span<const Channel> channels, std::size_t k);

// coverage_of() for every channel of the LDI, except that A covers a colour whose own alpha equals A in every sample.
std::vector<std::size_t> coverage_by_channel(const Ldi &ldi);

// A channel of coverage and the channels that it covers, including itself.
struct CoveredChannels {
    std::size_t coverage; // npos: none, everything is opaque
    std::vector<std::size_t> channels;
};

// All channels of the LDI by their coverage: A first, and A alone where alpha is not per channel.
std::vector<CoveredChannels> by_coverage(const Ldi &ldi);

// make(alpha) makes an LDI from another one by its coverage channel `alpha`: the same samples for each `alpha`, with
// the values of all channels. Returns the LDI made by A, in which each channel has the values made by its own coverage.
Ldi with_each_coverage(const Ldi &ldi, const std::function<Ldi(std::size_t alpha)> &make);

// composite(ldi) makes a picture of an LDI whose coverage is its channel A. Returns the picture of an LDI with
// per-channel alpha. The LDIs that are passed to it always have R, G and B, because coverage and brightness decide how
// a picture is gathered.
Image composited(const Ldi &ldi, const std::function<Image(const Ldi &)> &composite);
// The same, but composite_one may use up the LDI that is made for one channel of coverage.
Image composited(const Ldi &ldi, const std::function<Image(const Ldi &)> &composite,
                 const std::function<Image(Ldi &&)> &composite_one);

} // namespace sparselens
