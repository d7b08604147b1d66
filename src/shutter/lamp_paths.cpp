#include "shutter/lamp_paths.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

namespace sparselens {

namespace {

using Tuning = LampPathTuning;

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
constexpr double infinity = std::numeric_limits<double>::infinity();

auto order_of(const Imath::V2f &at, float depth) { return std::tuple(at.y, at.x, depth); }

// A lamp of one moment.
struct WholeLamp {
    Imath::V2d at{0, 0}; // the middle of its light
    double depth = 0;
    std::array<double, 3> light{};
    std::vector<std::size_t> parts; // indices

    double sum() const { return light[0] + light[1] + light[2]; }
};

bool within(double a, double b, double ratio) { return std::max(a, b) <= ratio * std::min(a, b); }

// Finds the number of the lamp that each part belongs to: parts side by side, at one depth, are one lamp.
class Joining {
public:
    // `parts`: sorted by order_of().
    explicit Joining(std::span<const LampPart> parts) : parts_(parts), of_(parts.size()) {
        std::iota(of_.begin(), of_.end(), std::size_t{0});
        for (std::size_t i = 0; i < parts.size(); ++i) join_with_earlier(i);
    }
    std::size_t lamp(std::size_t part) {
        while (of_[part] != part) part = of_[part] = of_[of_[part]];
        return part;
    }

private:
    // Looks at the rows above, as far as parts of one lamp may lie, and at the part's own row.
    void join_with_earlier(std::size_t i) {
        const LampPart &part = parts_[i];
        const float reach = Tuning::beside_px;
        for (std::size_t j = i; j-- > 0 && part.at.y - parts_[j].at.y <= reach;)
            if (std::abs(part.at.x - parts_[j].at.x) <= reach &&
                within(double(part.depth), double(parts_[j].depth), double(Tuning::one_depth)))
                of_[lamp(i)] = lamp(j);
    }

    std::span<const LampPart> parts_;
    std::vector<std::size_t> of_;
};

std::vector<WholeLamp> lamps_of(std::span<const LampPart> parts) {
    Joining joined(parts);
    std::vector<std::size_t> number(parts.size(), none);
    std::vector<WholeLamp> lamps;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        std::size_t &n = number[joined.lamp(i)];
        if (n == none) n = lamps.size(), lamps.emplace_back();
        WholeLamp &lamp = lamps[n];
        double light = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            lamp.light[k] += double(parts[i].light[k]);
            light += double(parts[i].light[k]);
        }
        lamp.at += light * Imath::V2d(parts[i].at);
        lamp.depth += light * double(parts[i].depth);
        lamp.parts.push_back(i);
    }
    for (WholeLamp &lamp : lamps) {
        lamp.at /= lamp.sum();
        lamp.depth /= lamp.sum();
    }
    return lamps;
}

bool at_one_depth(const WholeLamp &a, const WholeLamp &b) {
    return within(a.depth, b.depth, double(Tuning::depth_change));
}

