#include "base/subpixels.h"

#include "base/matte.h"
#include "base/numbers.h"
#include "base/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

// Sub-pixels side by side, and the share of each in a pixel; the shares add up to 1.
struct Run {
    int first = 0;
    std::vector<double> shares;
};

// How many sub-pixels on each side of its own a pixel shows.
int subpixels_beside(const Subpixels &by) { return (int(subpixel_shares(by).size()) - by.across) / 2; }

Imath::Box2i wider(const Imath::Box2i &box, int by) {
    return {box.min - Imath::V2i(by), box.max + Imath::V2i(by)};
}

// Sub-pixels of a row or a column, the last one included.
struct Range {
    int least, most;
    bool has(int at) const { return at >= least && at <= most; }
};

// The sub-pixels that a picture has along an axis, and the known ones: these, and the rest of its display window, which
// is empty.
struct Extent {
    Range there, known;

    Extent(const Windows &windows, int axis)
        : there{windows.data.min[axis], windows.data.max[axis]}, known{std::min(there.least,
                                                                                windows.display.min[axis]),
                                                                       std::max(there.most,
                                                                                windows.display.max[axis])} {}
    bool is_empty(int at) const { return known.has(at) && !there.has(at); }
    int nearest(int at) const { return std::clamp(at, there.least, there.most); }
};

// The run of pixel `at` of a row or a column. The shares of known sub-pixels sum to 1; only those that exist are
// listed.
Run run_of(int at, int across, const std::vector<double> &shares, const Extent &extent) {
    const int count = int(shares.size()), first = at * across - (count - across) / 2;
    double known = 0;
    for (int i = 0; i < count; ++i)
        if (extent.known.has(first + i)) known += shares[std::size_t(i)];
    Run run;
    for (int i = 0; i < count; ++i) {
        if (!extent.there.has(first + i)) continue;
        if (run.shares.empty()) run.first = first + i;
        run.shares.push_back(shares[std::size_t(i)] / known);
    }
    return run;
}

std::vector<Run> runs_of(int first, int last, int across, const std::vector<double> &shares,
                         const Extent &extent) {
    std::vector<Run> runs;
    for (int at = first; at <= last; ++at) runs.push_back(run_of(at, across, shares, extent));
    return runs;
}

// One row of the picture.
class RowOfPixels {
public:
    RowOfPixels(const Image &fine, const std::vector<Run> &columns, const Run &rows, Image &out, int y)
        : fine_(fine), columns_(columns), rows_(rows), out_(out), y_(y), across_(fine.windows, 0),
          down_(fine.windows, 1), sums_(std::size_t(fine.windows.width())) {}

    // Sums down the columns first, so that memory is read in its order.
    void mean(std::size_t channel) {
        const Imath::Box2i &data = fine_.windows.data;
        std::ranges::fill(sums_, 0.0);
        for (std::size_t j = 0; j < rows_.shares.size(); ++j) {
            const auto row = fine_.plane(channel).subspan(
                fine_.windows.index(Imath::V2i(data.min.x, rows_.first + int(j))));
            for (std::size_t x = 0; x < sums_.size(); ++x) sums_[x] += rows_.shares[j] * double(row[x]);
        }
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const Run &run = columns_[i];
            double sum = 0;
            for (std::size_t k = 0; k < run.shares.size(); ++k)
                sum += run.shares[k] * sums_[std::size_t(run.first - data.min.x) + k];
            out_.at(channel, out_.windows.data.min.x + int(i), y_) = float(sum);
        }
    }
    void middle(std::size_t channel, int across, float nothing) {
        const Imath::Box2i &box = out_.windows.data;
        for (int x = box.min.x; x <= box.max.x; ++x) {
            const Imath::V2i at = middle_subpixel({x, y_}, across);
            out_.at(channel, x, y_) = across_.is_empty(at.x) || down_.is_empty(at.y)
                                          ? nothing
                                          : fine_.at(channel, across_.nearest(at.x), down_.nearest(at.y));
        }
    }
    void mattes(std::span<const Matte> mattes) {
        MatteSum sum(mattes);
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            for (std::size_t j = 0; j < rows_.shares.size(); ++j)
                for (std::size_t k = 0; k < columns_[i].shares.size(); ++k)
                    sum.add(rows_.shares[j] * columns_[i].shares[k], [&](std::size_t channel) {
                        return fine_.at(channel, columns_[i].first + int(k), rows_.first + int(j));
                    });
            sum.take([&](std::size_t channel, float value) {
                out_.at(channel, out_.windows.data.min.x + int(i), y_) = value;
            });
        }
    }

private:
    const Image &fine_;
    const std::vector<Run> &columns_;
    const Run &rows_;
    Image &out_;
    int y_;
    Extent across_, down_;
    std::vector<double> sums_; // of each column of sub-pixels
};

} // namespace

Imath::Box2i reduced(const Imath::Box2i &box, int across) {
    return {{floor_div(box.min.x, across), floor_div(box.min.y, across)},
            {floor_div(box.max.x, across), floor_div(box.max.y, across)}};
}

