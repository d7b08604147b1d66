#include "warp/surfaces.h"

#include "base/light.h"
#include "deep/channel_alpha.h"
#include "kernels/surface.h"
#include "kernels/warp_rules.h"
#include "warp/coverage.h"

#include <algorithm>
#include <optional>
#include <tuple>

namespace sparselens {

namespace {

constexpr std::uint32_t none = ~0u, left_out = none - 1;

// Like std::stable_sort, which allocates memory even for few samples. Most pixels have no more samples than there are
// views.
template <typename Before>
void sort_stably(std::span<ViewSample> samples, const Before &before) {
    constexpr std::size_t few = 16;
    if (samples.size() > few) return std::stable_sort(samples.begin(), samples.end(), before);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const ViewSample s = samples[i];
        std::size_t at = i;
        for (; at > 0 && before(s, samples[at - 1]); --at) samples[at] = samples[at - 1];
        samples[at] = s;
    }
}

bool one_surface(const ViewSample &a, const ViewSample &b, double tolerance) {
    return kernels::is_one_surface(double(a.inverse_z), double(b.inverse_z), tolerance);
}

// The samples of a pixel beyond the frame of a deep centre view that surely belong to one surface each.
std::span<ViewSample> beyond_deep(const ReprojectedViews &views, std::span<ViewSample> samples) {
    if (parts_leave_frame(views.samples(0), {samples[0].x, samples[0].y}).empty()) return samples;
    const auto of_flat = std::stable_partition(
        samples.begin(), samples.end(), [&](const ViewSample &s) { return views.samples(s.view).deep(); });
    return {samples.begin(), of_flat};
}

// The samples of a pixel, front to back, that belong to it.
std::span<ViewSample> behind_centre(const ReprojectedViews &views, double tolerance,
                                    std::span<ViewSample> samples) {
    const auto centre =
        std::find_if(samples.begin(), samples.end(), [](const auto &s) { return s.view == 0; });
    if (centre == samples.end()) {
        const Imath::V2i pixel(samples[0].x, samples[0].y);
        if (views.samples(0).windows.data.intersects(pixel)) return samples.first(0);
        return views.samples(0).deep() ? beyond_deep(views, samples) : samples;
    }
    const auto first = std::find_if(samples.begin(), centre,
                                    [&](const auto &s) { return one_surface(s, *centre, tolerance); });
    return samples.subspan(std::size_t(first - samples.begin()));
}

// Numbers all samples of the anchor's surface that have no surface yet.
Surface claim(double tolerance, const ViewSample &anchor, std::uint32_t number,
              std::span<ViewSample> samples) {
    double sum = 0, total = 0;
    for (ViewSample &s : samples) {
        if (s.surface != none || !one_surface(s, anchor, tolerance)) continue;
        s.surface = number;
        sum += s.weight * s.inverse_z;
        total += s.weight;
    }
    return {{}, sum / total};
}

// Groups the samples by surface, the centre's first; samples that are left out come last.
void group(std::span<ViewSample> samples, std::span<Surface> surfaces) {
    sort_stably(samples, [](const auto &a, const auto &b) {
        return a.surface != b.surface ? a.surface < b.surface : a.view < b.view;
    });
    for (std::size_t first = 0, last = 0; first < samples.size() && samples[first].surface != left_out;
         first = last) {
        while (last < samples.size() && samples[last].surface == samples[first].surface) ++last;
        surfaces[samples[first].surface].samples = samples.subspan(first, last - first);
    }
}

bool is_part(const ReprojectedViews &views, const ViewSample &s) {
    return views.samples(s.view).is_part(s.source);
}

// Whether two samples of one surface that the centre view sees may be averaged.
bool may_be_averaged(const ReprojectedViews &views, const ViewSample &centre, const ViewSample &s) {
    const auto flat = [&](const ViewSample &of) { return !views.samples(of.view).deep(); };
    if (flat(centre) && is_part(views, s)) return views.is_pure(centre);
    return !(flat(s) && is_part(views, centre)) || views.is_pure(s);
}

// 1 / z of the back of a sample.
double inverse_back(const ReprojectedViews &views, const ViewSample &s) {
    return 1 / double(views.samples(s.view).z_back(s.source));
}

// The samples of the centre view in the pixel.
class SeenByCentre {
public:
    // `samples`: of the pixel, front to back.
    SeenByCentre(const ReprojectedViews &views, std::span<const ViewSample> samples) : views_(views) {
        const std::size_t alpha = views.samples(0).alpha();
        double left = 1;
        for (const ViewSample &s : samples) {
            if (s.view != 0) continue;
            seen_.push_back(&s);
            left *= 1 - double(alpha_at(views.samples(0), alpha, s.source));
            if (!lets_through(left) && !end_) end_ = inverse_back(views, s);
        }
    }
    std::size_t size() const { return seen_.size(); }
    const ViewSample &operator[](std::size_t i) const { return *seen_[i]; }