bool are_alike(const WholeLamp &a, const WholeLamp &b) {
    if (!within(a.sum(), b.sum(), double(Tuning::light_change)) || !at_one_depth(a, b)) return false;
    const auto dot = [](const auto &u, const auto &v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
    return dot(a.light, b.light) >=
           double(Tuning::same_colour) * std::sqrt(dot(a.light, a.light) * dot(b.light, b.light));
}

// The nearest of `others` that passes a test. The lamp itself does not count.
struct Nearest {
    std::size_t lamp = none;
    double distance = infinity;
};
template <typename Test>
Nearest nearest_to(const WholeLamp &lamp, std::span<const WholeLamp> others, const Test &test) {
    Nearest nearest;
    for (const WholeLamp &other : others) {
        const double distance = (other.at - lamp.at).length();
        if (&other != &lamp && distance < nearest.distance && test(other))
            nearest = {std::size_t(&other - others.data()), distance};
    }
    return nearest;
}

// For each lamp, the lamp among `others` that may be the same: the nearest one that is like it. None if another lamp of
// its own moment is nearly as near.
std::vector<std::size_t> same_among(std::span<const WholeLamp> lamps, std::span<const WholeLamp> others) {
    std::vector<std::size_t> same(lamps.size(), none);
    parallel_for(lamps.size(), [&](std::size_t i) {
        const WholeLamp &lamp = lamps[i];
        const Nearest nearest =
            nearest_to(lamp, others, [&](const WholeLamp &other) { return are_alike(lamp, other); });
        const Nearest beside = nearest_to(lamp, lamps, [&](const WholeLamp &other) {
            return other.sum() * double(Tuning::light_change) >= lamp.sum() && at_one_depth(lamp, other);
        });
        if (double(Tuning::apart) * nearest.distance <= beside.distance) same[i] = nearest.lamp;
    });
    return same;
}

// What is known of the lamps of one moment.
struct MomentLamps {
    std::vector<LampPart> parts;
    std::vector<WholeLamp> lamps;
    std::vector<std::size_t> before, after; // [lamp]: the same lamp in the moments before and after; or none
};

// Two lamps are the same if each is the nearest one of the other.
void connect(MomentLamps &first, MomentLamps &second) {
    const std::vector<std::size_t> to = same_among(first.lamps, second.lamps),
                                   from = same_among(second.lamps, first.lamps);
    for (std::size_t i = 0; i < to.size(); ++i)
        if (to[i] != none && from[to[i]] == i) first.after[i] = to[i], second.before[to[i]] = i;
}

// The motion with which a lamp is at these places, relative to its own, one and two moments later; the second may be
// unknown.
LampMotion one_sided(const Imath::V2d &one, const std::optional<Imath::V2d> &two) {
    if (!two) return {Imath::V2f(one), {0, 0}};
    return {Imath::V2f(2.0 * one - *two / 2.0), Imath::V2f(*two / 2.0 - one)};
}

LampMotion motion_of(std::span<const MomentLamps> moments, std::size_t m, std::size_t lamp) {
    // The place relative to that of the lamp, `steps` moments later or earlier.
    const auto place = [&](int direction, int steps) -> std::optional<Imath::V2d> {
        std::size_t at = m, i = lamp;
        for (int step = 0; step < steps; ++step) {
            i = direction > 0 ? moments[at].after[i] : moments[at].before[i];
            if (i == none) return {};
            at = direction > 0 ? at + 1 : at - 1;
        }
        return moments[at].lamps[i].at - moments[m].lamps[lamp].at;
    };
    const std::optional<Imath::V2d> before = place(-1, 1), after = place(1, 1);
    if (before && after) return {Imath::V2f((*after - *before) / 2.0), Imath::V2f((*after + *before) / 2.0)};
    if (after) return one_sided(*after, place(1, 2));
    if (!before) return {};
    LampMotion back = one_sided(*before, place(-1, 2));
    back.velocity = -back.velocity;
    return back;
}

void keep_brightest(std::vector<WholeLamp> &lamps) {
    std::ranges::stable_sort(lamps, [](const auto &a, const auto &b) { return a.sum() > b.sum(); });
    if (lamps.size() > Tuning::most_lamps) lamps.resize(Tuning::most_lamps);
}

MomentLamps lamps_in(std::vector<LampPart> parts) {
    const auto key = [](const LampPart &part) {
        return std::tuple(order_of(part.at, part.depth), part.light);
    };
    std::ranges::sort(parts, {}, key);
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    if (parts.size() > Tuning::most_parts) parts.clear();
    MomentLamps moment{std::move(parts), {}, {}, {}};
    moment.lamps = lamps_of(moment.parts);
    keep_brightest(moment.lamps);
    moment.before.assign(moment.lamps.size(), none);
    moment.after.assign(moment.lamps.size(), none);
    return moment;
}

} // namespace

const LampMotion *LampPaths::of(const Imath::V2f &at, float depth) const {
    const auto key = [](const Moving &part) { return order_of(part.at, part.depth); };
    const auto found = std::ranges::lower_bound(parts_, order_of(at, depth), {}, key);
    return found != parts_.end() && key(*found) == order_of(at, depth) ? &found->motion : nullptr;
}

void LampPaths::add(const LampPart &part, const LampMotion &motion) {
    parts_.push_back({part.at, part.depth, motion});
    for (const float t : {-0.5f, 0.5f}) farthest_ = std::max(farthest_, motion.at(t).length());
}

void LampPaths::sort() {
    std::ranges::stable_sort(parts_, {}, [](const Moving &part) { return order_of(part.at, part.depth); });
}

std::vector<LampPaths> find_lamp_paths(std::vector<std::vector<LampPart>> parts) {
    std::vector<MomentLamps> moments;
    for (std::vector<LampPart> &of_moment : parts) moments.push_back(lamps_in(std::move(of_moment)));
    for (std::size_t m = 0; m + 1 < moments.size(); ++m) connect(moments[m], moments[m + 1]);
    std::vector<LampPaths> paths(moments.size());
    for (std::size_t m = 0; m < moments.size(); ++m) {
        for (std::size_t i = 0; i < moments[m].lamps.size(); ++i) {
            const LampMotion motion = motion_of(moments, m, i);
            if (motion.velocity.length() < Tuning::least_px ||
                motion.bend.length() >= Tuning::most_bend * motion.velocity.length())
                continue;
            for (const std::size_t part : moments[m].lamps[i].parts)
                paths[m].add(moments[m].parts[part], motion);
        }
        paths[m].sort();
    }
    return paths;
}

} // namespace sparselens
