#include "deep/checks/pose_check.h"

#include "view/flat_pixels.h"
#include "view/view_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace sparselens {

// What the pixels of a view tell about where it stood. In the centre view, each of them must land on the same surface,
// and so the same colour, or on a nearer surface that hides it from the centre. It never lies in front of what the
// centre view shows.

// A view with its channels found.
struct PosedPicture {
    explicit PosedPicture(const PackedView &picture)
        : view(picture), samples(picture.samples), rgb(find_rgb(samples.channels)) {}

    std::size_t index(const Imath::V2i &p) const { return samples.windows.index(p); }
    bool shows_something(const Imath::V2i &p) const { return samples.is_single(index(p)); } // a single sample
    double depth(const Imath::V2i &p) const { return samples.z(index(p)); }
    Imath::V3d colour(const Imath::V2i &p) const {
        const auto value = [&](std::size_t k) { return k == npos ? 0 : double(samples.value(k, index(p))); };
        return {value(rgb[0]), value(rgb[1]), value(rgb[2])};
    }

    const PackedView &view;
    const ViewSamples &samples;
    std::array<std::size_t, 3> rgb;
};

struct PoseVerdict {
    double contradiction = 0;  // [0, 1], the mean over the pixels that tell
    std::size_t told = 0;      // the number of these pixels: the centre view sees what they show
    std::size_t off_depth = 0; // the number whose depth contradicts; mirrors and glass mislead colours alone
};

class PoseEvidence {
public:
    // Chooses at most some ten thousand pixels of the view, whose colour or depth differs from that of neighbouring
    // pixels, because a surface without texture looks the same from everywhere. Both views must outlive the evidence.
    // `focal_px` is the focal length in pixels.
    PoseEvidence(const PackedView &centre, const PackedView &view, double focal_px);

    // The verdict if the view stands at `position`, and its optical axis meets the picture farther right and down by
    // `axis` display widths than its framing says. A pixel in front of what the centre view shows contradicts by 1; a
    // pixel on the same surface contradicts by the relative difference between its colour and the colours of this
    // surface around it. Its depth contradicts if it is in front, or nearer or farther than all that is there. One
    // pixel in `every` is tested.
    PoseVerdict at(const Imath::V2d &position, const Imath::V2d &axis = {0, 0}, std::size_t every = 1) const;

    // How many pixels the nearest chosen pixel moves per scene unit of the view's motion; 0 if there are none.
    double motion() const;
    std::size_t size() const { return pixels_.size(); }

private:
    struct Pixel {
        Imath::V2d place; // of the pixel's middle
        double z;
        Imath::V3d colour;
    };

    // Adds a pixel that lands at `landed` to the verdict, unless it may be hidden from the centre.
    void ask(const Imath::V2d &landed, const Pixel &pixel, PoseVerdict &verdict) const;

    PosedPicture centre_, view_;
    double focal_px_;
    std::vector<Pixel> pixels_;
};

namespace {

constexpr std::size_t enough = 200;    // pixels that tell
constexpr double clearly = 0.7;        // times the contradiction
constexpr std::size_t few = 9;         // depths that contradict by chance: three standard deviations
constexpr double few_left = 0.3;       // of the depths that contradicted
constexpr double at_least = 0.01;      // a smaller contradiction is rounding or noise
constexpr double least_motion = 1;     // pixels; a view that moves less looks the same
constexpr double least_turned = 3;     // pixels; less may be aliases of thin things
constexpr double usual_motion = 16;    // of a view from the rim, pixels
constexpr double fine_motion = 0.25;   // pixels
constexpr double worth_turning = 0.05; // a smaller contradiction comes from noise
constexpr double farthest_turned = 48; // pixels
constexpr double turning_step = 1.5;   // pixels
constexpr std::size_t some = 4;        // one pixel in this many tells roughly how far a view is turned
constexpr double one_side = 175;       // degrees; all other views stand within this angle
constexpr double equally_far = 1.2;    // ratio of distances

// Whether fewer depths tell against `a` than against `b`, by more than chance: three standard deviations.
bool depth_prefers(const PoseVerdict &a, const PoseVerdict &b) {
    const auto off_a = double(a.off_depth), off_b = double(b.off_depth);
    return off_b - off_a > 3 * std::sqrt(off_a + off_b);
}

// Judges by colours and depths together, or by depths alone.
bool is_clear(const PoseVerdict &better, const PoseVerdict &stated) {
    return better.contradiction < std::min(clearly * stated.contradiction, stated.contradiction - at_least) ||
           (double(better.off_depth) < clearly * double(stated.off_depth) && depth_prefers(better, stated));
}

// Whether few depths contradict, or far fewer than before: where things are thin, colours alone may agree by chance.
bool depths_agree(const PoseVerdict &better, const PoseVerdict &stated) {
    return better.off_depth <= few || double(better.off_depth) <= few_left * double(stated.off_depth);
}

// The best of the positions tried so far: the least contradicted by depths, and among equals the least contradicted
// overall. A position from which much less is seen does not count, because little can contradict it.
class Search {
public:
    Search(const PoseEvidence &evidence, const Imath::V2d &stated)
        : evidence_(evidence), stated_(evidence.at(stated)), best_(stated), least_(stated_) {}