    // The nearest of the centre's samples that is of the same surface; size() if there is none.
    std::size_t nearest(const ViewSample &s, double tolerance) const {
        std::size_t best = size();
        double least = tolerance;
        for (std::size_t i = 0; i < size(); ++i) {
            const double far = distance(*seen_[i], double(s.inverse_z));
            if (far < least || far == 0) {
                best = i;
                least = far;
            }
        }
        return best;
    }
    bool hides(const ViewSample &s) const { return end_ && double(s.inverse_z) < *end_; }

private:
    double distance(const ViewSample &seen, double inverse_z) const {
        if (inverse_z > double(seen.inverse_z)) return inverse_z - double(seen.inverse_z);
        return std::max(0.0, std::min(double(seen.inverse_z), inverse_back(views_, seen)) - inverse_z);
    }
    const ReprojectedViews &views_;
    std::vector<const ViewSample *> seen_;
    std::optional<double> end_; // 1 / z where nothing shows through any more
};

// Finds the surfaces of a pixel in which a deep centre view shows something.
void find_behind_deep(const ReprojectedViews &views, double tolerance, std::span<ViewSample> samples,
                      std::vector<Surface> &surfaces) {
    const std::size_t before = surfaces.size();
    const SeenByCentre seen(views, samples);
    for (std::size_t i = 0; i < seen.size(); ++i) surfaces.push_back({{}, double(seen[i].inverse_z)});
    std::uint32_t of_centre = 0;
    for (ViewSample &s : samples) {
        if (s.view == 0) {
            s.surface = of_centre++;
            continue;
        }
        const std::size_t nearest = seen.nearest(s, tolerance);
        if (nearest < seen.size())
            s.surface = may_be_averaged(views, seen[nearest], s) ? std::uint32_t(nearest) : left_out;
        else
            s.surface = seen.hides(s) ? none : left_out;
    }
    for (const ViewSample &anchor : samples)
        if (anchor.surface == none)
            surfaces.push_back(claim(tolerance, anchor, std::uint32_t(surfaces.size() - before), samples));
    group(samples, std::span(surfaces).subspan(before));
}

// Leaves out the parts that lie on the surface of a flat centre view's sample and may not be averaged with it.
void leave_out_parts(const ReprojectedViews &views, std::span<ViewSample> samples, const ViewSample &centre) {
    for (ViewSample &s : samples)
        if (s.surface == centre.surface && !may_be_averaged(views, centre, s)) s.surface = left_out;
}

bool centre_is_deep(const ReprojectedViews &views, std::span<const ViewSample> samples) {
    return views.samples(0).deep() && std::ranges::find(samples, 0u, &ViewSample::view) != samples.end();
}

// Appends the surfaces of one pixel.
void find_in_pixel(const ReprojectedViews &views, double tolerance, std::span<ViewSample> samples,
                   std::vector<Surface> &surfaces) {
    if (samples.empty()) return;
    sort_stably(samples, [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
    if (centre_is_deep(views, samples)) return find_behind_deep(views, tolerance, samples, surfaces);
    samples = behind_centre(views, tolerance, samples);
    for (ViewSample &s : samples) s.surface = none;
    const std::size_t before = surfaces.size();
    for (const bool centre : {true, false}) // the centre's samples determine surfaces first
        for (const ViewSample &anchor : samples)
            if (anchor.surface == none && (anchor.view == 0) == centre)
                surfaces.push_back(
                    claim(tolerance, anchor, std::uint32_t(surfaces.size() - before), samples));
    if (views.some_are_deep())
        for (const ViewSample &s : samples)
            if (s.view == 0) leave_out_parts(views, samples, s);
    const std::span<Surface> here = std::span(surfaces).subspan(before);
    group(samples, here);
    std::ranges::sort(here, [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
}

} // namespace

SampleRange parts_leave_frame(const ViewSamples &centre, Imath::V2i pixel) {
    const Imath::Box2i &data = centre.windows.data;
    if (!centre.deep() || data.intersects(pixel)) return {0, 0};
    for (int axis = 0; axis < 2; ++axis)
        pixel[axis] = std::clamp(pixel[axis], data.min[axis], data.max[axis]);
    const SampleRange nearest = centre.pixel(centre.windows.index(pixel));
    return nearest.empty() || !centre.is_part(nearest.front()) ? SampleRange{0, 0} : nearest;
}

Surfaces find_surfaces(const ReprojectedViews &views, double tolerance, ReprojectedRows &rows) {
    Surfaces surfaces;
    surfaces.begin.push_back(0);
    for (std::size_t pixel = 0; pixel < rows.pixels(); ++pixel) {
        find_in_pixel(views, tolerance, rows.pixel(pixel), surfaces.list);
        surfaces.begin.push_back(surfaces.list.size());
    }
    return surfaces;
}

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

SurfaceMeans::SurfaceMeans(const ReprojectedViews &views, double tolerance, std::span<const Matte> mattes)
    : views_(views), tolerance_(tolerance), mattes_(mattes), channels_(views.samples(0).channels),
      alpha_(views.samples(0).alpha()) {
    for (std::size_t k = 0; k < channels_.size(); ++k) {
        coverage_.push_back(coverage_of(channels_, k));
        ids_.push_back(holds_ids(channels_[k]));
    }
    for (std::size_t v = 0; v < views.size(); ++v) volumes_ = volumes_ || views.samples(v).has_volumes();
}

bool SurfaceMeans::is_of_parts(const Surface &surface) const {
    return views_.some_are_deep() && std::ranges::any_of(surface.samples, [&](const ViewSample &s) {
               return views_.samples(s.view).is_part(s.source);
           });
}

// Parts of one pixel hide each other, and have the weight of the first; `pixels` receives the sum of the weights of all
// pixels.
std::vector<SurfaceMeans::Share> SurfaceMeans::shares_of(std::span<const ViewSample> samples,
                                                         double &pixels) const {
    std::vector<Share> shares;
    for (const ViewSample &s : samples) shares.push_back({s, 0});
    std::ranges::sort(shares, {}, [](const Share &s) { return std::tuple(s.view, s.source); });
    double left = 1, weight = 0;
    for (std::size_t n = 0; n < shares.size(); ++n) {
        Share &s = shares[n];
        const ViewSamples &view = views_.samples(s.view);
        const bool goes_on = n > 0 && shares[n - 1].view == s.view && view.is_part(s.source) &&
                             view.is_part(shares[n - 1].source) &&
                             view.in_one_pixel(shares[n - 1].source, s.source);
        if (!goes_on) {
            left = 1;
            weight = s.weight;
            pixels += weight;
        }
        const double alpha = std::clamp(double(alpha_at(view, alpha_, s.source)), 0.0, 1.0);
        s.weight = weight * left;
        s.covers = s.weight * alpha;
        left *= 1 - alpha;
    }
    return shares;
}

// The mean position and depth, weighted by what the shares cover, which must be above 0 in total.
MergedSample SurfaceMeans::place_of(std::span<const Share> shares) const {
    double covers = 0, dx = 0, dy = 0, inverse_z = 0, inverse_back = 0, merged = 0;
    for (const Share &s : shares) {
        const ViewSamples &view = views_.samples(s.view);
        const double by = s.covers;
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

// Appends the mean of the samples, whose weights have the sum `weights`, times `coverage`.
template <typename Samples> // Share or ViewSample
void SurfaceMeans::append_values(const Samples &samples, double weights, double coverage, Ldi &out) const {
    for (std::size_t k = 0; k < channels_.size(); ++k) {
        double sum = 0;
        for (const ViewSample &s : samples) sum += s.weight * double(views_.value(s, k));
        out.values[k].push_back(ids_[k] ? views_.value(samples[0], k) : float(coverage * (sum / weights)));
    }
    if (mattes_.empty()) return;
    MatteSum pairs(mattes_);
    for (const ViewSample &s : samples)
        pairs.add(coverage * s.weight / weights, [&](std::size_t k) { return views_.value(s, k); });
    pairs.take([&](std::size_t k, float value) { out.values[k].back() = value; });
}

void SurfaceMeans::append_as_it_is(const ViewSample &s, Ldi &out) const {
    const ViewSamples &view = views_.samples(s.view);
    append_place(out, volumes_,
                 {view.z(s.source), view.z_back(s.source), s.dx, s.dy, view.weight(s.source), 0, 0, {}});
    for (std::size_t k = 0; k < channels_.size(); ++k) out.values[k].push_back(views_.value(s, k));
}

void SurfaceMeans::append_seen(std::span<const ViewSample> samples, Ldi &out) const {
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
            sum += share.weight * double(views_.value(share, k));
            covers += share.weight * (by == npos ? 1 : double(views_.value(share, by)));
        }
        const bool stays = by == k || ids_[k] || is_in_matte(channels_[k]) || !(covers > 0);
        const double own = by == npos ? 1 : double(views_.value(centre, by));
        out.values[k].push_back(stays ? views_.value(centre, k) : float(own * (sum / covers)));
    }
}

void SurfaceMeans::append_hidden(std::span<const ViewSample> samples, Ldi &out) const {
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
    append_values(shares, 1, coverage, out);
}

void SurfaceMeans::append_of_pixels(std::span<const ViewSample> samples, Ldi &out) const {
    kernels::Mean mean{}; // double, because views may be many and depths close to each other
    for (const ViewSample &s : samples)
        kernels::add_to_mean(mean, s.weight, double(views_.samples(s.view).weight(s.source)), double(s.dx),
                             double(s.dy), double(s.inverse_z),
                             double(alpha_at(views_.samples(s.view), alpha_, s.source)));
    kernels::divide_mean(mean);
    const Imath::V2d place(samples[0].x + 0.5 + mean.dx, samples[0].y + 0.5 + mean.dy);
    const double coverage =
        samples[0].view == 0
            ? 1
            : coverage_by_votes(votes_on(views_, place, mean.inverse_z, tolerance_), mean.covers);
    if (coverage == 0) return;
    const bool alone = samples.size() == 1;
    const float z = alone ? views_.samples(samples[0].view).z(samples[0].source) : float(1 / mean.inverse_z);
    append_place(out, volumes_, {z, z, float(mean.dx), float(mean.dy), float(mean.merged), 0, 0, {}});
    append_values(samples, mean.weights, coverage, out);
}

void SurfaceMeans::append_beyond(const Imath::V2i &pixel, Ldi &out) const {
    for (const std::uint64_t i : parts_leave_frame(views_.samples(0), pixel)) {
        ViewSample s{};
        s.source = std::uint32_t(i);
        append_as_it_is(s, out);
    }
}

void SurfaceMeans::append_of_parts(const Surface &surface, Ldi &out) const {
    surface.seen_by_centre() ? append_seen(surface.samples, out) : append_hidden(surface.samples, out);
}

void SurfaceMeans::append_nearest(const Surface &surface, Ldi &out) const {
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
