#include "deep/sanitize.h"

#include "base/error.h"
#include "base/light.h"
#include "base/parallel.h"
#include "deep/channel_alpha.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float smallest_depth = std::numeric_limits<float>::min(); // 1 / z is still a float

// The samples of an LDI or of a view, which has one in each pixel.
struct Samples {
    const Windows &windows;
    std::span<const Channel> channels;
    std::vector<std::span<float>> values; // [channel]
    std::span<float> z;
    std::span<const std::uint64_t> begin; // empty: one sample a pixel

    std::uint64_t first(std::size_t pixel) const { return begin.empty() ? pixel : begin[pixel]; }
};

// Nearly always all values are good. Without a branch for each value, several are compared at once.
template <typename Good>
bool all_of(std::span<const float> values, const Good &good) {
    std::atomic<bool> all = true;
    parallel_ranges(values.size(), 65536, [&](std::size_t from, std::size_t to) {
        int bad = 0;
        for (const float value : values.subspan(from, to - from)) bad |= int(!good(value));
        if (bad != 0) all = false;
    });
    return all;
}

constexpr auto is_radiance = [](float v) { return std::abs(v) <= 1e34f; };
constexpr auto is_coverage = [](float v) { return v >= 0 && v <= 1; };
constexpr auto is_depth = [](float z) { return z >= smallest_depth; };

class Repair {
public:
    Repair(const Samples &samples, const std::string &name)
        : s_(samples), name_(name), alpha_(find_channel(samples.channels, "A")) {}

    InvalidValues run() {
        for (std::size_t k = 0; k < s_.values.size(); ++k)
            if (covers(k) && !all_of(s_.values[k], is_coverage)) repair_coverage(k);
        if (!all_of(s_.z, is_depth)) repair_depths();
        hide_uncovered();
        for (std::size_t k = 0; k < s_.values.size(); ++k)
            if (!covers(k) && !holds_ids(s_.channels[k]) && !all_of(s_.values[k], is_radiance))
                repair_colours(k);
        return found_;
    }

private:
    bool covers(std::size_t channel) const {
        return !holds_ids(s_.channels[channel]) && coverage_of(s_.channels, channel) == channel;
    }
    float alpha(std::uint64_t i) const { return alpha_ == npos ? 1 : s_.values[alpha_][i]; }

    // Calls visit(pixel, sample) for all samples.
    template <typename Visit>
    void for_each_sample(const Visit &visit) const {
        for (std::size_t pixel = 0; pixel < s_.windows.pixels(); ++pixel)
            for (std::uint64_t i = s_.first(pixel); i < s_.first(pixel + 1); ++i) visit(pixel, i);
    }

    // Calls visit(sample) once for each neighbour of the pixel, with the neighbour's sample nearest in depth to sample
    // i; if the depth of i is bad, with its front sample.
    template <typename Visit>
    void for_each_neighbour(std::size_t pixel, std::uint64_t i, const Visit &visit) const {
        const Imath::V2i at = s_.windows.pixel(pixel);
        const Imath::Box2i &data = s_.windows.data;
        for (int y = std::max(at.y - 1, data.min.y); y <= std::min(at.y + 1, data.max.y); ++y)
            for (int x = std::max(at.x - 1, data.min.x); x <= std::min(at.x + 1, data.max.x); ++x) {
                const std::size_t other = s_.windows.index(Imath::V2i(x, y));
                if (other == pixel || s_.first(other) == s_.first(other + 1)) continue;
                visit(nearest(other, s_.z[i]));
            }
    }
    std::uint64_t nearest(std::size_t pixel, float z) const {
        std::uint64_t best = s_.first(pixel);
        const auto distance = [&](std::uint64_t i) { return std::abs(1 / double(s_.z[i]) - 1 / double(z)); };
        for (std::uint64_t i = best + 1; i < s_.first(pixel + 1) && is_depth(z); ++i)
            if (distance(i) < distance(best)) best = i;
        return best;
    }

