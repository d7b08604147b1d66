#include "shutter/shutter_mean.h"

#include "base/parallel.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace sparselens {

namespace {

float plus(float sum, double weight, double value) { return float(double(sum) + weight * value); }

} // namespace

std::size_t ShutterMean::weighted_row(int y) const {
    const Imath::Box2i &display = sum_.windows.display;
    return std::size_t(std::clamp(y, display.min.y, display.max.y) - display.min.y);
}

void ShutterMean::add(const Image &picture, std::span<const double> weights, bool is_middle) {
    if (sum_.channels.empty()) {
        sum_ = Image(picture.windows, picture.channels);
        mattes_ = find_mattes(sum_.channels);
        coverages_.assign(mattes_.size(), std::vector<IdCoverage>(sum_.windows.pixels()));
        weights_.assign(weights.size(), 0.0f);
    }
    grow(picture.windows.data);
    for (std::size_t row = 0; row < weights.size(); ++row)
        weights_[row] = plus(weights_[row], weights[row], 1);
    parallel_for(std::size_t(picture.windows.height()), [&](std::size_t row) {
        const int y = picture.windows.data.min.y + int(row);
        add_row(picture, y, weights[weighted_row(y)], is_middle);
    });
}

void ShutterMean::grow(const Imath::Box2i &data) {
    Imath::Box2i all = sum_.windows.data;
    all.extendBy(data);
    if (all == sum_.windows.data) return;
    Windows windows = sum_.windows;
    windows.data = all;
    Image grown(windows, sum_.channels);
    std::vector<std::vector<IdCoverage>> coverages(mattes_.size(), std::vector<IdCoverage>(windows.pixels()));
    const Windows &before = sum_.windows;
    for (std::size_t i = 0; i < before.pixels(); ++i) {
        const Imath::V2i at = before.pixel(i);
        const std::size_t to = windows.index(at.x, at.y);
        for (std::size_t k = 0; k < grown.channels.size(); ++k) grown.plane(k)[to] = sum_.plane(k)[i];
        for (std::size_t m = 0; m < mattes_.size(); ++m) coverages[m][to] = std::move(coverages_[m][i]);
    }
    sum_ = std::move(grown);
    coverages_ = std::move(coverages);
}

void ShutterMean::add_row(const Image &picture, int y, double weight, bool is_middle) {
    const int x0 = picture.windows.data.min.x;
    const std::size_t from = picture.windows.index(x0, y), to = sum_.windows.index(x0, y);
    const auto width = std::size_t(picture.windows.width());
    for (std::size_t k = 0; k < picture.channels.size(); ++k) {
        const Channel &channel = picture.channels[k];
        if (is_in_matte(channel)) continue;
        const std::span<const float> values = picture.plane(k).subspan(from, width);
        const std::span<float> sums = sum_.plane(k).subspan(to, width);
        if (!holds_ids(channel))
            for (std::size_t i = 0; i < width; ++i) sums[i] = plus(sums[i], weight, double(values[i]));
        else if (is_middle)
            std::ranges::copy(values, sums.begin());
    }
    for (std::size_t m = 0; m < mattes_.size(); ++m)
        for (const Matte::Rank &rank : mattes_[m].ranks)
            for (std::size_t i = 0; i < width; ++i)
                coverages_[m][to + i].add(picture.plane(rank.id)[from + i],
                                          weight * double(picture.plane(rank.coverage)[from + i]));
}

void ShutterMean::divide_row(int y) {
    const double all = double(weights_[weighted_row(y)]);
    const std::size_t begin = sum_.windows.index(sum_.windows.data.min.x, y);
    const auto width = std::size_t(sum_.windows.width());
    for (std::size_t k = 0; k < sum_.channels.size(); ++k)
        if (!holds_ids(sum_.channels[k]) && !is_in_matte(sum_.channels[k]))
            for (float &value : sum_.plane(k).subspan(begin, width)) value = float(double(value) / all);
    for (std::size_t m = 0; m < mattes_.size(); ++m)
        for (std::size_t i = begin; i < begin + width; ++i) {
            std::vector<IdCoverage::Pair> pairs;
            for (IdCoverage::Pair pair : coverages_[m][i].ranked())
                pairs.push_back({pair.id, pair.coverage / all});
            write_pairs(mattes_[m], pairs, [&](std::size_t k, float value) { sum_.plane(k)[i] = value; });
        }
}

Image ShutterMean::take() {
    parallel_for(std::size_t(sum_.windows.height()),
                 [&](std::size_t row) { divide_row(sum_.windows.data.min.y + int(row)); });
    coverages_.clear();
    return std::exchange(sum_, {});
}

} // namespace sparselens
