// Coloured alpha: coverage that differs from colour to colour, as of tinted glass and coloured smoke. By the
// conventions of OpenEXR ("Technical Introduction", channel names; "Interpreting OpenEXR Deep Pixels") AR, AG and AB
// are the coverage of R, G and B: composited, R of what lies behind is attenuated by AR, not by A.
//
// Which channel covers which, by the last part of its name (R of "diffuse.R"):
//
//   R, AR; G, AG; B, AB     the AR, AG, AB of the same layer, where it has them; else those of the picture
//   all others              A, which is (AR + AG + AB) / 3 where the file has none (as OpenImageIO has it)
//
// Coverage is coloured where all three are there. What composites does it once for each channel of coverage, each
// time with the colours that it covers; nothing else has to know.
#pragma once

#include "ldi.h"

#include <functional>
#include <vector>

namespace sparselens {

// Makes A of AR, AG and AB where it is missing; else nothing.
void add_mean_coverage(Ldi &ldi);
void add_mean_coverage(Image &image);

// The channel that covers channel k, npos: none does. Of a channel of coverage that is itself.
std::size_t coverage_of(std::span<const Channel> channels, std::size_t k);

// The same of every channel of the LDI, but A where a coloured coverage is that of A in every sample.
std::vector<std::size_t> coverage_by_channel(const Ldi &ldi);

// A channel of coverage and those that it covers, itself among them.
struct Covered {
    std::size_t coverage; // npos: there is none, all is opaque
    std::vector<std::size_t> channels;
};

// All channels of the LDI, by what covers them: A first, and alone where coverage is not coloured.
std::vector<Covered> by_coverage(const Ldi &ldi);

// make(alpha) makes an LDI out of another by its coverage channel `alpha`: the same samples whichever it is, each
// with the values of all channels. Returns that of A, with the values that every channel has by its own coverage.
Ldi with_each_coverage(const Ldi &ldi, const std::function<Ldi(std::size_t alpha)> &make);

// composite(ldi) makes a picture of an LDI whose coverage is its channel A. Returns that of an LDI with coloured
// coverage. What it is given has besides the channels at hand R, G and B: by coverage and brightness it is decided
// how pictures are gathered.
Image composited(const Ldi &ldi, const std::function<Image(const Ldi &)> &composite);

} // namespace sparselens
