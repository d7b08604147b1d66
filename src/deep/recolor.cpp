#include "deep/recolor.h"

#include "base/light.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/tidy.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

void leave_out_light(Ldi &ldi) {
    std::vector<Channel> channels;
    std::vector<std::vector<float>> values;
    for (std::size_t k = 0; k < ldi.channels.size(); ++k) {
        if (is_recolored(ldi.channels, k)) continue;
        channels.push_back(ldi.channels[k]);
        values.push_back(std::move(ldi.values[k]));
    }
    ldi.channels = std::move(channels);
    ldi.values = std::move(values);
}

void add_full_coverage(Ldi &ldi) {
    if (ldi.alpha() != npos) return;
    ldi.channels.push_back({"A"});
    ldi.values.emplace_back(ldi.samples(), 1.0f);
}

// How much of a pixel the samples show, weighted by channel `weight` and covered by channel `cover`.
double shown(const Ldi &ldi, std::size_t cover, std::size_t weight, const SampleRange &samples) {
    double sum = 0;
    for_shares(ldi, cover, samples,
               [&](std::uint64_t i, double share) { sum += share * double(alpha_at(ldi, weight, i)); });
    return sum;
}

// The coverage of the flat picture, for a deep picture without light.
class FlatCoverage {
public:
    FlatCoverage(const Ldi &ldi, const Image &flat) : flat_(flat), of_(ldi.channels.size(), npos) {
        const std::size_t alpha = find_channel(flat.channels, "A");
        for (std::size_t k = 0; k < of_.size(); ++k) {
            const std::size_t same = find_channel(flat.channels, ldi.channels[k].name);
            const bool covers = !holds_ids(ldi.channels[k]) && coverage_of(ldi.channels, k) == k;
            if (covers) of_[k] = same == npos ? alpha : same;
        }
        for (std::size_t k = 0; k < flat.channels.size(); ++k)
            if (is_recolored(flat.channels, k)) light_.push_back(k);
    }
    // The coverage of the flat picture for channel k of the deep picture; `otherwise` if it has none.
    double at(std::size_t k, std::size_t pixel, double otherwise) const {
        return k == npos || of_[k] == npos ? otherwise : double(flat_.plane(of_[k])[pixel]);
    }
    bool covers(std::size_t k) const { return of_[k] != npos; }
    bool is_lit(std::size_t pixel) const {
        return std::ranges::any_of(light_, [&](std::size_t k) { return flat_.plane(k)[pixel] != 0; });
    }

private:
    const Image &flat_;
    std::vector<std::size_t> of_, light_;
};

// The coverage of a sample at infinity with which it and the samples before it, which cover `deep`, cover `flat`.
float rest_of(double flat, double deep) {
    return deep < 1 ? float(std::clamp((flat - deep) / (1 - deep), 0.0, 1.0)) : 0;
}

void append_at_infinity(const Ldi &ldi, const SampleRange &before, const FlatCoverage &flat,
                        std::size_t pixel, Ldi &out) {
    const Term none{0, 1};
    append(out, ldi, {infinity, infinity, 0, 0, 1, infinity, 0, {&none, 1}},
           [&](std::size_t k, std::uint64_t) -> float {
               if (!flat.covers(k)) return 0;
               const double deep = shown(ldi, k, k, before);
               return rest_of(flat.at(k, pixel, deep), deep);
           });
}

// The samples of the pixels of the flat picture, with added samples at infinity, and without light.
Recolored covered_as(const Ldi &ldi, const Image &flat) {
    const FlatCoverage coverage(ldi, flat);
    const std::size_t alpha = ldi.alpha();
    std::atomic<std::size_t> differ = 0, infinite = 0;
    Ldi like = empty_like(ldi);
    like.windows = flat.windows;
    Recolored out;
    out.ldi = build_by_pixels(like, [&](std::size_t pixel, Ldi &row) {
        const Imath::V2i at = flat.windows.pixel(pixel);
        const SampleRange samples =
            ldi.windows.data.intersects(at) ? ldi.pixel(ldi.windows.index(at)) : SampleRange{0, 0};
        bool ends = false; // whether something lies at infinity
        for (const std::uint64_t i : samples) {
            if (ldi.z[i] == infinity && alpha_at(ldi, alpha, i) == 0) continue; // held only light
            append(row, ldi, i);
            ends = ldi.z[i] == infinity;
        }
        const double deep = shown(ldi, alpha, alpha, samples), whole = coverage.at(alpha, pixel, deep);
        if (!is_same_coverage(whole, deep)) ++differ;
        const bool more = whole > deep && !is_same_coverage(whole, deep);
        if (ends || !(more || (deep == 0 && coverage.is_lit(pixel)))) return;
        append_at_infinity(ldi, samples, coverage, pixel, row);
        ++infinite;
    });
    out.differ = differ;
    out.infinite = infinite;
    return out;
}

