#include "chain/match_frames.h"

#include "base/error.h"
#include "chain/match_values.h"
#include "match/smooth_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace sparselens {

namespace {

// The lenses of neighbouring frames, smooth over time. A frame with a doubt gets the values of its neighbours. At least
// one must have none.
std::vector<MatchedLens> smooth_over_frames(std::span<const MatchedLens> frames) {
    std::vector<KeyedValue> focus, radius;
    for (const MatchedLens &lens : frames) {
        const bool is_known = lens.doubt.empty();
        const auto key = [&](double value, const MatchedDeviation &deviation) {
            return KeyedValue{is_known ? value : 0, is_known ? std::max(deviation.own, 1e-12) : infinite};
        };
        focus.push_back(key(1 / lens.focus_distance.value, lens.focus_deviation));
        radius.push_back(key(std::log(lens.lens_radius.value), lens.radius_deviation));
    }
    focus = smooth_keys(focus);
    radius = smooth_keys(radius);
    std::vector<MatchedLens> result(frames.begin(), frames.end());
    for (std::size_t i = 0; i < result.size(); ++i) {
        MatchedLens &lens = result[i];
        std::optional<double> by;
        if (lens.fstop) by = lens.fstop->value * lens.lens_radius.value;
        lens.focus_distance.value = distance_at(focus[i].value);
        lens.focus_deviation.own = focus[i].deviation;
        lens.lens_radius.value = std::exp(radius[i].value);
        lens.radius_deviation.own = radius[i].deviation;
        set_intervals(lens, by);
    }
    return result;
}

// Where to look first for the next lens: the focus goes on as it did. Nothing if the last plate was not matched.
std::optional<MatchedLens> expected_lens(std::span<const MatchedLens> lenses) {
    const auto is_known = [&](std::size_t back) {
        return lenses.size() >= back && lenses[lenses.size() - back].doubt.empty();
    };
    if (!is_known(1)) return {};
    MatchedLens expected = lenses.back();
    if (!is_known(2)) return expected;
    const double last = 1 / expected.focus_distance.value,
                 before = 1 / lenses[lenses.size() - 2].focus_distance.value;
    expected.focus_distance.value = distance_at(2 * last - before);
    return expected;
}

} // namespace

Image FrameMatcher::match(const OpenedLdi &in, const Image &plate, const std::string &plate_name,
                          Progress &progress) {
    MatchRequest request = request_;
    const std::optional<MatchedLens> expected = expected_lens(lenses_);
    if (expected) request.near = &*expected;
    MatchedLens found = match_lens(in, plate, plate_name, request, progress);
    if (request.near && !found.doubt.empty()) { // look everywhere
        request.near = nullptr;
        found = match_lens(in, plate, plate_name, request, progress);
    }
    Image fit = std::exchange(found.fit, {});
    names_.push_back(plate_name);
    lenses_.push_back(std::move(found));
    return fit;
}

MatchedFrames FrameMatcher::smooth() const {
    MatchedFrames result{lenses_, {}};
    for (std::size_t i = 0; i < lenses_.size(); ++i) {
        if (lenses_[i].doubt.empty()) continue;
        result.warnings.push_back(
            fmt::format("{}: {}; its values are those of its neighbours", names_[i], lenses_[i].doubt));
        if (2 * result.warnings.size() > lenses_.size())
            throw Error(fmt::format("{}: {}", names_[i], lenses_[i].doubt));
    }
    if (lenses_.size() > 1) result.lenses = smooth_over_frames(lenses_);
    return result;
}

} // namespace sparselens
