#include "deep/tidy.h"

#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// A stretch of one input sample: [z, z_back], with its part of the alpha and the factor on its colours.
struct Piece {
    float z, z_back;
    double alpha, factor;
    std::uint64_t index;
};

bool visible(const Ldi &ldi, std::size_t alpha, std::uint64_t i) {
    if (alpha_at(ldi, alpha, i) != 0) return true;
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        if (!holds_ids(ldi.channels[k]) && ldi.values[k][i] != 0) return true;
    return false;
}

bool is_tidy(const Ldi &ldi, std::size_t alpha, std::size_t pixel) {
    for (const std::uint64_t i : ldi.pixel(pixel)) {
        if (!visible(ldi, alpha, i)) return false;
        if (i > ldi.pixel(pixel).front() && !(back_at(ldi, i - 1) <= ldi.z[i] && ldi.z[i - 1] < ldi.z[i]))
            return false;
    }
    return true;
}

// The part of a volume between two depths absorbs as much as its share of the length: 1 - (1 - a)^share, and
// keeps the colour-to-alpha ratio ("Interpreting OpenEXR Deep Pixels", splitting a volume sample).
Piece part_of(const Piece &whole, float z, float z_back) {
    if (z == whole.z && z_back == whole.z_back) return whole;
    const double share = (double(z_back) - double(z)) / (double(whole.z_back) - double(whole.z));
    if (whole.alpha >= 1) return {z, z_back, 1, whole.factor, whole.index};
    const double alpha = -std::expm1(share * std::log1p(-whole.alpha));
    return {z, z_back, alpha, whole.factor * (whole.alpha > 0 ? alpha / whole.alpha : share), whole.index};
}

// Cuts every volume at every depth where another sample begins or ends inside it.
std::vector<Piece> split_at_boundaries(const std::vector<Piece> &samples) {
    std::vector<float> cuts;
    for (const Piece &s : samples) cuts.insert(cuts.end(), {s.z, s.z_back});
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    std::vector<Piece> pieces;
    for (const Piece &s : samples) {
        if (!(s.z_back > s.z)) {
            pieces.push_back(s);
            continue;
        }
        float from = s.z;
        for (auto cut = std::upper_bound(cuts.begin(), cuts.end(), s.z); from < s.z_back; ++cut) {
            pieces.push_back(part_of(s, from, *cut));
            from = *cut;
        }
    }
    return pieces;
}

// Samples of the same extent become one: their optical depths add, colours in proportion ("Interpreting OpenEXR Deep
// Pixels", merging). Opaque samples share equally. Sets the factors; the alpha of the whole is linear.
void set_merged_factors(std::span<Piece> same) {
    const auto opaque = [](const Piece &p) { return p.alpha >= 1; };
    const auto opaque_count = std::count_if(same.begin(), same.end(), opaque);
    if (same.size() == 1) return;
    if (opaque_count > 0) {
        for (Piece &p : same) p.factor *= opaque(p) ? 1.0 / double(opaque_count) : 0.0;
        return;
    }
    double depth = 0;
    for (const Piece &p : same) depth -= std::log1p(-p.alpha);
    if (depth == 0) return; // light without coverage adds
    const double alpha = -std::expm1(-depth);
    for (Piece &p : same) p.factor *= (p.alpha > 0 ? -std::log1p(-p.alpha) / p.alpha : 1) * alpha / depth;
}

// A volume that reaches to infinity has no density that could be split: it becomes a point.
float finite_back(const Ldi &ldi, std::uint64_t i) {
    const float back = back_at(ldi, i);
    return std::isinf(back) ? ldi.z[i] : std::max(ldi.z[i], back);
}

std::vector<Piece> sorted_pieces(const Ldi &ldi, std::size_t alpha, std::size_t pixel) {
    std::vector<Piece> pieces;
    bool volumes = false;
    for (const std::uint64_t i : ldi.pixel(pixel))
        if (visible(ldi, alpha, i)) {
            pieces.push_back({ldi.z[i], finite_back(ldi, i), alpha_at(ldi, alpha, i), 1, i});
            volumes = volumes || pieces.back().z_back > pieces.back().z;
        }
    if (volumes) pieces = split_at_boundaries(pieces);
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece &a, const Piece &b) {
        return a.z != b.z ? a.z < b.z : a.z_back < b.z_back;
    });
    return pieces;
}

void tidy_pixel(const Ldi &ldi, std::size_t alpha, std::size_t pixel, Ldi &out) {
    std::vector<Piece> pieces = sorted_pieces(ldi, alpha, pixel);
    float last_z = -infinity;
    std::vector<Term> terms;
    for (std::size_t first = 0, last = 0; first < pieces.size(); first = last) {
        while (last < pieces.size() && pieces[last].z == pieces[first].z &&
               pieces[last].z_back == pieces[first].z_back)
            ++last;
        const std::span same(pieces.data() + first, last - first);
        set_merged_factors(same);
        terms.clear();
        MergedSample merged = sample_at(ldi, same[0].index);
        // A point where a volume begins: the volume starts one ulp behind it.
        merged.z = same[0].z > last_z ? same[0].z : std::nextafter(last_z, infinity);
        merged.z_back = std::max(merged.z, same[0].z_back);
        last_z = merged.z;
        merged.weight = 0;
        for (const Piece &p : same) {
            terms.push_back({p.index, p.factor});
            merged.weight += sample_at(ldi, p.index).weight;
        }
        merged.terms = terms;
        merged.solid = solid_of(ldi, alpha, terms);
        append(out, ldi, merged);
    }
}

Ldi tidied(const Ldi &ldi, std::size_t alpha) {
    return build_by_pixels(ldi, [&](std::size_t pixel, Ldi &out) {
        if (is_tidy(ldi, alpha, pixel))
            for (const std::uint64_t i : ldi.pixel(pixel)) append(out, ldi, i);
        else
            tidy_pixel(ldi, alpha, pixel, out);
    });
}

// Whether tidying gives a pixel more samples than it has, because its volumes overlap.
bool grows(const Ldi &ldi, std::size_t alpha, std::size_t pixel) {
    return !ldi.z_back.empty() && !is_tidy(ldi, alpha, pixel) &&
           sorted_pieces(ldi, alpha, pixel).size() > ldi.pixel(pixel).size();
}

// Whether is(pixel) is true for any pixel.
template <typename Is>
bool any_pixel(const Ldi &ldi, const Is &is) {
    std::atomic<bool> any = false;
    parallel_ranges(ldi.windows.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end && !any; ++pixel)
            if (is(pixel)) any = true;
    });
    return any;
}

} // namespace

Ldi tidy(Ldi ldi) {
    const std::size_t alpha = ldi.alpha();
    const auto untidy = [&](std::size_t pixel) { return !is_tidy(ldi, alpha, pixel); };
    if (!any_pixel(ldi, untidy)) return ldi;
    if (by_coverage(ldi).size() > 1 ||
        any_pixel(ldi, [&](std::size_t pixel) { return grows(ldi, alpha, pixel); }))
        return with_each_coverage(ldi, [&](std::size_t coverage) { return tidied(ldi, coverage); });
    rebuild_pixels(ldi, untidy, [&](std::size_t pixel, Ldi &out) { tidy_pixel(ldi, alpha, pixel, out); });
    return ldi;
}

} // namespace sparselens
