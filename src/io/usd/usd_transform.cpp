#include "io/usd/usd_transform.h"

#include "base/error.h"

#include <Imath/ImathQuat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

using Numbers = std::vector<double>;
constexpr std::size_t most_operations = 16; // as many as the parser keeps

// The samples before and after a time, and how far between them it is.
struct Between {
    const Numbers &before, &after;
    double share;
};

Between around(const std::map<double, UsdValue> &samples, double time) {
    const auto after = samples.lower_bound(time);
    if (after == samples.end())
        return {samples.rbegin()->second.numbers, samples.rbegin()->second.numbers, 0};
    if (after == samples.begin() || after->first == time)
        return {after->second.numbers, after->second.numbers, 0};
    const auto before = std::prev(after);
    return {before->second.numbers, after->second.numbers,
            (time - before->first) / (after->first - before->first)};
}

Imath::Quatd quaternion(const Numbers &v) { return Imath::Quatd(v[0], v[1], v[2], v[3]); } // real part first

Numbers mixed_rotations(const Between &two) {
    const Imath::Quatd q = Imath::slerpShortestArc(quaternion(two.before).normalized(),
                                                   quaternion(two.after).normalized(), two.share);
    return {q.r, q.v.x, q.v.y, q.v.z};
}

Imath::M44d rotation(char axis, double degrees) {
    Imath::M44d m;
    const Imath::V3d around_axis(axis == 'X', axis == 'Y', axis == 'Z');
    return m.setAxisAngle(around_axis, degrees * std::numbers::pi / 180);
}

Imath::M44d transform_of(const Numbers &v) {
    Imath::M44d m;
    for (std::size_t i = 0; i < 16; ++i) m[int(i / 4)][int(i % 4)] = v[i];
    return m;
}

Imath::V3d vector(const Numbers &v) { return {v[0], v[1], v[2]}; }

Imath::V3d along(char axis, double value, double otherwise) {
    return {axis == 'X' ? value : otherwise, axis == 'Y' ? value : otherwise,
            axis == 'Z' ? value : otherwise};
}

// xformOp:KIND or xformOp:KIND:SUFFIX
std::string_view kind_of(std::string_view name) {
    const std::string_view prefix = "xformOp:";
    if (!name.starts_with(prefix)) return {};
    name.remove_prefix(prefix.size());
    return name.substr(0, name.find(':'));
}

bool is_axis(char c) { return c == 'X' || c == 'Y' || c == 'Z'; }

// rotateXYZ and the like: each axis once.
bool is_euler(std::string_view kind) {
    std::string axes(kind.substr(std::min<std::size_t>(kind.size(), 6)));
    std::ranges::sort(axes);
    return kind.starts_with("rotate") && axes == "XYZ";
}

// Not set: the identity.
std::optional<Imath::M44d> operation(const UsdPlace &place, std::string_view name) {
    const std::string_view kind = kind_of(name);
    const char axis = kind.empty() ? ' ' : kind.back();
    const std::string_view base = is_axis(axis) ? kind.substr(0, kind.size() - 1) : "";
    const auto with = [&](std::size_t count, const auto &use) -> std::optional<Imath::M44d> {
        const Numbers v = numbers_at(place, name, count);
        if (v.empty()) return {};
        return use(v);
    };
    const auto moved = [](const Imath::V3d &by) { return Imath::M44d().setTranslation(by); };
    const auto scaled = [](const Imath::V3d &by) { return Imath::M44d().setScale(by); };
    if (kind == "translate") return with(3, [&](const Numbers &v) { return moved(vector(v)); });
    if (kind == "scale") return with(3, [&](const Numbers &v) { return scaled(vector(v)); });
    if (kind == "transform") return with(16, transform_of);
    if (kind == "orient")
        return with(4, [](const Numbers &v) { return quaternion(v).normalized().toMatrix44(); });
    if (base == "translate") return with(1, [&](const Numbers &v) { return moved(along(axis, v[0], 0)); });
    if (base == "scale") return with(1, [&](const Numbers &v) { return scaled(along(axis, v[0], 1)); });
    if (base == "rotate") return with(1, [&](const Numbers &v) { return rotation(axis, v[0]); });
    if (is_euler(kind))
        return with(3, [&](const Numbers &v) {
            Imath::M44d m;
            for (const char each : kind.substr(6)) m *= rotation(each, v[std::size_t(each - 'X')]);
            return m;
        });
    refuse(place, fmt::format("its transformation {} is not understood", name));
}

