#include "warp/sight.h"

#include "base/coverage.h"
#include "base/parallel.h"
#include "warp/tuning.h"

#include <algorithm>

namespace sparselens {

namespace {

float farthest_in(const ViewSamples &view, std::size_t alpha, std::size_t pixel) {
    double left = 1;
    float farthest = 0;
    for (const std::uint64_t i : view.pixel(pixel)) {
        left *= 1 - double(alpha_at(view, alpha, i));
        farthest = 1 / view.z(i);
    }
    return lets_through(left) ? 0 : farthest;
}

} // namespace

std::vector<float> farthest_in(const ViewSamples &view) {
    std::vector<float> farthest(view.windows.pixels());
    const std::size_t alpha = view.alpha();
    parallel_ranges(farthest.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) farthest[p] = farthest_in(view, alpha, p);
    });
    return farthest;
}

// Along rows, then across them, a row at a time.
std::vector<float> least_around(const std::vector<float> &values, const Grid &grid, int radius) {
    const auto width = std::size_t(grid.width()), height = std::size_t(grid.height()),
               r = std::size_t(radius);
    std::vector<float> along_rows = values, least(values.size());
    const auto lower = [](float *to, const float *by, std::size_t count) {
        for (std::size_t x = 0; x < count; ++x) to[x] = std::min(to[x], by[x]);
    };
    parallel_for(height, [&](std::size_t y) {
        const float *from = &values[y * width];
        float *to = &along_rows[y * width];
        for (std::size_t n = 1; n <= std::min(r, width - 1); ++n) {
            lower(to, from + n, width - n);
            lower(to + n, from, width - n);
        }
    });
    parallel_for(height, [&](std::size_t y) {
        std::copy_n(&along_rows[y * width], width, &least[y * width]);
        for (std::size_t n = y - std::min(r, y); n <= std::min(y + r, height - 1); ++n)
            lower(&least[y * width], &along_rows[n * width], width);
    });
    return least;
}

Sight farthest_around(const ViewSamples &view, const std::vector<float> &farthest) {
    return {view, least_around(farthest, Grid(view.windows.data), WarpTuning::sight_margin)};
}

} // namespace sparselens
