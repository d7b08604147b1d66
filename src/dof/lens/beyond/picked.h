// Samples picked from an LDI, and how much of their light is left.
#pragma once

#include "deep/ldi.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace sparselens {

struct Picked {
    std::vector<std::uint64_t> begin{0};                 // of each pixel, as Ldi::begin
    std::vector<std::uint32_t> from;                     // [new sample]
    std::vector<std::pair<std::uint32_t, float>> dimmed; // new samples

    void keep(std::uint32_t sample, float light = 1) {
        if (light < 1) dimmed.push_back({std::uint32_t(from.size()), light});
        from.push_back(sample);
    }
    void end_pixel() { begin.push_back(from.size()); }
    // Keeps all samples of `count` consecutive pixels.
    void keep_pixels(const Ldi &of, std::size_t first, std::size_t count);
};

// Puts the picked samples of `of` into `to`, which may be the same LDI. The windows of `to` do not change.
void pick(const Ldi &of, Picked by, Ldi &to);

} // namespace sparselens
