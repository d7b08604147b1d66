// The brightness of a picture as the eye sees it.
#pragma once

#include "base/image.h"
#include "base/tone_map.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sparselens {

// For each pixel the mean of the tone-mapped colours that the image has, [0, 1) (base/tone_map.h).
inline std::vector<double> brightness(const Image &image) {
    std::vector<double> mean(image.windows.pixels());
    double channels = 0;
    for (const std::size_t channel : find_rgb(image.channels)) {
        if (channel == npos) continue;
        ++channels;
        const auto plane = image.plane(channel);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += tone_mapped(plane[i]);
    }
    for (double &value : mean) value /= std::max(channels, 1.0);
    return mean;
}

} // namespace sparselens