// Sets channel k of the samples of a pixel, by their coverage in channel `cover`.
void share(Ldi &ldi, std::size_t k, std::size_t cover, std::size_t pixel, double value) {
    const SampleRange samples = ldi.pixel(pixel);
    if (samples.empty()) return;
    std::size_t weight = cover;
    double all = shown(ldi, cover, weight, samples);
    if (all == 0) all = shown(ldi, cover, weight = ldi.alpha(), samples);
    for (const std::uint64_t i : samples)
        if (all > 0) ldi.values[k][i] = float(value * double(alpha_at(ldi, weight, i)) / all);
    if (all == 0) ldi.values[k][samples.to - 1] = float(value);
}

void add_light(Ldi &ldi, const Image &flat) {
    std::vector<std::pair<std::size_t, std::size_t>> added; // channel of the LDI, and of the picture
    for (std::size_t k = 0; k < flat.channels.size(); ++k) {
        const bool taken = find_channel(ldi.channels, flat.channels[k].name) != npos;
        if (taken || !is_recolored(flat.channels, k)) continue;
        added.emplace_back(ldi.channels.size(), k);
        ldi.channels.push_back(flat.channels[k]);
        ldi.values.emplace_back(ldi.samples());
    }
    for (const auto &pair : added) {
        const std::size_t k = pair.first,
                          cover = coverage_of(ldi.channels, k); // clang 14 does not capture bindings
        const std::span<const float> plane = flat.plane(pair.second);
        parallel_ranges(plane.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t pixel = begin; pixel < end; ++pixel)
                share(ldi, k, cover, pixel, double(plane[pixel]));
        });
    }
}

std::size_t pixels_beyond(const Ldi &ldi, const Imath::Box2i &data) {
    std::size_t count = 0;
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel)
        if (!ldi.pixel(pixel).empty() && !data.intersects(ldi.windows.pixel(pixel))) ++count;
    return count;
}

} // namespace

bool is_recolored(std::span<const Channel> channels, std::size_t k) {
    return is_light(channels[k]) && channels[k].name != "A" && coverage_of(channels, k) != k;
}

Recolored recolor(Ldi ldi, const Image &flat) {
    leave_out_light(ldi);
    add_full_coverage(ldi);
    Recolored out = covered_as(ldi, flat);
    out.beyond = pixels_beyond(ldi, flat.windows.data);
    ldi = {};
    add_light(out.ldi, flat);
    out.ldi = tidy(std::move(out.ldi));
    return out;
}

HighlightGain highlight_gain(const LookValues &values) {
    const HighlightGain none;
    return {values.highlight_gain.value_or(none.gain), values.highlight_threshold.value_or(none.threshold),
            values.highlight_knee.value_or(none.knee)};
}

double highlight_factor(const HighlightGain &by, double luminance) {
    const double t = std::clamp((luminance - by.threshold) / by.knee, 0.0, 1.0);
    return 1 + (by.gain - 1) * t * t * (3 - 2 * t);
}

double highlight_factor(const HighlightGain &by, const std::array<double, 3> &rgb, double coverage) {
    double luminance = 0;
    for (std::size_t c = 0; c < 3; ++c) luminance += luma_weights[c] * rgb[c];
    return highlight_factor(by, coverage > 0 ? luminance / coverage : luminance);
}

void raise_highlights(Ldi &ldi, const HighlightGain &by) {
    const auto rgb = find_rgb(ldi.channels);
    if (by.gain == 1 || !all_found(rgb)) return;
    const std::size_t alpha = ldi.alpha();
    parallel_ranges(ldi.samples(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double coverage = alpha == npos ? 1 : double(ldi.values[alpha][i]);
            const double factor = highlight_factor(
                by,
                {double(ldi.values[rgb[0]][i]), double(ldi.values[rgb[1]][i]), double(ldi.values[rgb[2]][i])},
                coverage);
            for (const std::size_t k : rgb) ldi.values[k][i] = float(double(ldi.values[k][i]) * factor);
        }
    });
}

} // namespace sparselens
