#include "plan/block_motion.h"

#include "base/parallel.h"
#include "plan/noise.h"
#include "plan/tuning.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

constexpr int block_size = 8;

// Whether two depths may be of one surface, seen at two times or in adjacent pixels.
bool same_surface(float a, float b) {
    constexpr auto most = float(PlanTuning::depths_of_surface);
    return a <= most * b && b <= most * a;
}

// The brightness of some pixels of a view, averaged over squares, and their depths; not a number in squares that show
// several surfaces. Each surface is slightly blurred, so that it changes little within a fraction of a square.
struct Reduced {
    ArrayGrid grid; // of squares
    std::vector<double> values;
    std::vector<float> depths;

    Reduced(const View &view, const Imath::Box2i &box, int side)
        : grid((box.max.x - box.min.x + 1) / side, (box.max.y - box.min.y + 1) / side), values(grid.size()),
          depths(grid.size()) {
        const std::vector<double> all = brightness(view.image);
        std::vector<double> squares(grid.size());
        parallel_for(squares.size(), [&](std::size_t i) {
            const Imath::V2i corner = box.min + (grid.position(i) - Position()) * side;
            depths[i] = view.z[view.image.windows.index(corner)];
            for (int y = corner.y; y < corner.y + side; ++y)
                for (int x = corner.x; x < corner.x + side; ++x) {
                    const std::size_t pixel = view.image.windows.index(Imath::V2i(x, y));
                    squares[i] += all[pixel] / (side * side);
                    if (!same_surface(view.z[pixel], depths[i]))
                        depths[i] = std::numeric_limits<float>::quiet_NaN();
                }
        });
        parallel_for(squares.size(), [&](std::size_t i) { values[i] = blurred(squares, i); });
    }

private:
    double blurred(const std::vector<double> &squares, std::size_t i) const {
        double sum = 0, weights = 0;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const Position at = grid.position(i) + Imath::V2i(dx, dy);
                if (!grid.contains(at) || !same_surface(depths[grid.index(at)], depths[i])) continue;
                const double weight = (2 - std::abs(dx)) * (2 - std::abs(dy));
                sum += weight * squares[grid.index(at)];
                weights += weight;
            }
        return sum / weights;
    }
};

// Finds the surface in the middle of a block of one picture in another one.
class Search {
public:
    Search(const Reduced &from, const Reduced &to, const Position &corner, const Imath::V2d &expected)
        : from_(from), to_(to), corner_(corner),
          expected_(int(std::lround(expected.x)), int(std::lround(expected.y))),
          reach_(from.grid.width() / PlanTuning::motion_reach) {
        const float middle = from.depths[from.grid.index(corner + Imath::V2i(block_size / 2))];
        for (int y = 0; y < block_size; ++y)
            for (int x = 0; x < block_size; ++x)
                if (same_surface(from.depths[from.grid.index(corner + Imath::V2i(x, y))], middle))
                    surface_.push_back({x, y});
        most_ = most_different();
    }

    // In whole squares, and exactly.
    struct Displacement {
        Imath::V2i whole;
        Imath::V2d exact;
    };
    // Empty if the surface is too small here, has no texture or is not found.
    std::optional<Displacement> displacement() const {
        if (most_ == 0) return {};
        Imath::V2i found = valley(expected_);
        if (different(found) > most_) found = valley(closest());
        if (!(different(found) <= most_)) return {};
        return Displacement{found,
                            Imath::V2d(found) + Imath::V2d(between(found, {1, 0}), between(found, {0, 1}))};
    }

private:
    // Up to this mean square of the difference the surface is found again; 0 if it is too small or has no texture.
    double most_different() const {
        double sum = 0, squares = 0;
        for (const Imath::V2i &at : surface_) {
            const double value = from_.values[from_.grid.index(corner_ + at)];
            sum += value;
            squares += value * value;
        }
        const auto count = double(surface_.size());
        const double variance = (squares - sum * sum / count) / count;
        if (count < PlanTuning::least_surface || variance < PlanTuning::least_texture) return 0;
        return PlanTuning::most_unlike * variance;
    }

    // The mean square of the difference of what both pictures show of the surface; infinite if that is too little.
    double different(const Imath::V2i &by) const {
        constexpr double nothing = std::numeric_limits<double>::infinity();
        const Position to = corner_ + by;
        if (!to_.grid.contains(to) || !to_.grid.contains(to + Imath::V2i(block_size - 1))) return nothing;
        double squares = 0;
        int count = 0;
        for (const Imath::V2i &at : surface_) {
            const std::size_t a = from_.grid.index(corner_ + at), b = to_.grid.index(to + at);
            if (!same_surface(from_.depths[a], to_.depths[b])) continue;
            const double difference = from_.values[a] - to_.values[b];
            squares += difference * difference;
            ++count;
        }
        return count < PlanTuning::least_seen_again * double(surface_.size()) ? nothing : squares / count;
    }

    // The displacement with about the least difference that is closest to the expected one.
    Imath::V2i closest() const {
        std::vector<std::pair<double, Imath::V2i>> all;
        for (int y = -reach_; y <= reach_; ++y)
            for (int x = -reach_; x <= reach_; ++x) {
                const Imath::V2i by(x, y);
                all.emplace_back(different(expected_ + by), by);
            }
        const auto difference = [](const auto &one) { return one.first; };
        const double most = PlanTuning::equally_good * std::ranges::min(all, {}, difference).first;
        std::erase_if(all, [&](const auto &one) { return !(one.first <= most); });
        if (all.empty()) return expected_;
        return expected_ +
               std::ranges::min(all, {}, [](const auto &one) { return one.second.length2(); }).second;
    }

