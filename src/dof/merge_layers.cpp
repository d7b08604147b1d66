#include "dof/merge_layers.h"

#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "dof/lens/sample_blocks.h"
#include "lens/thin_lens.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t pixels_at_once = 4096;

using Run = SampleRange;

// How many samples each run has, and where the runs of each pixel begin.
struct Runs {
    std::vector<std::uint64_t> begin; // pixels + 1 entries, the first 0
    std::vector<std::uint32_t> length;
};

class RunFinder {
public:
    RunFinder(const Ldi &ldi, double scale, double tolerance)
        : ldi_(ldi), alpha_(ldi.alpha()), scale_(float(scale)), tolerance_(float(tolerance)) {}

    // Returns the end of the run that begins with sample `from`, in a pixel whose samples end at `end`.
    std::uint64_t end_of(std::uint64_t from, std::uint64_t end) const {
        std::uint64_t i = from;
        while (!is_opaque(alpha_at(ldi_, alpha_, i)) && i + 1 < end && belongs(from, i + 1)) ++i;
        return i + 1;
    }

private:
    bool belongs(std::uint64_t first, std::uint64_t i) const {
        if (!(scale_ / ldi_.z[first] - scale_ / ldi_.z[i] <= tolerance_)) return false;
        const auto near = [&](const std::vector<float> &offset) {
            return offset.empty() || std::abs(offset[i] - offset[first]) <= tolerance_;
        };
        return near(ldi_.dx) && near(ldi_.dy) && one_image(first, i);
    }
    bool one_image(std::uint64_t first, std::uint64_t i) const {
        return ldi_.image_z.empty() ||
               std::abs(scale_ / ldi_.image_z[first] - scale_ / ldi_.image_z[i]) <= tolerance_;
    }
    const Ldi &ldi_;
    std::size_t alpha_;
    float scale_, tolerance_;
};

// Calls visit(number of the run, run) for every run of the pixels [first, last).
template <typename Visit>
void for_each_run(const Ldi &ldi, const Runs &runs, std::size_t first, std::size_t last, const Visit &visit) {
    for (std::size_t pixel = first; pixel < last; ++pixel) {
        std::uint64_t from = ldi.begin[pixel];
        for (std::uint64_t r = runs.begin[pixel]; r < runs.begin[pixel + 1]; ++r) {
            visit(r, Run{from, from + runs.length[r]});
            from += runs.length[r];
        }
    }
}

// Calls visit(length) for the runs of a pixel, in order.
template <typename Visit>
void for_each_length(const Ldi &ldi, const RunFinder &finder, std::size_t pixel, const Visit &visit) {
    const SampleRange all = ldi.pixel(pixel);
    for (std::uint64_t i = all.from; i < all.to;) {
        const std::uint64_t end = finder.end_of(i, all.to);
        visit(std::uint32_t(end - i));
        i = end;
    }
}

// Counts the runs of each pixel, and does not set their lengths.
Runs count_runs(const Ldi &ldi, const RunFinder &finder) {
    const std::size_t pixels = ldi.windows.pixels();
    Runs runs{std::vector<std::uint64_t>(pixels + 1, 0), {}};
    parallel_ranges(pixels, pixels_at_once, [&](std::size_t first, std::size_t last) {
        for (std::size_t p = first; p < last; ++p)
            for_each_length(ldi, finder, p, [&](std::uint32_t) { ++runs.begin[p + 1]; });
    });
    for (std::size_t p = 0; p < pixels; ++p) runs.begin[p + 1] += runs.begin[p];
    return runs;
}

void measure(Runs &runs, const Ldi &ldi, const RunFinder &finder) {
    runs.length.resize(runs.begin.back());
    parallel_ranges(ldi.windows.pixels(), pixels_at_once, [&](std::size_t first, std::size_t last) {
        for (std::size_t p = first; p < last; ++p) {
            std::uint64_t r = runs.begin[p];
            for_each_length(ldi, finder, p, [&](std::uint32_t length) { runs.length[r++] = length; });
        }
    });
}

// Returns one array of the result: of(run) for every run.
template <typename Of>
std::vector<float> for_runs(const Ldi &ldi, const Runs &runs, const Of &of) {
    std::vector<float> values(runs.length.size());
    parallel_ranges(ldi.windows.pixels(), pixels_at_once, [&](std::size_t first, std::size_t last) {
        for_each_run(ldi, runs, first, last, [&](std::uint64_t r, const Run &run) { values[r] = of(run); });
    });
    return values;
}

class Merging {
public:
    Merging(const Ldi &ldi, const Runs &runs) : ldi_(ldi), runs_(runs), alpha_(ldi.alpha()) {}

