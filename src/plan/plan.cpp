#include "plan/plan.h"

#include "base/error.h"
#include "base/parallel.h"
#include "finish/tuning.h"
#include "lens/lens_points.h"
#include "plan/noise.h"
#include "plan/tuning.h"
#include "view/lens_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace sparselens {

namespace {

struct Candidate {
    Imath::V2d u{0, 0};
    PixelMask hidden, wanted;
    // pixels of the centre view behind which something appears, ascending
    std::vector<std::uint32_t> uncovers;
    double cost = 0; // pixels to render
};

// The places in the centre view of what the hidden pixels show, at the depth found beside the hole, on the side from
// which the nearer surface moved away.
std::vector<std::uint32_t> uncovered_places(const MovedDepth &moved, const PixelMask &hidden,
                                            const Imath::V2d &u, double pixel_aspect) {
    const Imath::V2d step(u.x, -u.y * pixel_aspect);
    const ArrayGrid grid(hidden.width(), hidden.height());
    const double longest = 2.0 * std::max(grid.width(), grid.height());
    std::vector<std::uint32_t> places;
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x) {
            if (!hidden.set[grid.index(Position(x, y))]) continue;
            float behind = MovedDepth::nothing;
            for (double t = 1; behind == MovedDepth::nothing && t < longest; ++t) {
                const int at_x = int(std::lround(x + t * step.x)), at_y = int(std::lround(y + t * step.y));
                if (!grid.contains(Position(at_x, at_y))) break;
                behind = moved.depth[grid.index(Position(at_x, at_y))];
            }
            const double depth = std::max(behind, 0.0f);
            const double place_x = std::round(x + depth * step.x), place_y = std::round(y + depth * step.y);
            if (place_x < 0 || place_y < 0 || place_x >= grid.width() || place_y >= grid.height()) continue;
            places.push_back(std::uint32_t(grid.index(Position(int(place_x), int(place_y)))));
        }
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
}

void unite(PixelMask &mask, const PixelMask &other) {
    std::ranges::transform(mask.set, other.set, mask.set.begin(), std::bit_or<>());
}

PixelMask with_margins(const PixelMask &openings, int margin) {
    PixelMask wanted = grown(without_slits(openings), margin);
    unite(wanted, grown(openings, std::min(margin, PlanTuning::slit_margin)));
    return wanted;
}

Candidate look_from(const View &centre, const ThinLens &lens, const Imath::V2d &u, int margin) {
    const MovedDepth moved = move_depth(centre.image.windows, centre.z, lens, u);
    Candidate candidate{u, disoccluded(moved), with_margins(unseen_by_centre(moved), margin), {}};
    unite(candidate.wanted, moved.edge);
    candidate.cost = double(candidate.wanted.count());
    candidate.uncovers = uncovered_places(moved, candidate.hidden, u, lens.pixel_aspect);
    return candidate;
}

// Counts what a growing choice of candidates uncovers together.
class Uncovered {
public:
    explicit Uncovered(std::size_t pixels) : seen_(pixels) {}

    std::size_t gain(const Candidate &candidate) const {
        return std::size_t(
            std::ranges::count_if(candidate.uncovers, [&](auto place) { return !seen_[place]; }));
    }
    void add(const Candidate &candidate) {
        total_ += gain(candidate);
        for (const std::uint32_t place : candidate.uncovers) seen_[place] = 1;
    }
    std::size_t total() const { return total_; }

private:
    std::vector<std::uint8_t> seen_;
    std::size_t total_ = 0;
};

using Choice = std::vector<std::size_t>; // indices of candidates, in the order they were chosen

struct Worth {
    double uncovered = 0, cost = 0;
};

Worth worth_of(const Choice &choice, std::span<const Candidate> candidates, std::size_t pixels) {
    Uncovered uncovered(pixels);
    Worth worth;
    for (const std::size_t i : choice) {
        uncovered.add(candidates[i]);
        worth.cost += candidates[i].cost;
    }
    worth.uncovered = double(uncovered.total());
    return worth;
}