    void attempt(const Imath::V2d &position) {
        const PoseVerdict there = evidence_.at(position);
        if (there.told < enough || 2 * there.told < stated_.told || depth_prefers(least_, there)) return;
        if (!depth_prefers(there, least_) && there.contradiction >= least_.contradiction) return;
        least_ = there;
        best_ = position;
    }

    // Tries positions around the best one, at ever smaller distances, along `axes`.
    void refine(double step, std::span<const Imath::V2d> axes) {
        while (step * evidence_.motion() > fine_motion) {
            const Imath::V2d before = best_;
            for (const Imath::V2d &axis : axes)
                for (const double way : {step, -step}) attempt(before + axis * way);
            if (best_ == before) step /= 2;
        }
    }

    const Imath::V2d &best() const { return best_; }
    const PoseVerdict &stated() const { return stated_; }
    const PoseVerdict &there() const { return least_; }

private:
    const PoseEvidence &evidence_;
    PoseVerdict stated_;
    Imath::V2d best_;
    PoseVerdict least_;
};

void search_around_centre(double reach, Search &search) {
    constexpr int directions = 16;
    for (const double distance : {0.25 * reach, 0.5 * reach, reach})
        for (int k = 0; k < directions; ++k) {
            const double angle = 2 * std::numbers::pi * k / directions;
            search.attempt(distance * Imath::V2d(std::cos(angle), std::sin(angle)));
        }
    constexpr std::array axes{Imath::V2d(1, 0), Imath::V2d(0, 1)};
    if (search.best() != Imath::V2d(0, 0)) search.refine(0.1 * reach, axes);
}

// Tries the stated position with a wrong sign, axis or unit.
void search_around(const Imath::V2d &at, Search &search) {
    for (const Imath::V2d &other : {Imath::V2d(0, 0), -at, Imath::V2d(-at.x, at.y), Imath::V2d(at.x, -at.y),
                                    Imath::V2d(at.y, at.x), Imath::V2d(-at.y, -at.x)})
        search.attempt(other);
    const Imath::V2d turned = search.best();
    for (const double factor : {0.25, 0.4, 0.5, 0.63, 0.8, 1.25, 1.6, 2.0, 2.5, 4.0})
        search.attempt(at * factor);
    const std::array along{at.normalized()};
    if (search.best() != turned) search.refine(0.1 * search.best().length(), along);
}

struct Found {
    Imath::V2d position;
    PoseVerdict there, stated;
};

std::optional<Found> find_position(const PoseEvidence &evidence, const PackedView &view, double reach) {
    const double motion = evidence.motion(), stated = view.position.length();
    if (evidence.size() < enough || !(motion > 0)) return {};
    if (stated > 0 && stated * motion < least_motion) return {}; // the view looks the same from the centre
    Search search(evidence, view.position);
    if (search.stated().told < enough) return {};
    if (stated > 0)
        search_around(view.position, search);
    else
        search_around_centre(reach > 0 ? reach : usual_motion / motion, search);
    const double moved = (search.best() - view.position).length() * motion;
    const Found found{search.best(), search.there(), search.stated()};
    if (!is_clear(found.there, found.stated) || !depths_agree(found.there, found.stated)) return {};
    return moved < least_motion ? std::nullopt : std::optional(found);
}

// Whether the position only moves the view nearer to the centre or farther out. What mirrors and glass show moves in
// this way too, and may fill the picture; then only depths can tell.
bool is_along(const Imath::V2d &position, const Imath::V2d &stated) {
    return stated.length() > 0 && position.dot(stated) >= (1 - 1e-9) * position.length() * stated.length();
}

} // namespace

std::optional<Imath::V2d> better_position(const PackedView &centre, const PackedView &view, double focal_px,
                                          double reach) {
    const auto found = find_position(PoseEvidence(centre, view, focal_px), view, reach);
    if (!found) return {};
    if (is_along(found->position, view.position) && !depth_prefers(found->there, found->stated)) return {};
    return found->position;
}

