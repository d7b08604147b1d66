#include "dof/selective/splats.h"

#include <limits>

namespace sparselens {

SplatSource::SplatSource(const Ldi &ldi, const ThinLens &lens)
    : ldi_(ldi), grid_(ldi.windows.grid()), lens_(lens), alpha_(ldi.alpha()) {
    if (alpha() != npos) alphas_ = ldi.values[alpha()].data();
    for (std::size_t i = 0; i < ldi.channels.size(); ++i)
        if (i != alpha() && !holds_ids(ldi.channels[i])) colours_.push_back(i);
}

Imath::V2d SplatSource::position(std::size_t pixel, std::size_t sample) const {
    const Imath::V2i corner = grid_.pixel(pixel);
    // An offset of exactly 1/2 would put a sharp sample into the next pixel.
    constexpr double limit = 0.5 - 0x1p-20;
    const auto offset = [&](const std::vector<float> &offsets) {
        return offsets.empty() || sample == npos ? 0.0 : std::clamp(double(offsets[sample]), -limit, limit);
    };
    return {corner.x + 0.5 + offset(ldi_.dx), corner.y + 0.5 + offset(ldi_.dy)};
}

Splat SplatSource::background(std::size_t pixel, double passed) const {
    const double coc = circle_of_confusion(lens_, std::numeric_limits<double>::infinity());
    return {position(pixel, npos), coc, depth_bin(coc), 0, passed, 0, npos};
}

Image image_with_ids(const Ldi &ldi) {
    Image image(ldi.windows, ldi.channels);
    for (std::size_t channel = 0; channel < ldi.channels.size(); ++channel) {
        if (!holds_ids(ldi.channels[channel])) continue;
        const std::span<float> plane = image.plane(channel);
        for (std::size_t pixel = 0; pixel < plane.size(); ++pixel)
            if (!ldi.pixel(pixel).empty()) plane[pixel] = ldi.values[channel][ldi.pixel(pixel).front()];
    }
    return image;
}

void set_pixel(Image &image, const SplatSource &source, int x, int y, double alpha,
               std::span<const double> colours) {
    for (std::size_t k = 0; k < colours.size(); ++k) image.at(source.colours()[k], x, y) = float(colours[k]);
    if (source.alpha() != npos) image.at(source.alpha(), x, y) = float(alpha);
}

} // namespace sparselens
