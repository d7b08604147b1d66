#include "warp/surfaces.h"

#include "base/coverage.h"
#include "kernels/surface.h"

#include <algorithm>
#include <cmath>
#include <optional>

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
    const SampleRange nearest = centre.pixel(centre.windows.index(pixel.x, pixel.y));
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

} // namespace sparselens
