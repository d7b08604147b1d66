// The light of samples in a picture of layers: R + G + B, less what lies before them hides.
#pragma once

#include "deep/build.h"
#include "deep/ldi.h"

#include <algorithm>
#include <array>
#include <vector>

namespace sparselens {

class PixelLight {
public:
    explicit PixelLight(const Ldi &ldi) : ldi_(ldi), rgb_(find_rgb(ldi.channels)), alpha_(ldi.alpha()) {}

    bool is_known() const { return all_found(rgb_); }

    // visit(sample, light) for the samples of a pixel, front to back.
    template <typename Visit>
    void visit(std::size_t pixel, const Visit &visit) const {
        double clear = 1;
        for (const std::uint64_t i : ldi_.pixel(pixel)) {
            double own = 0;
            for (const std::size_t k : rgb_) own += double(ldi_.values[k][i]);
            visit(i, clear * own);
            clear *= 1 - std::clamp(double(alpha_at(ldi_, alpha_, i)), 0.0, 1.0);
        }
    }
    double at(std::size_t pixel) const {
        double sum = 0;
        visit(pixel, [&](std::uint64_t, double light) { sum += light; });
        return sum;
    }

    // Of all pixels of the data window.
    std::vector<float> picture() const;

private:
    const Ldi &ldi_;
    std::array<std::size_t, 3> rgb_;
    std::size_t alpha_;
};

// All pixels within `reach` of those, each once, row by row.
std::vector<Imath::V2i> grown(std::span<const Imath::V2i> pixels, int reach);
bool is_among(std::span<const Imath::V2i> pixels, const Imath::V2i &pixel); // of those that grown() gives

} // namespace sparselens