std::optional<Imath::V2d> turned_by(const PackedView &centre, const PackedView &view, double focal_px,
                                    double reach) {
    const PoseEvidence evidence(centre, view, focal_px);
    const PoseVerdict stated = evidence.at(view.position);
    if (stated.told < enough || stated.contradiction < worth_turning) return {};
    const double width = view.samples.windows.display_width();
    Imath::V2d best(0, 0); // pixels, right and down
    PoseVerdict least{.contradiction = 1};
    const auto attempt = [&](const Imath::V2d &axis, std::size_t every) {
        const PoseVerdict there = evidence.at(view.position, axis / width, every);
        const std::size_t told = there.told * every;
        if (told < enough || 2 * told < stated.told || there.contradiction >= least.contradiction) return;
        least = there;
        best = axis;
    };
    attempt({0, 0}, some);
    std::vector<Imath::V2d> directions{{1, 0}, {0, 1}};
    if (view.position.length() > 0)
        directions.push_back(Imath::V2d(view.position.x, -view.position.y).normalized()); // aimed at a point
    for (const Imath::V2d &direction : directions)
        for (double by = 1; by <= farthest_turned; by += turning_step)
            for (const double way : {by, -by}) attempt(direction * way, some);
    least = {.contradiction = 1};
    attempt(best, 1);
    for (double step = turning_step; step >= fine_motion;) {
        const Imath::V2d before = best;
        for (const Imath::V2d &axis : {Imath::V2d(1, 0), Imath::V2d(0, 1)})
            for (const double way : {step, -step}) attempt(before + axis * way, 1);
        if (best == before) step /= 2;
    }
    if (best.length() < least_turned || !is_clear(least, stated) || !depth_prefers(least, stated)) return {};
    if (const auto moved = find_position(evidence, view, reach);
        moved && (moved->there.contradiction <= least.contradiction || depth_prefers(moved->there, least)))
        return {};
    const double degrees = 180 / std::numbers::pi;
    return Imath::V2d(-std::atan2(best.x, focal_px), std::atan2(best.y, focal_px)) * degrees;
}

std::optional<std::size_t> same_picture(std::span<const PackedView> views, std::size_t i, double focal_px) {
    const PackedView &view = views[i];
    for (std::size_t other = 0; other < i; ++other) {
        if ((views[other].samples <=> view.samples) != 0) continue;
        const PoseEvidence evidence(views[other], view, focal_px);
        const double moved = (view.position - views[other].position).length() * evidence.motion();
        if (evidence.size() >= enough && moved >= least_motion) return other;
    }
    return {};
}

std::optional<std::size_t> same_picture_and_place(std::span<const PackedView> views, std::size_t i) {
    const PackedView &view = views[i];
    const auto shows_something = [](float z) { return z > 0; };
    if (std::ranges::none_of(view.samples.depths(), shows_something))
        return {}; // a view without any pixel worth rendering
    for (std::size_t other = 0; other < i; ++other)
        if (views[other].position == view.position && (views[other].samples <=> view.samples) == 0)
            return other;
    return {};
}

bool first_is_at_the_edge(std::span<const PackedView> views, double lens_radius) {
    std::vector<double> directions, distances;
    for (const PackedView &view : views.subspan(1)) {
        if (view.position == Imath::V2d(0, 0)) continue;
        directions.push_back(std::atan2(view.position.y, view.position.x) * 180 / std::numbers::pi);
        distances.push_back(view.position.length());
    }
    if (directions.size() < 2) return false;
    std::ranges::sort(directions);
    double widest_gap = directions.front() + 360 - directions.back();
    for (std::size_t i = 1; i < directions.size(); ++i)
        widest_gap = std::max(widest_gap, directions[i] - directions[i - 1]);
    const auto [nearest, farthest] = std::ranges::minmax(distances);
    const bool beyond_lens = lens_radius > 0 && farthest > equally_far * lens_radius;
    return 360 - widest_gap < one_side && (farthest > equally_far * nearest || beyond_lens);
}

std::optional<std::size_t> view_in_the_middle(std::span<const PackedView> views) {
    Imath::V2d middle(0, 0);
    for (const PackedView &view : views) middle += view.position / double(views.size());
    const auto off = [&](const PackedView &view) { return (view.position - middle).length(); };
    const auto nearest = std::ranges::min_element(views, {}, off);
    const double farthest = off(*std::ranges::max_element(views, {}, off));
    if (off(*nearest) > 0.25 * farthest) return {};
    return std::size_t(nearest - views.begin());
}