// Repeatedly takes the candidate that uncovers most of the rest, relative to its cost.
Choice greedy(std::span<const Candidate> candidates, std::size_t count, std::size_t pixels) {
    Uncovered uncovered(pixels);
    Choice choice;
    while (choice.size() < std::min(count, candidates.size())) {
        std::size_t best = 0;
        double most = 0;
        for (std::size_t i = 0; i < candidates.size(); ++i)
            if (const double gain = double(uncovered.gain(candidates[i])) / std::max(candidates[i].cost, 1.0);
                gain > most) {
                most = gain;
                best = i;
            }
        if (most == 0) break;
        uncovered.add(candidates[best]);
        choice.push_back(best);
    }
    return choice;
}

// Takes candidates spread evenly, from candidate 0 on.
Choice ring(std::size_t candidates, std::size_t count) {
    Choice choice;
    for (std::size_t k = 0; k < count; ++k) choice.push_back(k * candidates / count);
    return choice;
}

Choice choose(std::span<const Candidate> candidates, std::size_t count, std::size_t pixels) {
    const Choice even = ring(candidates.size(), count), best = greedy(candidates, count, pixels);
    const Worth of_even = worth_of(even, candidates, pixels), of_best = worth_of(best, candidates, pixels);
    const bool more =
        of_best.uncovered * of_even.cost > PlanTuning::noticeably_more * of_even.uncovered * of_best.cost;
    return more && of_best.uncovered > PlanTuning::about_as_much * of_even.uncovered ? best : even;
}

OverscanNeed overscan_of(const View &centre, const ThinLens &lens) {
    const Windows &w = centre.image.windows;
    const auto largest_coc = [&](Imath::V2i at, const Imath::V2i &step, int count, int most,
                                 double stretch = 1) {
        double largest = 0;
        for (int i = 0; i < count; ++i, at += step) {
            const std::size_t pixel = std::size_t(at.y) * std::size_t(w.width()) + std::size_t(at.x);
            largest = std::max(largest, std::abs(circle_of_confusion(lens, centre.z[pixel])));
        }
        return int(std::min(std::ceil(largest * stretch), double(most)));
    };
    const int right = w.width() - 1, bottom = w.height() - 1;
    return {largest_coc({0, 0}, {0, 1}, w.height(), w.width()),
            largest_coc({0, 0}, {1, 0}, w.width(), w.height(), lens.pixel_aspect),
            largest_coc({right, 0}, {0, 1}, w.height(), w.width()),
            largest_coc({0, bottom}, {1, 0}, w.width(), w.height(), lens.pixel_aspect)};
}

PixelMask everything(const Imath::Box2i &window) {
    PixelMask mask(window);
    std::ranges::fill(mask.set, std::uint8_t{1});
    return mask;
}

} // namespace

double Plan::share() const {
    double sum = 0;
    for (const PlannedView &view : views) sum += double(view.mask.count()) / double(view.mask.set.size());
    return sum;
}

namespace {

// Measures the noise of the centre view, and returns the pixels whose noise is worth further samples.
PixelMask find_noise(const View &centre, const ThinLens &lens, const PlanOptions &options, Plan &plan) {
    const std::vector<double> noise = noise_in_lens_picture(centre.image, centre.z, lens, options.noise);
    plan.noise = std::accumulate(noise.begin(), noise.end(), 0.0) / double(noise.size());
    plan.full_views = plan.noise > PlanTuning::noise_that_pays;
    PixelMask noisy(centre.image.windows.data);
    std::ranges::transform(noise, noisy.set.begin(), [&](double value) {
        return plan.full_views || value > PlanTuning::noise_of_a_pixel_that_pays;
    });
    plan.noisy = noisy.count();
    return noisy;
}

// All pixels of a view that are worth rendering.
PixelMask worth_of_view(const Candidate &candidate, const View &centre, const ThinLens &lens,
                        const Plan &plan, const PixelMask &noisy) {
    if (plan.full_views) return everything(centre.image.windows.data);
    PixelMask wanted = candidate.wanted;
    if (plan.noisy > 0)
        unite(wanted, pixels_that_show(move_depth(centre.image.windows, centre.z, lens, candidate.u), noisy,
                                       lens, candidate.u));
    return wanted;
}

} // namespace

