#include "finish/evidence.h"

#include "base/for_processors.h"
#include "base/parallel.h"

#include <cmath>
#include <numeric>

namespace sparselens {

namespace {

// The same for a run of pixels.
struct RunEvidence {
    std::array<Run, 3> energy{};
    std::array<Run, 2> confirmed{}, left{}, removed{};
    Run spread{}, noise{};
    Run light{}, variance{}; // of the light that the rays show above the picture
};

struct Pixels {
    std::array<const float *, 3> pictures;
    std::array<const float *, 2> candidate, rays;
    std::array<float, 2> shares; // of the samples
};

// Approximately max(a, b).
inline float larger(float a, float b) { return b + positive(a - b); }

struct Tested {
    float energy, confirmed, left, removed;
};
[[gnu::always_inline]] inline Tested tested(float a, float b, float y) {
    const float change = b - a, weighted = seen(larger(a, b)) * change;
    return {weighted * change, weighted * (y - a), weighted * (y - b),
            weighted * weighted * positive(-change)};
}

FOR_PROCESSORS void add_channel(const Pixels &pixels, RunEvidence *__restrict sums, std::size_t count) {
    const float *a0 = pixels.pictures[0], *a1 = pixels.pictures[1], *a2 = pixels.pictures[2];
    const float *b0 = pixels.candidate[0], *b1 = pixels.candidate[1];
    const float *x = pixels.rays[0], *y = pixels.rays[1];
    const auto [first, second] = pixels.shares;
    for (std::size_t i = 0; i < count; ++i) {
        const Tested t0 = tested(a0[i], b0[i], y[i]), t1 = tested(a1[i], b1[i], x[i]);
        sums->energy[0][i] += t0.energy;
        sums->confirmed[0][i] += t0.confirmed;
        sums->left[0][i] += t0.left;
        sums->removed[0][i] += t0.removed;
        sums->energy[1][i] += t1.energy;
        sums->confirmed[1][i] += t1.confirmed;
        sums->left[1][i] += t1.left;
        sums->removed[1][i] += t1.removed;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float b2 = first * b0[i] + second * b1[i], weight = seen(larger(a2[i], b2));
        const float apart = (b0[i] - a0[i]) - (b1[i] - a1[i]), difference = x[i] - y[i];
        sums->energy[2][i] += weight * (b2 - a2[i]) * (b2 - a2[i]);
        sums->spread[i] += weight * apart * apart;
        sums->noise[i] += seen(a2[i]) * difference * difference;
        const float above = first * x[i] + second * y[i] - a2[i];
        sums->light[i] += positive(above);
        sums->variance[i] += difference * difference * (0.5f + std::copysign(0.5f, above));
    }
}

double sum_of(const Run &run) { return std::accumulate(run.begin(), run.end(), 0.0); }

// Each plane of cells with the run that is added to it.
template <typename Of>
void for_planes(CellEvidence &cells, RunEvidence &run, const Of &of) {
    for (std::size_t k = 0; k < 3; ++k) of(cells.energy[k], run.energy[k]);
    for (std::size_t k = 0; k < 2; ++k) {
        of(cells.confirmed[k], run.confirmed[k]);
        of(cells.left[k], run.left[k]);
        of(cells.removed[k], run.removed[k]);
    }
    of(cells.spread, run.spread);
    of(cells.noise, run.noise);
}

} // namespace

CellEvidence evidence_of(const Trio &pictures, const Halves &candidate, const RayEvidence &evidence,
                         const Cells &cells) {
    const auto [n, m] = evidence.samples;
    const std::array shares{float(n / (n + m)), float(m / (n + m))};
    const auto width = std::size_t(cells.pixels().width());
    const auto pixels_at = [&](std::size_t c, std::size_t i) -> Pixels {
        return {{&pictures[0][c][i], &pictures[1][c][i], &pictures[2][c][i]},
                {&candidate[0][c][i], &candidate[1][c][i]},
                {&evidence.rays[0][c][i], &evidence.rays[1][c][i]},
                shares};
    };
    CellEvidence found;
    RunEvidence none;
    for_planes(found, none, [&](Values &plane, Run &) { plane.assign(cells.grid().size(), 0.0f); });
    struct Light {
        double sum = 0, variance = 0;
    };
    std::vector<Light> lights(std::size_t(cells.grid().height()));
    parallel_for(lights.size(), [&](std::size_t row) {
        const auto [begin, end] = cells.rows(row);
        for (std::size_t y = begin; y < end; ++y)
            for (std::size_t x = 0; x < width; x += run_length) {
                RunEvidence run;
                for (std::size_t c = 0; c < pictures[0].size(); ++c)
                    add_channel(pixels_at(c, y * width + x), &run, std::min(run_length, width - x));
                for (Run &left : run.left)
                    for (float &v : left) v *= v;
                for_planes(found, run, [&](Values &plane, Run &values) {
                    cells.add(values, x, cells.of_row(plane, row));
                });
                lights[row].sum += sum_of(run.light);
                lights[row].variance += sum_of(run.variance);
            }
        for_planes(found, none, [&](Values &plane, Run &) { cells.divide(row, cells.of_row(plane, row)); });
    });
    Light light;
    for (const Light &of_row : lights) {
        light.sum += of_row.sum;
        light.variance += of_row.variance;
    }
    found.event_height = light.sum > 0 ? n * m / (n + m) * light.variance / light.sum : 0;
    return found;
}

} // namespace sparselens
