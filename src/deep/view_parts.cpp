// The samples of deep views (view_samples.h).
#include "deep/view_samples.h"
#include "warp/tuning.h"

#include <algorithm>

namespace sparselens {

namespace {

// Whether a pixel of a deep picture differs from one of a flat view, which holds one sample: a point that covers
// something.
bool holds_parts(const Ldi &ldi, std::size_t alpha, const SampleRange &samples) {
    if (samples.size() != 1) return !samples.empty();
    return back_at(ldi, samples.front()) > ldi.z[samples.front()] ||
           !(alpha_at(ldi, alpha, samples.front()) > 0);
}

} // namespace

ViewSamples::ViewSamples(Ldi &&samples)
    : windows(samples.windows), channels(samples.channels), pixels_(windows.pixels()), deep_(true),
      moved_(pixels_), words_(pieces_of(pixels_, std::size_t{64})) {
    z_ = moved_;
    replaced_ = empty();
    replaced_.begin.assign(1, 0);
    const std::size_t alpha = samples.alpha();
    for (std::size_t p = 0; p < pixels_; ++p) {
        const SampleRange own = samples.pixel(p);
        if (own.empty()) continue;
        moved_[p] = samples.z[own.front()];
        const std::uint64_t bit = std::uint64_t{1} << (p % 64);
        words_[p / 64].shown |= bit;
        if (!holds_parts(samples, alpha, own)) continue;
        words_[p / 64].replaced |= bit;
        double left = 1;
        for (const std::uint64_t i : own) {
            replaced_.z.push_back(samples.z[i]);
            if (!samples.z_back.empty()) replaced_.z_back.push_back(samples.z_back[i]);
            replaced_.weight.push_back(std::max(float(left), WarpTuning::estimate_weight));
            left *= 1 - std::clamp(double(alpha_at(samples, alpha, i)), 0.0, 1.0);
        }
        replaced_.begin.push_back(replaced_.z.size());
    }
    count_replaced();
    take_values(samples);
}

// Takes them channel by channel, so that no two copies of all channels are held.
void ViewSamples::take_values(Ldi &samples) {
    planes_.resize(channels.size());
    for (std::size_t k = 0; k < channels.size(); ++k) {
        std::vector<float> front(pixels_);
        std::vector<float> &parts = replaced_.values[k];
        parts.reserve(replaced_.z.size());
        for (std::size_t p = 0; p < pixels_; ++p) {
            const SampleRange own = samples.pixel(p);
            if (own.empty()) continue;
            front[p] = samples.values[k][own.front()];
            if (pixel(p).front() >= pixels_)
                for (const std::uint64_t i : own) parts.push_back(samples.values[k][i]);
        }
        planes_[k] = Plane::packed(front);
        std::vector<float>().swap(samples.values[k]);
    }
}

std::size_t ViewSamples::pixel_of_part(std::uint64_t i) const {
    return std::size_t(std::ranges::upper_bound(replaced_.begin, i - pixels_) - replaced_.begin.begin());
}

namespace {

// Moves samples back, and leaves out those that then lie behind the camera.
Ldi moved(const Ldi &samples, double by) {
    return build_by_pixels(samples, [&](std::size_t pixel, Ldi &out) {
        for (const std::uint64_t i : samples.pixel(pixel)) {
            MergedSample sample = sample_at(samples, i);
            sample.z = float(double(sample.z) + by);
            sample.z_back = float(double(sample.z_back) + by);
            const Term whole{i, 1};
            sample.terms = {&whole, 1};
            if (sample.z > 0) append(out, samples, sample);
        }
    });
}

} // namespace

void ViewSamples::move_parts_back(double by) { *this = ViewSamples(moved(as_ldi(), by)); }

} // namespace sparselens