Plan make_plan(const View &centre, const ThinLens &lens, const PlanOptions &options, Progress &progress) {
    Plan plan;
    if (lens.radius == 0 || options.views == 0) return plan;
    plan.overscan = overscan_of(centre, lens);
    plan.edges = share_at_edges(centre.image.windows, centre.z, lens);
    if (options.across == 1 && plan.edges >= PlanTuning::many_edges) plan.supersample = 2;
    const PixelMask noisy = find_noise(centre, lens, options, plan);

    const int around = options.views * pieces_of(PlanTuning::least_candidates, options.views);
    const std::vector<Imath::V2d> points = rim_lens_points(around);
    std::vector<Candidate> candidates(points.size());
    progress.start("planning", points.size());
    parallel_for(points.size(), [&](std::size_t i) {
        candidates[i] = look_from(centre, lens, points[i], options.margin);
        progress.advance();
    });
    const std::size_t pixels = centre.image.windows.pixels();
    const std::size_t count = std::min(std::size_t(options.views), candidates.size());
    Uncovered uncovered(pixels);
    for (const std::size_t i : choose(candidates, count, pixels)) {
        const Candidate &candidate = candidates[i];
        const bool adds = uncovered.gain(candidate) >= PlanTuning::least_gain ||
                          double(plan.noisy) > PlanTuning::few_noisy * double(pixels);
        uncovered.add(candidate);
        if (adds)
            plan.views.push_back(
                {candidate.u, worth_of_view(candidate, centre, lens, plan, noisy), candidate.hidden.count()});
    }
    return plan;
}

namespace {

PlannedCamera camera_at(const Camera &centre, const Imath::V2d &offset, std::string name) {
    return {std::move(name), offset, moved_across_lens(centre, offset).world_to_camera};
}

} // namespace

PlannedCameras cameras_of(const Plan &plan, const Camera &camera, const ThinLens &lens, int display_width) {
    PlannedCameras result;
    const double width = display_width / lens.focal_px;
    const Imath::V2d axis =
        camera.principal_point.value_or(Imath::V2d(0, 0)); // to the right of and below the middle
    result.window = {width, {0 - axis.x * width, axis.y * width}};
    result.cameras.push_back(camera_at(camera, {0, 0}, "center"));
    for (std::size_t k = 0; k < plan.views.size(); ++k)
        result.cameras.push_back(camera_at(camera, plan.views[k].u * lens.radius, fmt::format("view_{}", k)));
    return result;
}

Imath::M44d camera_to_world_looking_back(const Imath::M44d &world_to_camera) {
    Imath::M44d placement = world_to_camera.inverse();
    for (int column = 0; column < 3; ++column) placement[2][column] = -placement[2][column];
    return placement;
}

RayDivision divide_rays(int rays, int views, int supersample, double noise) {
    const int per_view = std::min(rays / views, FinishTuning::rays_per_view);
    if (per_view < 1)
        throw UsageError(fmt::format("`rays`: {} for each pixel are too few for {} views", rays, views));
    const int file_pixels = supersample * supersample; // that make one pixel of the picture
    RayDivision division{views, 1, per_view, 0};
    if (per_view >= file_pixels) division = {views, supersample, per_view / file_pixels, 0};
    division.per_render = (rays - division.of_views()) / 2;
    if (per_view < FinishTuning::rays_per_view) division.per_render = 0;
    division.noise = noise;
    division.alone = noise < FinishTuning::noise_that_views_do_not_reach;
    return division;
}

} // namespace sparselens