    void repair_coverage(std::size_t channel);
    void repair_depths();
    void repair_colours(std::size_t channel);
    // A sample without coverage and light is moved to infinity. Light without coverage, such as fire, keeps its depth.
    void hide_uncovered() {
        if (alpha_ == npos) return;
        const auto shines = [&](std::size_t i) {
            for (std::size_t k = 0; k < s_.values.size(); ++k)
                if (is_light(s_.channels[k]) && !covers(k) && s_.values[k][i] != 0) return true;
            return false;
        };
        parallel_ranges(s_.z.size(), 65536, [&](std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i)
                if (s_.values[alpha_][i] == 0 && !(is_depth(s_.z[i]) && shines(i))) s_.z[i] = infinity;
        });
    }

    // Applied at the end, so that all changes follow from the original values.
    using Changes = std::vector<std::pair<std::uint64_t, float>>;
    static void apply(const Changes &changes, std::span<float> values) {
        for (const auto &[i, value] : changes) values[i] = value;
    }

    const Samples &s_;
    const std::string &name_;
    std::size_t alpha_;
    InvalidValues found_;
};

void Repair::repair_coverage(std::size_t channel) {
    const std::span<float> values = s_.values[channel];
    Changes changes;
    for_each_sample([&](std::size_t pixel, std::uint64_t i) {
        const float a = values[i];
        if (is_coverage(a)) return;
        double sum = 0;
        int count = 0;
        for_each_neighbour(pixel, i, [&](std::uint64_t n) {
            if (!std::isfinite(values[n])) return;
            sum += std::clamp(values[n], 0.0f, 1.0f);
            ++count;
        });
        const float around = count > 0 ? float(sum / count) : 1;
        changes.emplace_back(i, std::isnan(a) ? around : std::clamp(a, 0.0f, 1.0f));
        if (!(a >= -coverage_rounding && a <= 1 + coverage_rounding)) ++found_.alphas;
    });
    apply(changes, values);
}

void Repair::repair_depths() {
    Changes changes;
    std::size_t covered = 0, bad = 0, first_bad = 0;
    float first_depth = 0;
    for_each_sample([&](std::size_t pixel, std::uint64_t i) {
        const float z = s_.z[i];
        if (alpha(i) != 0) ++covered;
        if (is_depth(z) || alpha(i) == 0) return;
        if (z >= 0) return changes.emplace_back(i, infinity), void(); // nothing was hit
        if (bad++ == 0) first_bad = pixel, first_depth = z;
        std::vector<float> around;
        for_each_neighbour(pixel, i, [&](std::uint64_t n) {
            if (is_depth(s_.z[n])) around.push_back(s_.z[n]);
        });
        std::ranges::sort(around);
        changes.emplace_back(i, around.empty() ? infinity : around[(around.size() - 1) / 2]);
    });
    if (bad > 0 && 2 * bad >= covered) {
        const Imath::V2i p = s_.windows.pixel(first_bad);
        if (std::isnan(first_depth))
            throw Error(
                fmt::format("{}: depth nan in pixel {},{} is not a number above 0, as half of all depths or "
                            "more: render depth again, or give another channel (`depth_channel`)",
                            name_, p.x, p.y));
        throw Error(
            fmt::format("{}: depth {:g} in pixel {},{} is not a number above 0: `depth` says what the "
                        "channel holds (negative: "
                        "the z of a camera that looks along -z), `depth_channel` which channel is read",
                        name_, first_depth, p.x, p.y));
    }
    apply(changes, s_.z);
    found_.depths = bad;
}

void Repair::repair_colours(std::size_t channel) {
    const std::span<float> values = s_.values[channel];
    Changes changes;
    for_each_sample([&](std::size_t pixel, std::uint64_t i) {
        if (is_radiance(values[i])) return;
        double light = 0, coverage = 0;
        for_each_neighbour(pixel, i, [&](std::uint64_t n) {
            if (!is_radiance(values[n])) return;
            light += values[n];
            coverage += alpha(n);
        });
        changes.emplace_back(i, coverage > 0 ? float(alpha(i) * light / coverage) : 0);
        ++found_.colours;
    });
    apply(changes, values);
}