struct Local {
    Imath::M44d matrix;
    bool resets = false; // the parents do not count
};

// The last operation of the order applies first.
Local local_matrix(const UsdPlace &place) {
    Local local;
    const UsdAttribute *order = find_attribute(*place.path.back(), "xformOpOrder");
    if (!order) return local;
    if (!order->value || !order->samples.empty()) refuse(place, "its xformOpOrder is not a list");
    if (order->value->texts.size() > most_operations)
        refuse(place, fmt::format("its xformOpOrder has more than {} operations", most_operations));
    for (const std::string &word : order->value->texts) {
        constexpr std::string_view inverted = "!invert!";
        const bool invert = word.starts_with(inverted);
        const std::string_view name = std::string_view(word).substr(invert ? inverted.size() : 0);
        if (name == "!resetXformStack!") {
            local = Local{.matrix = {}, .resets = true};
            continue;
        }
        if (!find_attribute(*place.path.back(), name))
            refuse(place, fmt::format("its xformOpOrder names {}, which is missing", name));
        const Imath::M44d matrix = operation(place, name).value_or(Imath::M44d());
        if (invert && std::abs(matrix.determinant()) < 1e-300)
            refuse(place, fmt::format("{} has no inverse", name));
        local.matrix = (invert ? matrix.inverse() : matrix) * local.matrix;
    }
    return local;
}

void refuse_composed(const UsdPlace &place) {
    const std::string &composed = place.path.back()->composed;
    if (!composed.empty())
        refuse(place,
               fmt::format("its {} are not read; write all into one file: usdcat --flatten IN -o OUT.usda",
                           composed));
}

} // namespace

void refuse(const UsdPlace &place, const std::string &why) {
    throw Error(fmt::format("{}: {}: {}", place.layer.file, text_of(place.path), why));
}

Numbers numbers_at(const UsdPlace &place, std::string_view name, std::size_t count) {
    const UsdAttribute *attribute = find_attribute(*place.path.back(), name);
    if (!attribute) return {};
    if (!attribute->source.empty())
        refuse(place, fmt::format("{} comes from a {}, which is not read: give it time samples", name,
                                  attribute->source == "connect" ? "connection" : "spline"));
    const auto require = [&](const Numbers &v) {
        if (v.size() != count || !std::ranges::all_of(v, [](double x) { return !std::isnan(x); }))
            refuse(place, fmt::format("{} must be {} number{}", name, count, count == 1 ? "" : "s"));
    };
    if (attribute->samples.empty()) {
        if (!attribute->value) return {};
        require(attribute->value->numbers);
        return attribute->value->numbers;
    }
    const Between two = around(attribute->samples, place.time);
    require(two.before);
    require(two.after);
    if (two.share == 0) return two.before;
    if (kind_of(name) == "orient") return mixed_rotations(two);
    Numbers mixed;
    for (std::size_t i = 0; i < count; ++i)
        mixed.push_back(std::lerp(two.before[i], two.after[i], two.share));
    return mixed;
}

std::optional<double> number_at(const UsdPlace &place, std::string_view name) {
    const Numbers v = numbers_at(place, name, 1);
    return v.empty() ? std::nullopt : std::optional(v[0]);
}

Imath::M44d local_to_world(const UsdPlace &place) {
    Imath::M44d world;
    UsdPlace at{place.layer, {}, place.time};
    for (const UsdPrim *prim : place.path) {
        at.path.push_back(prim);
        refuse_composed(at);
        const Local local = local_matrix(at);
        world = local.resets ? local.matrix : local.matrix * world;
    }
    return world;
}

std::set<double> sample_times(const UsdPath &path) {
    std::set<double> times;
    for (const UsdPrim *prim : path)
        for (const auto &[name, attribute] : prim->attributes)
            for (const auto &[time, value] : attribute.samples) times.insert(time);
    return times;
}

} // namespace sparselens