    std::vector<float> depths() const {
        return for_runs(ldi_, runs_, [&](const Run &run) {
            if (run.to - run.from == 1) return ldi_.z[run.from];
            const double inverse = mean(run, [&](std::uint64_t i) { return 1 / double(ldi_.z[i]); });
            return std::clamp(float(1 / inverse), ldi_.z[run.from], ldi_.z[run.to - 1]);
        });
    }
    // A run of volumes only ends where its last volume ends. Any other run is a point, which ends at its depth.
    std::vector<float> backs(const std::vector<float> &depths) const {
        if (ldi_.z_back.empty()) return {};
        std::vector<float> backs = for_runs(ldi_, runs_, [&](const Run &run) {
            bool volume = true;
            for (const std::uint64_t i : run) volume = volume && is_volume(ldi_, i);
            return volume ? ldi_.z_back[run.to - 1] : 0;
        });
        std::ranges::transform(backs, depths, backs.begin(), [](float a, float b) { return std::max(a, b); });
        return backs;
    }
    std::vector<float> depths_of_images() const {
        if (ldi_.image_z.empty()) return {};
        return for_runs(ldi_, runs_, [&](const Run &run) {
            if (run.to - run.from == 1) return ldi_.image_z[run.from];
            return float(1 / mean(run, [&](std::uint64_t i) { return 1 / double(ldi_.image_z[i]); }));
        });
    }
    std::vector<float> offsets(const std::vector<float> &offset) const {
        if (offset.empty()) return {};
        return for_runs(ldi_, runs_, [&](const Run &run) {
            return float(mean(run, [&](std::uint64_t i) { return double(offset[i]); }));
        });
    }
    std::vector<float> solids() const {
        if (ldi_.solid.empty()) return {};
        return for_runs(ldi_, runs_, [&](const Run &run) {
            std::vector<Term> terms;
            for (const std::uint64_t i : run) terms.push_back({i, 1});
            return solid_of(ldi_, alpha_, terms);
        });
    }
    std::vector<float> composited_values(const std::vector<float> &values) const {
        return for_runs(ldi_, runs_, [&](const Run &run) {
            double sum = 0;
            for_shares(ldi_, alpha_, run,
                       [&](std::uint64_t i, double share) { sum += share * double(values[i]); });
            return float(sum);
        });
    }
    std::vector<float> first_values(const std::vector<float> &values) const {
        return for_runs(ldi_, runs_, [&](const Run &run) { return values[run.from]; });
    }

private:
    // The mean of of(sample), weighted by what each sample shows.
    template <typename Of>
    double mean(const Run &run, const Of &of) const {
        double sum = 0, weight = 0;
        for_shares(ldi_, alpha_, run, [&](std::uint64_t i, double share) {
            const double shown = std::max(share * double(alpha_at(ldi_, alpha_, i)), 1e-12);
            sum += shown * of(i);
            weight += shown;
        });
        return sum / weight;
    }
    const Ldi &ldi_;
    const Runs &runs_;
    std::size_t alpha_;
};

// Frees an array of an LDI that may be used up; leaves the array of a const LDI.
template <typename T>
void used(std::vector<T> &values) {
    std::vector<T>().swap(values);
}
template <typename T>
void used(const std::vector<T> &) {}

Ldi without_weights(Ldi ldi) {
    used(ldi.weight);
    return ldi;
}

template <typename Source> // Ldi or const Ldi
Ldi merged(Source &ldi, double scale, double tolerance) {
    const RunFinder finder(ldi, scale, tolerance);
    Runs runs = count_runs(ldi, finder);
    if (runs.begin.back() == ldi.samples()) return without_weights(std::move(ldi));
    measure(runs, ldi, finder);
    const Merging merging(ldi, runs);
    used(ldi.weight);
    Ldi out;
    out.windows = ldi.windows;
    out.channels = ldi.channels;
    out.z = merging.depths();
    out.z_back = merging.backs(out.z);
    used(ldi.z), used(ldi.z_back);
    out.image_z = merging.depths_of_images();
    used(ldi.image_z);
    out.solid = merging.solids();
    used(ldi.solid);
    out.dx = merging.offsets(ldi.dx);
    used(ldi.dx);
    out.dy = merging.offsets(ldi.dy);
    used(ldi.dy);
    out.values.resize(ldi.channels.size());
    const std::size_t alpha = ldi.alpha();
    for (std::size_t k = 0; k < ldi.channels.size(); ++k) {
        out.values[k] = holds_ids(ldi.channels[k]) ? merging.first_values(ldi.values[k])
                                                   : merging.composited_values(ldi.values[k]);
        if (k != alpha) used(ldi.values[k]);
    }
    used(ldi.values[alpha]);
    used(ldi.begin);
    out.begin = std::move(runs.begin);
    return out;
}

} // namespace

bool can_merge_layers(const Ldi &ldi) {
    return ldi.alpha() != npos && std::ranges::none_of(ldi.channels, is_in_matte) &&
           by_coverage(ldi).size() == 1;
}

Ldi merge_layers(const Ldi &ldi, double scale, double tolerance) {
    if (!can_merge_layers(ldi)) return ldi;
    return ldi.z_back.empty() ? merged(ldi, scale, tolerance) : merge_layers(Ldi(ldi), scale, tolerance);
}

Ldi merge_layers(Ldi &&ldi, double scale, double tolerance) {
    if (!can_merge_layers(ldi)) return std::move(ldi);
    if (!ldi.z_back.empty()) ldi = at_shown_depths(std::move(ldi));
    return merged(ldi, scale, tolerance);
}

double shown_depth(double alpha) {
    if (alpha >= 1) return 0;
    if (alpha < 1e-4) return 0.5 - alpha / 12; // the difference below would lose its digits
    return -1 / std::log1p(-alpha) - (1 - alpha) / alpha;
}

Ldi at_shown_depths(Ldi ldi) {
    constexpr std::size_t samples_at_once = std::size_t(1) << 16;
    const std::size_t alpha = ldi.alpha();
    parallel_ranges(ldi.z_back.size(), samples_at_once, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const double extent = double(ldi.z_back[i]) - double(ldi.z[i]);
            if (!(extent > 0) || !std::isfinite(extent)) continue;
            const auto farther = float(shown_depth(double(alpha_at(ldi, alpha, i))) * extent);
            ldi.z[i] += farther;
            ldi.z_back[i] = std::numeric_limits<float>::infinity();
            if (!ldi.image_z.empty()) ldi.image_z[i] += farther;
        }
    });
    return ldi;
}

} // namespace sparselens
