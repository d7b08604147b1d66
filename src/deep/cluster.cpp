#include "deep/cluster.h"

#include "base/light.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "lens/thin_lens.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sparselens {

namespace {

// A pixel's samples, front to back, with their disparities (descending).
struct Pixel {
    const Ldi &ldi;
    std::size_t alpha;
    std::uint64_t begin, end;
    double scale;
    std::optional<double> apart = {}; // for the gather: how far apart positions may be, pixels
    double front(std::uint64_t i) const { return disparity(scale, ldi.z[i]); }
    double back(std::uint64_t i) const { return apart ? front(i) : disparity(scale, back_at(ldi, i)); }
    double image(std::uint64_t i) const { return disparity(scale, ldi.coc_z(i)); }
    // Whether sample i may be in a run from `first` to the sample before it, by all but its depth.
    bool goes_on(std::uint64_t first, std::uint64_t i) const {
        const auto near = [&](const std::vector<float> &offset) {
            return offset.empty() || double(std::abs(offset[i] - offset[first])) <= *apart;
        };
        return !apart || (!is_opaque(alpha_at(ldi, alpha, i - 1)) && near(ldi.dx) && near(ldi.dy));
    }
};

// A run of samples of a pixel that grows at its back.
class Run {
public:
    Run(const Pixel &pixel, std::uint64_t first)
        : pixel_(pixel), front_(pixel.front(first)), extent_(front_ - pixel.back(first)),
          images_(!pixel.ldi.image_z.empty()) {
        if (images_) least_ = most_ = pixel.image(first);
    }
    void add(std::uint64_t i) {
        extent_ = front_ - pixel_.back(i);
        if (!images_) return;
        least_ = std::min(least_, pixel_.image(i));
        most_ = std::max(most_, pixel_.image(i));
    }
    double extent() const { return images_ ? std::max(extent_, most_ - least_) : extent_; }

private:
    const Pixel &pixel_;
    double front_, extent_, least_ = 0, most_ = 0;
    bool images_;
};

// The end of the longest run from `first` on of at most `extent`; at least one sample.
std::uint64_t end_of_run(const Pixel &p, std::uint64_t first, double extent) {
    Run run(p, first);
    for (std::uint64_t i = first + 1; i < p.end; ++i) {
        run.add(i);
        if (!(run.extent() <= extent) || !p.goes_on(first, i)) return i;
    }
    return p.end;
}

double extent_of(const Pixel &p, std::uint64_t first, std::uint64_t end) {
    Run run(p, first);
    for (std::uint64_t i = first + 1; i < end; ++i) run.add(i);
    return run.extent();
}

// How many runs of at most `extent` cover the samples, taken greedily from the front: the fewest there are.
std::size_t count_clusters(const Pixel &p, double extent) {
    std::size_t count = 0;
    for (std::uint64_t i = p.begin; i < p.end; ++count) i = end_of_run(p, i, extent);
    return count;
}

// The smallest extent with which `layers` runs cover the pixel, to one part in a million, by bisection: the
// count falls as the extent grows.
double extent_for(const Pixel &p, double tolerance, std::size_t layers) {
    if (layers == 0 || count_clusters(p, tolerance) <= layers) return tolerance;
    double too_small = tolerance, enough = extent_of(p, p.begin, p.end);
    while (enough - too_small > 1e-6 * enough) {
        const double middle = 0.5 * (too_small + enough);
        (count_clusters(p, middle) <= layers ? enough : too_small) = middle;
    }
    return enough;
}

// The share of each sample of a run in the merged one: what the samples in front of it let through. An opaque sample
// hides the rest.
void set_shares(const Pixel &p, std::uint64_t begin, std::uint64_t end, std::vector<Term> &terms) {
    terms.clear();
    const auto is_opaque = [&](std::uint64_t i) { return is_one_in_half(alpha_at(p.ldi, p.alpha, i)); };
    std::uint64_t shown = begin;
    while (shown < end && (shown == begin || !is_opaque(shown - 1))) ++shown;
    for_shares(p.ldi, p.alpha, {begin, shown}, [&](std::uint64_t i, double share) {
        terms.push_back({i, share});
    });
}

std::uint64_t count_volumes(const Ldi &ldi, std::uint64_t first, std::uint64_t last) {
    std::uint64_t count = 0;
    for (std::uint64_t i = first; i <= last; ++i) count += is_volume(ldi, i);
    return count;
}

// Depth, position and weight of the merged sample: means over what each of its samples shows. If a volume is among
// them, the result is a volume from the nearest depth to the farthest; for the gather, volumes only have a back.
MergedSample merged_placement(const Pixel &p, std::span<const Term> terms) {
    const std::uint64_t first = terms.front().index, last = terms.back().index;
    MergedSample merged = sample_at(p.ldi, first);
    merged.terms = terms;
    if (terms.size() == 1) return merged;
    double shown = 0, inverse_z = 0, inverse_image_z = 0, dx = 0, dy = 0, weight = 0;
    for (const Term &term : terms) {
        const MergedSample s = sample_at(p.ldi, term.index);
        const double share = std::max(term.coefficient * alpha_at(p.ldi, p.alpha, term.index), 1e-12);
        shown += share;
        inverse_z += share / s.z;
        inverse_image_z += share / s.image_z;
        dx += share * s.dx;
        dy += share * s.dy;
        weight += s.weight;
    }
    const std::uint64_t volumes = count_volumes(p.ldi, first, last);
    if (p.apart || volumes == 0)
        merged.z = merged.z_back = std::clamp(float(shown / inverse_z), p.ldi.z[first], p.ldi.z[last]);
    if (p.apart ? volumes > last - first : volumes > 0) merged.z_back = back_at(p.ldi, last);
    merged.dx = float(dx / shown);
    merged.dy = float(dy / shown);
    merged.weight = float(weight);
    merged.image_z = float(shown / inverse_image_z);
    merged.solid = solid_of(p.ldi, p.alpha, terms);
    return merged;
}

// Returns the largest extent of a cluster of the pixel.
double cluster_pixel(const Pixel &p, const ClusterOptions &options, Ldi &out) {
    const double extent = extent_for(p, options.tolerance, std::size_t(options.layers));
    std::vector<Term> terms;
    double largest = 0;
    for (std::uint64_t first = p.begin, last = p.begin; first < p.end; first = last) {
        last = end_of_run(p, first, extent);
        set_shares(p, first, last, terms);
        append(out, p.ldi, merged_placement(p, terms));
        if (last - first > 1) largest = std::max(largest, extent_of(p, first, last));
    }
    return largest;
}

} // namespace

