#include "base/subpixels.h"

#include "base/matte.h"
#include "base/parallel.h"

#include <algorithm>

namespace sparselens {

namespace {

// Rounded down, also below zero; b > 0.
int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

// Sub-pixels side by side, and the share of each in a pixel; the shares add up to 1.
struct Run {
    int first = 0;
    std::vector<double> shares;
};

// Of pixel `at` of a row or a column, of those sub-pixels that lie in [least, most].
Run run_of(int at, int across, const std::vector<double> &shares, int least, int most) {
    const int beside = (int(shares.size()) - across) / 2, first = at * across - beside;
    const int from = std::max(least - first, 0), to = std::min(most - first + 1, int(shares.size()));
    Run run{first + from, {shares.begin() + from, shares.begin() + to}};
    double sum = 0;
    for (const double share : run.shares) sum += share;
    for (double &share : run.shares) share /= sum;
    return run;
}

std::vector<Run> runs_of(int first, int last, int across, const std::vector<double> &shares, int least,
                         int most) {
    std::vector<Run> runs;
    for (int at = first; at <= last; ++at) runs.push_back(run_of(at, across, shares, least, most));
    return runs;
}

// One row of the picture.
class RowOfPixels {
public:
    RowOfPixels(const Image &fine, const std::vector<Run> &columns, const Run &rows, Image &out, int y)
        : fine_(fine), columns_(columns), rows_(rows), out_(out), y_(y),
          sums_(std::size_t(fine.windows.width())) {}

    // Down first, so that it is read in the order of memory.
    void mean(std::size_t channel) {
        const Imath::Box2i &data = fine_.windows.data;
        std::ranges::fill(sums_, 0.0);
        for (std::size_t j = 0; j < rows_.shares.size(); ++j) {
            const auto row =
                fine_.plane(channel).subspan(fine_.windows.index(data.min.x, rows_.first + int(j)));
            for (std::size_t x = 0; x < sums_.size(); ++x) sums_[x] += rows_.shares[j] * double(row[x]);
        }
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const Run &run = columns_[i];
            const double *from = &sums_[std::size_t(run.first - data.min.x)];
            double sum = 0;
            for (std::size_t k = 0; k < run.shares.size(); ++k) sum += run.shares[k] * from[k];
            out_.at(channel, out_.windows.data.min.x + int(i), y_) = float(sum);
        }
    }
    void middle(std::size_t channel, int across) {
        const Imath::Box2i &data = fine_.windows.data, &box = out_.windows.data;
        for (int x = box.min.x; x <= box.max.x; ++x) {
            const Imath::V2i at = middle_subpixel({x, y_}, across);
            out_.at(channel, x, y_) = fine_.at(channel, std::clamp(at.x, data.min.x, data.max.x),
                                               std::clamp(at.y, data.min.y, data.max.y));
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
    const Imath::V2i beside((int(subpixel_shares(by).size()) - by.across) / 2);
    const Imath::Box2i in = subpixels_in(box, by.across);
    return {in.min - beside, in.max + beside};
}

Imath::V2i middle_subpixel(const Imath::V2i &pixel, int across) {
    return pixel * across + Imath::V2i(across / 2);
}

Image mean_of_subpixels(const Image &fine, const Subpixels &by, const Imath::Box2i &box) {
    const std::vector<double> shares = subpixel_shares(by);
    const Imath::Box2i &data = fine.windows.data;
    Windows windows = fine.windows;
    windows.data = box;
    windows.display = reduced(fine.windows.display, by.across);
    Image out(windows, fine.channels);
    const std::vector<Matte> mattes = find_mattes(fine.channels);
    const std::vector<Run> columns = runs_of(box.min.x, box.max.x, by.across, shares, data.min.x, data.max.x);
    parallel_for(std::size_t(out.windows.height()), [&](std::size_t row) {
        const int y = box.min.y + int(row);
        const Run rows = run_of(y, by.across, shares, data.min.y, data.max.y);
        RowOfPixels pixels(fine, columns, rows, out, y);
        for (std::size_t k = 0; k < out.channels.size(); ++k) {
            if (is_light(out.channels[k]))
                pixels.mean(k);
            else if (!is_in_matte(out.channels[k]))
                pixels.middle(k, by.across);
        }
        if (!mattes.empty()) pixels.mattes(mattes);
    });
    return out;
}

} // namespace sparselens