    // Walks down to a local minimum of the difference.
    Imath::V2i valley(Imath::V2i at) const {
        for (;;) {
            Imath::V2i best = at;
            for (const Imath::V2i &step : {Imath::V2i(1, 0), {-1, 0}, {0, 1}, {0, -1}})
                if (different(at + step) < different(best)) best = at + step;
            if (best == at) return at;
            at = best;
        }
    }

    // The part of a pixel by which the least of a parabola through three differences lies beside the middle one.
    double between(const Imath::V2i &at, const Imath::V2i &step) const {
        const double before = different(at - step), middle = different(at), after = different(at + step),
                     bend = before + after - 2 * middle;
        return std::isfinite(bend) && bend > 0 ? std::clamp((before - after) / bend / 2, -0.5, 0.5) : 0;
    }

    const Reduced &from_, &to_;
    Position corner_;
    Imath::V2i expected_;
    int reach_;
    std::vector<Imath::V2i> surface_; // its pixels in the block
    double most_ = 0;
};

// The displacement of a block, if the way back leads to where it came from. It does not if something has covered it.
// Along an edge, both searches miss by the same fraction of a square in the same direction: their difference is exact.
std::optional<Imath::V2d> there_and_back(const Reduced &first, const Reduced &second, const Position &corner,
                                         const Imath::V2d &expected) {
    const auto there = Search(first, second, corner, expected).displacement();
    if (!there) return {};
    const auto back = Search(second, first, corner + there->whole, -expected).displacement();
    if (!back || (there->exact + back->exact).length() > PlanTuning::way_back) return {};
    return back->whole == -there->whole ? (there->exact - back->exact) / 2.0 : there->exact;
}

using Displacements = std::vector<std::optional<Imath::V2d>>;

// Whether enough of the blocks around have moved alike.
bool agrees(const Displacements &found, const ArrayGrid &blocks, std::size_t i) {
    const Imath::V2d own = *found[i];
    const double most = PlanTuning::alike_pixels + PlanTuning::alike_share * own.length();
    int alike = -1; // itself
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const Position at = blocks.position(i) + Imath::V2i(dx, dy);
            if (!blocks.contains(at)) continue;
            const auto &other = found[blocks.index(at)];
            alike += other && (*other - own).length() <= most;
        }
    return alike >= PlanTuning::least_alike;
}

} // namespace

std::vector<BlockMotion> block_motions(const View &first, const View &second,
                                       const ExpectedMotion &expected) {
    const Imath::Box2i common = common_box(first.image.windows.data, second.image.windows.data);
    if (common.isEmpty()) return {};
    const int side = pieces_of(common.max.x - common.min.x + 1, PlanTuning::motion_width);
    const Reduced a(first, common, side), b(second, common, side);
    const ArrayGrid blocks(a.grid.width() / block_size, a.grid.height() / block_size);
    Displacements found(blocks.size());
    const auto box = [&](std::size_t i) {
        const Imath::V2i corner = common.min + (blocks.position(i) - Position()) * block_size * side;
        return Imath::Box2i(corner, corner + Imath::V2i(block_size * side - 1));
    };
    parallel_for(blocks.size(), [&](std::size_t i) {
        const Imath::V2d by = expected((box(i).min + box(i).max) / 2) / side;
        if (std::max(std::abs(by.x), std::abs(by.y)) < a.grid.width()) // else it has left the picture
            found[i] = there_and_back(a, b, Position() + (blocks.position(i) - Position()) * block_size, by);
    });
    std::vector<BlockMotion> motions;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i] && agrees(found, blocks, i)) motions.push_back({box(i), *found[i] * side});
    return motions;
}

namespace {

// The CoC of the sharpest surface in a block, whose steps show first.
double least_coc(const View &view, const ThinLens &lens, const Imath::Box2i &box) {
    double least = std::numeric_limits<double>::infinity();
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x)
            least = std::min(least, std::abs(circle_of_confusion(
                                        lens, double(view.z[view.image.windows.index(Imath::V2i(x, y))]))));
    return least;
}

// The value that only a few of them exceed.
double nearly_largest(std::vector<double> values) {
    const auto few = std::size_t(PlanTuning::few_blocks * double(values.size()));
    const auto at = values.end() - 1 - std::ptrdiff_t(few);
    std::ranges::nth_element(values, at);
    return *at;
}

} // namespace

double longest_step(double coc) {
    return PlanTuning::step_in_focus + PlanTuning::step_of_coc * std::abs(coc);
}

std::optional<MomentsNeed> moments_needed(const View &first, const View &second, const ThinLens &lens,
                                          const ExpectedMotion &expected, double part, int across) {
    std::vector<double> motions, steps;
    for (const BlockMotion &block : block_motions(first, second, expected)) {
        motions.push_back(block.motion.length() / part / across);
        steps.push_back(motions.back() / longest_step(least_coc(first, lens, block.box) / across));
    }
    if (motions.empty()) return {};
    return MomentsNeed{nearly_largest(motions), std::max(1, int(std::ceil(nearly_largest(steps))))};
}

} // namespace sparselens
