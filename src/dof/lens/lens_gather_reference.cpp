#include "dof/lens/lens_gather_reference.h"

#include "base/parallel.h"
#include "deep/build.h"
#include "deep/flatten.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace sparselens {

namespace {

struct PlacedSample {
    Imath::V2d centre; // EXR coordinates
    double coc, depth; // pixels, perceptive depth
    double alpha;
    std::optional<std::uint64_t> source; // none: the background
};

// The samples of all pixels and their backgrounds, front to back.
std::vector<PlacedSample> place_samples(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window) {
    std::vector<PlacedSample> placed;
    const std::size_t alpha = ldi.alpha();
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
        const int width = ldi.windows.width();
        const Imath::V2i at = ldi.windows.data.min + Imath::V2i(int(pixel) % width, int(pixel) / width);
        const Imath::V2d middle(at.x + 0.5, at.y + 0.5);
        double transmittance = 1;
        for (std::uint64_t i = ldi.begin[pixel]; i < ldi.begin[pixel + 1]; ++i) {
            const MergedSample s = sample_at(ldi, i);
            const double z = double(s.z), a = double(alpha_at(ldi, alpha, i));
            placed.push_back({middle + Imath::V2d(double(s.dx), double(s.dy)), circle_of_confusion(lens, z),
                              perceptive_depth(lens, z), a, i});
            transmittance *= 1 - a;
        }
        if (transmittance == 0 || !window.intersects(at)) continue;
        const bool empty = ldi.begin[pixel] == ldi.begin[pixel + 1];
        if (!empty) placed.push_back({placed.back().centre, placed.back().coc, 0, 1, {}});
        constexpr double infinity = std::numeric_limits<double>::infinity();
        placed.push_back({middle, circle_of_confusion(lens, infinity), 0, 1, {}});
    }
    // Equal depths, as of a sky and a background: in the order they came.
    std::stable_sort(placed.begin(), placed.end(),
                     [](const auto &a, const auto &b) { return a.depth > b.depth; });
    return placed;
}

bool covers(const PlacedSample &sample, const LensSample &point, const Imath::V2d &place) {
    const double x = sample.centre.x + sample.coc * double(point.x);
    const double y = sample.centre.y + sample.coc * double(point.y);
    return std::abs(x - place.x) < 0.5 && std::abs(y - place.y) < 0.5;
}

// What one pixel gathers.
struct Sum {
    std::vector<double> values; // [channel]
    double weight = 0;
};

void add_lens_point(const Ldi &ldi, std::span<const PlacedSample> samples, const LensSample &point,
                    const Imath::V2d &middle, const Holdout *holdout, Sum &sum) {
    const Imath::V2d place = middle - Imath::V2d(double(point.pixel_x), double(point.pixel_y));
    double transmittance = 1;
    for (const PlacedSample &sample : samples) {
        if (!covers(sample, point, place)) continue;
        const double passes = holdout && sample.source
                                  ? holdout->passes(int(std::floor(middle.x)), int(std::floor(middle.y)),
                                                    double(ldi.z[*sample.source]))
                                  : 1;
        for (std::size_t k = 0; sample.source && k < sum.values.size(); ++k)
            sum.values[k] +=
                double(point.weight) * transmittance * passes * double(ldi.values[k][*sample.source]);
        transmittance *= 1 - sample.alpha;
        if (transmittance == 0) break;
    }
    sum.weight += double(point.weight) * (1 - transmittance);
}

} // namespace

Image lens_gather_reference(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                            std::span<const LensSample> points, const Holdout *holdout) {
    const std::vector<PlacedSample> samples = place_samples(ldi, lens, window);
    Image out = crop(flatten(ldi), window); // for the ids
    parallel_for(out.windows.pixels(), [&](std::size_t pixel) {
        const int x = window.min.x + int(pixel) % out.windows.width();
        const int y = window.min.y + int(pixel) / out.windows.width();
        Sum sum{std::vector<double>(ldi.channels.size()), 0};
        for (const LensSample &point : points)
            add_lens_point(ldi, samples, point, {x + 0.5, y + 0.5}, holdout, sum);
        for (std::size_t k = 0; k < sum.values.size(); ++k)
            if (ldi.channels[k].type != PixelType::uint32)
                out.at(k, x, y) = sum.weight > 0 ? float(sum.values[k] / sum.weight) : 0;
    });
    return out;
}

} // namespace sparselens