namespace {

constexpr double samples_a_side = 128; // of the view's pixels, enough to tell
constexpr int beside = 2;              // pixels
constexpr double contrast = 0.1;       // relative difference of colour
constexpr double jump = 1.05;          // ratio of depths
constexpr double same_depth = 1.04;    // ratio; nearer samples are in front
constexpr double rounding = 1e-3;      // of depths, relative: the precision of half

bool holds(const Imath::Box2i &data, const Imath::V2d &p) {
    return p.x >= data.min.x && p.x < data.max.x + 1.0 && p.y >= data.min.y && p.y < data.max.y + 1.0;
}

// Whether the pixel differs from the pixel to the right or the pixel below.
bool stands_out(const PosedPicture &picture, const Imath::V2i &p) {
    for (const Imath::V2i &q : {p + Imath::V2i(beside, 0), p + Imath::V2i(0, beside)}) {
        if (!picture.samples.windows.data.intersects(q) || !picture.shows_something(q)) continue;
        const double z = picture.depth(p), other = picture.depth(q);
        if (z > jump * other || other > jump * z) return true;
        if (relative_difference(picture.colour(p), picture.colour(q)) > contrast) return true;
    }
    return false;
}

} // namespace

PoseEvidence::PoseEvidence(const PackedView &centre, const PackedView &view, double focal_px)
    : centre_(centre), view_(view), focal_px_(focal_px) {
    const Windows &w = view.samples.windows;
    const Imath::V2i step(int(std::ceil(w.width() / samples_a_side)),
                          int(std::ceil(w.height() / samples_a_side)));
    for (int y = w.data.min.y; y <= w.data.max.y; y += step.y)
        for (int x = w.data.min.x; x <= w.data.max.x; x += step.x) {
            const Imath::V2i p(x, y);
            if (view_.shows_something(p) && stands_out(view_, p))
                pixels_.push_back({Imath::V2d(p) + Imath::V2d(0.5), view_.depth(p), view_.colour(p)});
        }
}

PoseVerdict PoseEvidence::at(const Imath::V2d &position, const Imath::V2d &axis, std::size_t every) const {
    Framing framing = view_.view.framing;
    framing.principal_point += axis;
    const ViewMapping mapping(position, focal_px_, view_.samples.windows, framing,
                              centre_.view.framing.principal_point);
    PoseVerdict verdict;
    for (std::size_t i = 0; i < pixels_.size(); i += every) {
        const Pixel &pixel = pixels_[i];
        const Imath::V2d landed =
            mapping.at_infinity(pixel.place) + mapping.parallax(pixel.place) * (1 / pixel.z);
        if (!holds(centre_.samples.windows.data, landed)) continue;
        ask(landed, pixel, verdict);
    }
    if (verdict.told > 0) verdict.contradiction /= double(verdict.told);
    return verdict;
}

// The landing point is known to a pixel: any of the four pixels around it may show the same surface, or one that hides
// it.
void PoseEvidence::ask(const Imath::V2d &landed, const Pixel &pixel, PoseVerdict &verdict) const {
    Imath::V3d least(0), most(0);
    double nearest = std::numeric_limits<double>::infinity(),
           farthest = 0; // a steep surface may lie anywhere between
    bool seen = false, hidden = false;
    for (const double dx : {-0.5, 0.5})
        for (const double dy : {-0.5, 0.5}) {
            const Imath::V2i p(int(std::floor(landed.x + dx)), int(std::floor(landed.y + dy)));
            const bool inside = centre_.samples.windows.data.intersects(p);
            if (inside && !centre_.shows_something(p)) continue;
            const double z = inside ? centre_.depth(p) : pixel.z; // beyond the frame there may be anything
            nearest = std::min(nearest, z);
            farthest = std::max(farthest, z);
            if (!inside) continue;
            hidden = hidden || pixel.z > same_depth * z;
            if (pixel.z > same_depth * z || z > same_depth * pixel.z) continue;
            const Imath::V3d there = centre_.colour(p);
            for (int k = 0; k < 3; ++k) {
                least[k] = seen ? std::min(least[k], there[k]) : there[k];
                most[k] = seen ? std::max(most[k], there[k]) : there[k];
            }
            seen = true;
        }
    if (!seen && hidden) return;
    ++verdict.told;
    verdict.off_depth += !seen || pixel.z < nearest * (1 - rounding) || pixel.z > farthest * (1 + rounding);
    Imath::V3d closest;
    for (int k = 0; k < 3; ++k) closest[k] = std::clamp(pixel.colour[k], least[k], most[k]);
    verdict.contradiction += seen ? relative_difference(closest, pixel.colour) : 1;
}

double PoseEvidence::motion() const {
    const auto nearest = std::ranges::min_element(pixels_, {}, &Pixel::z);
    return nearest == pixels_.end() ? 0 : focal_px_ / nearest->z;
}

} // namespace sparselens