Clustered cluster(const Ldi &ldi, const ClusterOptions &options, Progress &progress) {
    std::vector<double> largest(ldi.windows.pixels());
    Clustered result;
    // Which samples form a cluster depends on their depths only, whatever their coverage.
    result.ldi = with_each_coverage(ldi, [&](std::size_t coverage) {
        progress.start("clustering", std::size_t(ldi.windows.height()));
        return build_by_pixels(ldi, [&](std::size_t pixel, Ldi &out) {
            const Pixel p{ldi, coverage, ldi.pixel(pixel).from, ldi.pixel(pixel).to, options.scale};
            largest[pixel] = cluster_pixel(p, options, out);
            if (ldi.windows.pixel(pixel).x == ldi.windows.data.max.x) progress.advance();
        });
    });
    for (const double extent : largest) result.largest_error = std::max(result.largest_error, extent);
    return result;
}

Ldi cluster_for_gather(Ldi ldi, double scale, double tolerance) {
    const ClusterOptions options{.scale = scale, .tolerance = tolerance};
    const std::size_t alpha = ldi.alpha();
    const auto at = [&](std::size_t pixel) {
        return Pixel{ldi, alpha, ldi.pixel(pixel).from, ldi.pixel(pixel).to, scale, tolerance};
    };
    rebuild_pixels(
        ldi,
        [&](std::size_t pixel) { return count_clusters(at(pixel), tolerance) < ldi.pixel(pixel).size(); },
        [&](std::size_t pixel, Ldi &out) { cluster_pixel(at(pixel), options, out); });
    return ldi;
}

} // namespace sparselens
