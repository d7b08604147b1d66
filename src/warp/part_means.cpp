#include "warp/part_means.h"

#include "deep/channel_alpha.h"
#include "warp/visibility_vote.h"

#include <algorithm>
#include <tuple>

namespace sparselens {

namespace {

// Appends a sample without its values to the last pixel of `out`. `volumes`: the LDI has back depths.
void append_place(Ldi &out, bool volumes, const MergedSample &sample) {
    out.z.push_back(sample.z);
    if (volumes) out.z_back.push_back(sample.z_back);
    out.dx.push_back(sample.dx);
    out.dy.push_back(sample.dy);
    out.weight.push_back(sample.weight);
    ++out.begin.back();
}

} // namespace

PartMeans::PartMeans(const ReprojectedViews &views, double tolerance, std::span<const Matte> mattes)
    : views_(views), tolerance_(tolerance), mattes_(mattes), channels_(views.samples(0).channels),
      alpha_(views.samples(0).alpha()) {
    for (std::size_t k = 0; k < channels_.size(); ++k) coverage_.push_back(coverage_of(channels_, k));
    for (std::size_t v = 0; v < views.size(); ++v) volumes_ = volumes_ || views.samples(v).has_volumes();
}

bool PartMeans::tell_of(const Surface &surface) const {
    return views_.some_are_deep() && std::ranges::any_of(surface.samples, [&](const ViewSample &s) {
               return views_.samples(s.view).is_part(s.source);
           });
}

// Parts of one pixel hide each other, and have the weight of the first; `pixels` receives the sum of the weights of all
// pixels.
std::vector<PartMeans::Share> PartMeans::shares_of(std::span<const ViewSample> samples,
                                                   double &pixels) const {
    std::vector<Share> shares;
    for (const ViewSample &s : samples) shares.push_back({s, s.weight, 0});
    std::ranges::sort(shares, {}, [](const Share &s) { return std::tuple(s.sample.view, s.sample.source); });
    double left = 1, weight = 0;
    for (std::size_t n = 0; n < shares.size(); ++n) {
        const ViewSample &s = shares[n].sample;
        const ViewSamples &view = views_.samples(s.view);
        const bool goes_on = n > 0 && shares[n - 1].sample.view == s.view && view.is_part(s.source) &&
                             view.is_part(shares[n - 1].sample.source) &&
                             view.in_one_pixel(shares[n - 1].sample.source, s.source);
        if (!goes_on) {
            left = 1;
            weight = s.weight;
            pixels += weight;
        }
        const double alpha = std::clamp(double(alpha_at(view, alpha_, s.source)), 0.0, 1.0);
        shares[n].weight = weight * left;
        shares[n].covers = weight * left * alpha;
        left *= 1 - alpha;
    }
    return shares;
}

// The mean position and depth, weighted by what the shares cover, which must be above 0 in total.
MergedSample PartMeans::place_of(std::span<const Share> shares) const {
    double covers = 0, dx = 0, dy = 0, inverse_z = 0, inverse_back = 0, merged = 0;
    for (const auto &[s, weight, by] : shares) {
        const ViewSamples &view = views_.samples(s.view);
        covers += by;
        dx += by * double(s.dx);
        dy += by * double(s.dy);
        inverse_z += by / double(view.z(s.source));
        inverse_back += by / double(view.z_back(s.source));
        merged += double(view.weight(s.source));
    }
    const auto depth = [&](double sum) { return float(covers / sum); };
    return {depth(inverse_z),
            depth(inverse_back),
            float(dx / covers),
            float(dy / covers),
            float(merged),
            depth(inverse_z),
            0,
            {}};
}

void PartMeans::append_as_it_is(const ViewSample &s, Ldi &out) const {
    const ViewSamples &view = views_.samples(s.view);
    append_place(out, volumes_,
                 {view.z(s.source), view.z_back(s.source), s.dx, s.dy, view.weight(s.source), 0, 0, {}});
    for (std::size_t k = 0; k < channels_.size(); ++k) out.values[k].push_back(views_.value(s, k));
}

void PartMeans::append_seen(std::span<const ViewSample> samples, Ldi &out) const {
    const ViewSample &centre = samples[0];
    double pixels = 0, covered = 0;
    const std::vector<Share> shares = shares_of(samples, pixels);
    for (const Share &share : shares) covered += share.covers;
    if (samples.size() == 1 || !(covered > 0)) return append_as_it_is(centre, out);
    MergedSample place = place_of(shares);
    const ViewSamples &view = views_.samples(0);
    if (view.is_part(centre.source)) {
        place.z = view.z(centre.source);
        place.z_back = view.z_back(centre.source);
    }
    append_place(out, volumes_, place);
    for (std::size_t k = 0; k < channels_.size(); ++k) {
        const std::size_t by = coverage_[k];
        double sum = 0, covers = 0;
        for (const Share &share : shares) {
            sum += share.weight * double(views_.value(share.sample, k));
            covers += share.weight * (by == npos ? 1 : double(views_.value(share.sample, by)));
        }
        const bool stays = by == k || holds_ids(channels_[k]) || is_in_matte(channels_[k]) || !(covers > 0);
        const double own = by == npos ? 1 : double(views_.value(centre, by));
        out.values[k].push_back(stays ? views_.value(centre, k) : float(own * (sum / covers)));
    }
}

void PartMeans::append_hidden(std::span<const ViewSample> samples, Ldi &out) const {
    double pixels = 0, covered = 0;
    const std::vector<Share> shares = shares_of(samples, pixels);
    for (const Share &share : shares) covered += share.covers;
    if (!(covered > 0)) return;
    const MergedSample place = place_of(shares);
    const Imath::V2d at(samples[0].x + 0.5 + double(place.dx), samples[0].y + 0.5 + double(place.dy));
    const double coverage =
        coverage_by_majority(votes_on(views_, at, 1 / double(place.z), tolerance_)) / pixels;
    if (coverage == 0) return;
    append_place(out, volumes_, place);
    MatteSum pairs(mattes_);
    for (std::size_t k = 0; k < channels_.size(); ++k) {
        double sum = 0;
        for (const Share &share : shares) sum += share.weight * double(views_.value(share.sample, k));
        out.values[k].push_back(holds_ids(channels_[k]) ? views_.value(shares[0].sample, k)
                                                        : float(coverage * sum));
    }
    for (const Share &share : shares)
        pairs.add(coverage * share.weight, [&](std::size_t k) { return views_.value(share.sample, k); });
    pairs.take([&](std::size_t k, float value) { out.values[k].back() = value; });
}

void PartMeans::append_beyond(const Imath::V2i &pixel, Ldi &out) const {
    for (const std::uint64_t i : parts_leave_frame(views_.samples(0), pixel)) {
        ViewSample s{};
        s.source = std::uint32_t(i);
        append_as_it_is(s, out);
    }
}

void PartMeans::append_mean(const Surface &surface, Ldi &out) const {
    surface.seen_by_centre() ? append_seen(surface.samples, out) : append_hidden(surface.samples, out);
}

void PartMeans::append_nearest(const Surface &surface, Ldi &out) const {
    const auto off_centre = [](const ViewSample &s) { return s.dx * s.dx + s.dy * s.dy; };
    const ViewSample &best = surface.seen_by_centre()
                                 ? surface.samples[0]
                                 : *std::ranges::min_element(surface.samples, {}, off_centre);
    const ViewSamples &view = views_.samples(best.view);
    if (best.view == 0 || !view.is_part(best.source)) return append_as_it_is(best, out);
    for (const ViewSample &s : surface.samples)
        if (s.view == best.view && view.is_part(s.source) && view.in_one_pixel(s.source, best.source))
            append_as_it_is(s, out);
}

} // namespace sparselens
