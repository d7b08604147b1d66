#include "shutter/shutter_mean.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
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
        const std::size_t to = windows.index(at);
        for (std::size_t k = 0; k < grown.channels.size(); ++k) grown.plane(k)[to] = sum_.plane(k)[i];
        for (std::size_t m = 0; m < mattes_.size(); ++m) coverages[m][to] = std::move(coverages_[m][i]);
    }
    sum_ = std::move(grown);
    coverages_ = std::move(coverages);
}

void ShutterMean::add_row(const Image &picture, int y, double weight, bool is_middle) {
    const int x0 = picture.windows.data.min.x;
    const std::size_t from = picture.windows.index(Imath::V2i(x0, y)),
                      to = sum_.windows.index(Imath::V2i(x0, y));
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
    const std::size_t begin = sum_.windows.index(Imath::V2i(sum_.windows.data.min.x, y));
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

ShutterCurve box_shutter() { return {{{0, 1}, {1, 1}}}; }

ShutterCurve triangle_shutter() { return {{{0, 0}, {0.5, 1}, {1, 0}}}; }

ShutterCurve gaussian_shutter() {
    constexpr int pieces = 1024;
    ShutterCurve curve;
    for (int i = 0; i <= pieces; ++i) {
        const double time = double(i) / pieces, deviations = (time - 0.5) * 6;
        curve.points.push_back({time, std::exp(-0.5 * deviations * deviations)});
    }
    return curve;
}

// Times are counted in moments, so that a box gives each moment exactly the same weight.
std::vector<double> moment_weights(const ShutterCurve &curve, int moments, const ShutterPart &open) {
    std::vector<double> weights(std::size_t(moments), 0.0);
    const auto at = [&](double time) { return (open.from + time * (open.to - open.from)) * moments; };
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
        const auto &[from_time, from] = curve.points[i];
        const auto &[to_time, to] = curve.points[i + 1];
        const double begin = at(from_time), end = at(to_time);
        if (begin == end) continue; // too short to count
        for (int m = int(begin); m < moments && m < end; ++m) {
            const double first = std::max(begin, double(m)), last = std::min(end, m + 1.0);
            const double middle = ((first + last) / 2 - begin) / (end - begin);
            weights[std::size_t(m)] += std::lerp(from, to, middle) * (last - first);
        }
    }
    return weights;
}

ShutterPart exposure_of_row(int row, int rows, double duration) {
    const double middle = (std::clamp(row, 0, rows - 1) + 0.5) / rows;
    const double from = middle * (1 - duration);
    return {from, std::min(from + duration, 1.0)};
}

namespace {

// Scales the weights of a row so that floats hold them in any unit; by a power of two, which changes no mean. A row with
// no weight, because the curve is narrower than doubles tell, sees the moment in the middle of its exposure.
void normalise(std::vector<double> &weights, const ShutterPart &open) {
    const double most = *std::ranges::max_element(weights);
    if (most > 0)
        for (double &weight : weights) weight = std::ldexp(weight, -std::ilogb(most));
    else
        weights[std::size_t((open.from + open.to) / 2 * double(weights.size()))] = 1;
}

} // namespace

std::vector<std::vector<double>> row_weights(const ShutterCurve &curve, int moments, double duration,
                                             int rows) {
    std::vector weights(std::size_t(moments), std::vector(std::size_t(rows), 0.0));
    for (int row = 0; row < rows; ++row) {
        const ShutterPart open = exposure_of_row(row, rows, duration);
        std::vector<double> of_row = moment_weights(curve, moments, open);
        normalise(of_row, open);
        for (std::size_t m = 0; m < weights.size(); ++m) weights[m][std::size_t(row)] = of_row[m];
    }
    return weights;
}

LensShare share_of_moment(int moment, int moments, double duration) {
    const int seen = std::max(1, int(std::lround(moments * duration)));
    return {moment % seen, seen};
}

namespace {

// Points farther back in a share's order lie elsewhere on the lens, because the spiral has gone on.
constexpr std::size_t most_compared = 128;
// The square of a pixel, in units of the square of the lens's radius.
constexpr double pixel_square = 0.25;

double around(double difference) { return difference - std::round(difference); }

// How close two points are, on the lens and in the pixel, whose borders meet.
double closeness(const LensSample &a, const LensSample &b) {
    const double x = double(a.x - b.x), y = double(a.y - b.y), s = around(double(a.pixel_x - b.pixel_x)),
                 t = around(double(a.pixel_y - b.pixel_y));
    return 1 / (x * x + y * y + pixel_square * (s * s + t * t) + 1e-9);
}

class Shares {
public:
    explicit Shares(std::size_t moments) : shares_(moments), served_(moments) {}

    // Gives the point to the moment whose points lie farthest from it. Each moment takes one before any takes another.
    void add(const LensSample &point) {
        std::size_t chosen = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t m = 0; m < shares_.size(); ++m) {
            if (served_[m]) continue;
            const double crowd = crowd_at(point, shares_[m]);
            if (crowd < least) least = crowd, chosen = m;
        }
        shares_[chosen].push_back(point);
        served_[chosen] = true;
        if (std::ranges::find(served_, false) == served_.end()) served_.assign(served_.size(), false);
    }
    std::vector<LensSample> take(std::size_t moment) { return std::move(shares_[moment]); }

private:
    static double crowd_at(const LensSample &point, const std::vector<LensSample> &share) {
        double crowd = 0;
        for (std::size_t i = share.size() - std::min(share.size(), most_compared); i < share.size(); ++i)
            crowd += closeness(point, share[i]);
        return crowd;
    }

    std::vector<std::vector<LensSample>> shares_;
    std::vector<bool> served_; // in this round
};

} // namespace

std::vector<LensSample> shared_points(std::vector<LensSample> points, const LensShare &share) {
    const auto moments = std::size_t(share.moments), moment = std::size_t(share.moment);
    if (moments == 1) return points;
    if (points.size() < moments) return {points[moment * points.size() / moments]};
    Shares shares(moments);
    for (const LensSample &point : points) shares.add(point);
    return shares.take(moment);
}

} // namespace sparselens