Imath::Box2i subpixels_in(const Imath::Box2i &box, int across) {
    return {box.min * across, box.max * across + Imath::V2i(across - 1)};
}

Imath::Box2i subpixels_under(const Imath::Box2i &box, const Subpixels &by) {
    return wider(subpixels_in(box, by.across), subpixels_beside(by));
}

Imath::Box2i pixels_reached(const Imath::Box2i &box, const Subpixels &by) {
    return reduced(wider(box, subpixels_beside(by)), by.across);
}

Imath::V2i middle_subpixel(const Imath::V2i &pixel, int across) {
    using Limits = std::numeric_limits<int>;
    const auto middle = [across](int at) {
        const std::int64_t exact = std::int64_t(at) * across + across / 2;
        return int(std::clamp<std::int64_t>(exact, Limits::min(), Limits::max()));
    };
    return {middle(pixel.x), middle(pixel.y)};
}

Image mean_of_subpixels(const Image &fine, const Subpixels &by, const Imath::Box2i &box, float nothing) {
    const std::vector<double> shares = subpixel_shares(by);
    const Extent across(fine.windows, 0), down(fine.windows, 1);
    Windows windows = fine.windows;
    windows.data = box;
    windows.display = reduced(fine.windows.display, by.across);
    Image out(windows, fine.channels);
    const std::vector<Matte> mattes = find_mattes(fine.channels);
    const std::vector<Run> columns = runs_of(box.min.x, box.max.x, by.across, shares, across);
    parallel_for(std::size_t(out.windows.height()), [&](std::size_t row) {
        const int y = box.min.y + int(row);
        const Run rows = run_of(y, by.across, shares, down);
        RowOfPixels pixels(fine, columns, rows, out, y);
        for (std::size_t k = 0; k < out.channels.size(); ++k) {
            if (is_light(out.channels[k]))
                pixels.mean(k);
            else if (!is_in_matte(out.channels[k]))
                pixels.middle(k, by.across, nothing);
        }
        if (!mattes.empty()) pixels.mattes(mattes);
    });
    return out;
}

namespace {

using Shape = PixelFilter::Shape;
constexpr std::array<std::pair<std::string_view, Shape>, 3> shapes{
    {{"box", Shape::box}, {"blackman-harris", Shape::blackman_harris}, {"gaussian", Shape::gaussian}}};

constexpr double widest = 16; // pixels

// The variance that the gather adds, in square sub-pixels: samples are squares, seen from all of a pixel, 1/12 each.
// Sharpening takes some of it back near the focus. Measured on the path-traced yard.
constexpr double of_gather = 0.125;

// The filter's variance, in square pixels. Cycles' Blackman-Harris filter is the window of that name with twice the
// width; its variance is 0.01918 of the square of the window's width. Its Gaussian is exp(-8 (x / width)^2).
double variance(const PixelFilter &filter) {
    const double square = filter.width * filter.width;
    return filter.shape == Shape::gaussian ? square / 16 : 4 * 0.019184 * square;
}

// Filters the shares with the kernel [share, 1 - 2 share, share].
std::vector<double> spread(const std::vector<double> &shares, double share) {
    std::vector<double> out(shares.size() + 2);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        out[i] += share * shares[i];
        out[i + 1] += (1 - 2 * share) * shares[i];
        out[i + 2] += share * shares[i];
    }
    return out;
}

} // namespace

std::optional<PixelFilter> pixel_filter_of(std::string_view text) {
    const std::size_t colon = text.find(':');
    const auto *shape =
        std::ranges::find(shapes, text.substr(0, colon), [](const auto &s) { return s.first; });
    if (shape == shapes.end()) return {};
    PixelFilter filter{shape->second};
    if (colon == std::string_view::npos) return filter;
    const std::string_view width = text.substr(colon + 1);
    const auto [end, error] = std::from_chars(width.data(), width.data() + width.size(), filter.width);
    const bool valid = error == std::errc() && end == width.data() + width.size() && filter.width > 0 &&
                       filter.width <= widest;
    return valid && filter.shape != Shape::box ? std::optional(filter) : std::nullopt;
}

std::string text_of(const PixelFilter &filter) {
    const auto *shape = std::ranges::find(shapes, filter.shape, [](const auto &s) { return s.second; });
    return filter.shape == Shape::box ? std::string(shape->first)
                                      : fmt::format("{}:{:g}", shape->first, filter.width);
}

std::vector<double> subpixel_shares(const Subpixels &by) {
    std::vector<double> shares(std::size_t(by.across), 1.0 / by.across);
    if (by.filter.shape == Shape::box || by.across == 1) return shares;
    // In square sub-pixels: the missing variance, and the variance that the mean of a block brings.
    const double square = double(by.across) * by.across, more = square - 1;
    const double missing = variance(by.filter) * more - of_gather, block = more / 12;
    constexpr double most_at_once = 0.5; // at this variance, as much goes to both sides as stays
    const double rest = std::max(missing - block, 0.0);
    const int times = int(std::ceil(rest / most_at_once));
    for (int i = 0; i < times; ++i) shares = spread(shares, rest / times / 2);
    return shares;
}

} // namespace sparselens