// Replaces the values that are not `good` by what `nearest` returns. Returns their number.
template <typename Good>
std::size_t replace(std::vector<float> &values, const Good &good, float (*nearest)(float)) {
    if (all_of(values, good)) return 0;
    std::size_t bad = 0;
    for (float &v : values)
        if (!good(v)) v = nearest(v), ++bad;
    return bad;
}

std::size_t repair_places(Ldi &ldi) {
    const auto inside = [](float d) { return std::abs(d) <= 0.5f; };
    const auto clamped = [](float d) { return std::isnan(d) ? 0 : std::clamp(d, -0.5f, 0.5f); };
    const auto is_weight = [](float w) { return w > 0 && std::isfinite(w); };
    const auto is_thickness = [](float s) { return s >= 0 && std::isfinite(s); };
    std::size_t bad = replace(ldi.dx, inside, clamped) + replace(ldi.dy, inside, clamped) +
                      replace(ldi.weight, is_weight, [](float) { return 1.0f; }) +
                      replace(ldi.solid, is_thickness, [](float) { return 0.0f; });
    for (std::size_t i = 0; i < ldi.image_z.size(); ++i)
        if (!(std::abs(ldi.image_z[i]) >= smallest_depth)) ldi.image_z[i] = ldi.z[i], ++bad;
    for (std::size_t i = 0; i < ldi.z_back.size(); ++i) {
        if (std::isnan(ldi.z_back[i])) ++bad;
        if (!(ldi.z_back[i] >= ldi.z[i])) ldi.z_back[i] = ldi.z[i];
    }
    return bad;
}

} // namespace

std::string InvalidValues::text() const {
    std::vector<std::string> list;
    const auto add = [&](std::size_t count, const char *one, const char *many) {
        if (count > 0) list.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
    };
    add(colours, "colour that is not finite", "colours that are not finite");
    add(alphas, "alpha outside 0..1", "alphas outside 0..1");
    add(depths, "depth that is not above 0", "depths that are not above 0");
    add(places, "invalid position or weight", "invalid positions or weights");
    return fmt::format("{}: replaced from neighbouring pixels{}", fmt::join(list, ", "),
                       alphas > 0 ? ", alpha clamped" : "");
}

InvalidValues sanitize(Ldi &ldi, const std::string &name) {
    const Samples samples{ldi.windows, ldi.channels, planes_of(ldi), ldi.z, ldi.begin};
    InvalidValues found = Repair(samples, name).run();
    found.places = repair_places(ldi);
    return found;
}

InvalidValues sanitize(View &view) {
    const Samples samples{view.image.windows, view.image.channels, planes_of(view.image), view.z, {}};
    return Repair(samples, view.name).run();
}

namespace {

std::size_t coverage_for(std::span<const Channel> channels, std::size_t k) {
    const std::string &name = channels[k].name;
    const std::size_t own = find_channel(channels, name.substr(0, name.rfind('.') + 1) + "A");
    return own != npos ? own : coverage_of(channels, k);
}

void premultiply_planes(std::span<const Channel> channels, std::span<const std::span<float>> planes) {
    for (std::size_t k = 0; k < channels.size(); ++k) {
        if (!is_light(channels[k]) || colour_part(channels[k]) == ColourPart::coverage) continue;
        const std::size_t by = coverage_for(channels, k);
        if (by == npos || by == k || coverage_of(channels, k) == k) continue;
        parallel_ranges(planes[k].size(), 65536, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) planes[k][i] *= planes[by][i];
        });
    }
}

} // namespace

void premultiply(Image &image) { premultiply_planes(image.channels, planes_of(image)); }

void premultiply(Ldi &ldi) { premultiply_planes(ldi.channels, planes_of(ldi)); }

} // namespace sparselens
