#include "measure/temporal_error.h"

#include "base/light.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t colours = 3;

// The values R, G and B of each pixel in succession.
std::vector<float> tone_mapped_colours(const Image &image) {
    std::vector<float> values(image.windows.pixels() * colours);
    parallel_ranges(image.windows.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = 0; c < colours; ++c)
            for (std::size_t i = begin; i < end; ++i)
                values[i * colours + c] = float(tone_mapped(double(image.plane(c)[i])));
    });
    return values;
}

void mark_finite(const std::vector<float> &values, std::vector<char> &finite) {
    for (std::size_t i = 0; i < finite.size(); ++i)
        for (std::size_t c = 0; c < colours; ++c)
            if (!std::isfinite(values[i * colours + c])) finite[i] = 0;
}

Steadiness steadiness_of(const std::vector<double> &worst, const std::vector<char> &finite) {
    Steadiness result;
    for (std::size_t i = 0; i < worst.size(); ++i) {
        if (!finite[i]) continue;
        result.largest = std::max(result.largest, worst[i]);
        for (std::size_t k = 0; k < temporal_thresholds.size(); ++k)
            if (worst[i] > temporal_thresholds[k]) ++result.above[k];
    }
    return result;
}

} // namespace

void TemporalError::Sequence::add(std::vector<float> now, std::size_t frames) {
    worst.resize(now.size() / colours, 0);
    if (frames >= 2)
        parallel_ranges(worst.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin * colours; k < end * colours; ++k) {
                const double bend = double(before[k]) - 2 * double(last[k]) + double(now[k]);
                worst[k / colours] = std::max(worst[k / colours], std::abs(bend));
            }
        });
    before = std::exchange(last, std::move(now));
}

void TemporalError::add(const Image &image, const Image *reference) {
    finite_.resize(image.windows.pixels(), 1);
    image_.add(tone_mapped_colours(image), frames_);
    mark_finite(image_.last, finite_);
    has_reference_ = reference != nullptr;
    if (reference) {
        reference_.add(tone_mapped_colours(*reference), frames_);
        mark_finite(reference_.last, finite_);
        change_.resize(finite_.size(), 0);
        for (std::size_t k = 0; frames_ >= 1 && k < image_.last.size(); ++k) {
            const double error = (double(image_.last[k]) - double(image_.before[k])) -
                                 (double(reference_.last[k]) - double(reference_.before[k]));
            change_[k / colours] += error * error;
        }
    }
    ++frames_;
}

TemporalFigures TemporalError::figures() const {
    TemporalFigures figures;
    figures.frames = frames_;
    figures.pixels = finite_.size();
    figures.nonfinite = std::size_t(std::ranges::count(finite_, 0));
    figures.image = steadiness_of(image_.worst, finite_);
    if (!has_reference_) return figures;
    figures.reference = steadiness_of(reference_.worst, finite_);
    double sum = 0; // in double and in the order of the pixels
    for (std::size_t i = 0; i < change_.size(); ++i)
        if (finite_[i]) sum += change_[i];
    const double count = double((figures.pixels - figures.nonfinite) * colours) * double(frames_ - 1);
    figures.psnr_change =
        count > 0 ? -10 * std::log10(sum / count) : std::numeric_limits<double>::quiet_NaN();
    return figures;
}

} // namespace sparselens
