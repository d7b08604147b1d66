#include "chain/match_lens.h"

#include "base/error.h"
#include "base/subpixels.h"
#include "chain/match_pictures.h"
#include "match/blocks.h"
#include "match/shape_search.h"
#include "match/smooth_keys.h"
#include "match/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

namespace sparselens {

namespace {

Image side_by_side(const Grey &left, const Grey &right) {
    const int width = left.grid.width(), height = left.grid.height();
    Image image(windows_of_size(2 * width, height),
                {{"R", PixelType::half}, {"G", PixelType::half}, {"B", PixelType::half}});
    for (std::size_t c = 0; c < 3; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
                image.at(c, x, y) = left.values[i];
                image.at(c, x + width, y) = right.values[i];
            }
    return image;
}

double distance(const Comparison &pictures, const BlurGuess &a, const BlurGuess &b) {
    return std::abs(a.coc - b.coc) + std::abs(a.scale - b.scale) * (pictures.near - pictures.far) / 2;
}

// The softness of a plate, as a standard deviation in pixels.
double deviation(const BlurGuess &guess) { return std::sqrt(std::max(guess.softness, 0.0)); }

// The fits that may be right, the best first, each on a hill of its own.
std::vector<LensFit> hills_of(const Comparison &pictures, std::vector<LensFit> fits) {
    std::ranges::stable_sort(fits, std::greater(), &LensFit::likelihood);
    std::vector<LensFit> hills;
    for (LensFit &fit : fits) {
        const auto is_near = [&](const LensFit &hill) {
            return distance(pictures, hill.guess, fit.guess) < MatchTuning::final_reach_px &&
                   std::abs(deviation(hill.guess) - deviation(fit.guess)) < MatchTuning::softness_apart;
        };
        if (std::ranges::any_of(hills, is_near)) continue;
        if (!hills.empty() && lead(hills.front(), fit) > MatchTuning::certain_lead) continue;
        hills.push_back(std::move(fit));
    }
    return hills;
}

// Shows how much of a match is done. Steps that are not needed are skipped.
class Percent {
public:
    explicit Percent(Progress &progress) : progress_(progress) { progress_.start("matching", 100); }
    std::size_t done() const { return done_; }
    void reach(std::size_t percent) {
        progress_.advance(percent - done_);
        done_ = percent;
    }

private:
    Progress &progress_;
    std::size_t done_ = 0;
};

// `until`: the percentage that is reached with the last guess.
std::vector<LensFit> refined(const Comparison &pictures, const KnownLens &known,
                             const std::vector<BlurGuess> &guesses, int lenses, double reach_px,
                             Percent &percent, std::size_t until) {
    std::vector<LensFit> fits;
    for (const BlurGuess &guess : guesses) {
        fits.push_back(refine_lens(pictures, known, guess, lenses, reach_px));
        percent.reach(percent.done() + (until - percent.done()) / (guesses.size() - fits.size() + 1));
    }
    return hills_of(pictures, std::move(fits));
}

std::vector<BlurGuess> guesses_of(const std::vector<LensFit> &fits) {
    std::vector<BlurGuess> guesses;
    for (const LensFit &fit : fits) guesses.push_back(fit.guess);
    return guesses;
}

// The guesses for pictures that are `ratio` times larger: each with the softness that it had, and with little, since
// small pictures hide how soft a plate is.
std::vector<BlurGuess> enlarged(const std::vector<BlurGuess> &guesses, double ratio) {
    std::vector<BlurGuess> result;
    for (BlurGuess guess : guesses) {
        guess.coc *= ratio;
        guess.softness *= ratio * ratio;
        result.push_back(guess);
        guess.softness = BlurGuess{}.softness;
        result.push_back(guess);
    }
    return result;
}

// The best fit of the final size, and whether another lens fits as well.
struct Found {
    LensFit fit;
    bool is_ambiguous = false;
};

// Looks where the lens is expected. A lens that moved farther is followed.
LensFit next_fit(const Comparison &pictures, const KnownLens &known, BlurGuess expected) {
    LensFit fit;
    for (int lenses = 0; lenses < MatchTuning::final_lenses; lenses += MatchTuning::next_frame_lenses) {
        fit = measured_lens(pictures, known, expected, MatchTuning::next_frame_lenses,
                            MatchTuning::next_reach_px);
        if (distance(pictures, fit.guess, expected) < MatchTuning::next_reach_px) break;
        expected = fit.guess;
    }
    return fit;
}

// Whether the plate is not all one colour.
bool shows_something(const Comparison &pictures) {
    float least = infinite, most = -infinite;
    for (std::size_t i = 0; i < pictures.usable.size(); ++i)
        if (pictures.usable[i]) {
            least = std::min(least, pictures.plate.values[i]);
            most = std::max(most, pictures.plate.values[i]);
        }
    return double(most - least) > MatchTuning::least_error;
}

Found best_fit(const Match &match, const Reduced &fine, Percent &percent) {
    const KnownLens known = known_lens(match, fine);
    if (!shows_something(fine.pictures)) { // it would fit any lens
        LensFit any;
        any.shown = fine.pictures.colours;
        return {any};
    }
    const double reach = MatchTuning::final_reach_px;
    if (const MatchedLens *near = match.request.near)
        return {next_fit(fine.pictures, known, guess_near(*near, fine))};
    const Reduced small(match, pieces_of(Grid(match.region).width(), MatchTuning::search_width), false);
    const KnownLens known_small = known_lens(match, small);
    std::vector<BlurGuess> guesses = search_lens(small.pictures, known_small);
    percent.reach(20);
    guesses = guesses_of(refined(small.pictures, known_small, guesses, MatchTuning::search_lenses,
                                 MatchTuning::search_reach_px, percent, 40));
    // A few lenses show which of them are worth more.
    guesses = guesses_of(refined(fine.pictures, known, enlarged(guesses, double(small.by()) / fine.by()),
                                 MatchTuning::first_lenses, reach, percent, 60));
    guesses.resize(std::min(guesses.size(), MatchTuning::final_guesses));
    std::vector<LensFit> fits =
        refined(fine.pictures, known, guesses, MatchTuning::final_lenses, reach, percent, 90);
    const bool is_ambiguous = std::ranges::any_of(fits, [&](const LensFit &other) {
        return distance(fine.pictures, fits.front().guess, other.guess) > MatchTuning::apart_px &&
               lead(fits.front(), other) < MatchTuning::least_lead;
    });
    // The search begins again at the best of them, because it can end too early where the likelihood is ragged.
    const LensFit best =
        measured_lens(fine.pictures, known, fits.front().guess, MatchTuning::final_lenses, reach);
    return {widened(fine.pictures, known, best), is_ambiguous};
}

} // namespace

MatchedLens match_lens(const OpenedLdi &in, const Image &plate, const std::string &plate_name,
                       const MatchRequest &request, Progress &progress) {
    const Match match(in, plate, plate_name, request);
    Percent percent(progress);
    const Reduced fine(match, pieces_of(Grid(match.region).width(), MatchTuning::final_width), true);
    percent.reach(5);
    const auto [fit, is_ambiguous] = best_fit(match, fine, percent);
    MatchedLens result;
    set_values(result, match, fine, fit);
    set_intervals(result, stops_by_radius(match.camera));
    const Evidence evidence = find_evidence(fine.pictures.plate, fine.pictures.usable, fit.shown);
    result.matched_share = evidence.matched_share();
    result.doubt = doubt_of(result, fine, fit, evidence, is_ambiguous);
    result.fit = side_by_side(brightness(fit.shown), fine.pictures.plate);
    percent.reach(100);
    return result;
}

std::optional<MatchedShape> match_shape(const OpenedLdi &in, const Image &plate,
                                        const std::string &plate_name, const MatchRequest &request,
                                        Progress &progress) {
    const MatchedLens round = match_lens(in, plate, plate_name, request, progress);
    if (round.largest_coc < MatchTuning::least_shape_px) return {};
    const Match match(in, plate, plate_name, request);
    const Reduced pictures(match, std::max(int(round.largest_coc / MatchTuning::shape_px), 1), true);
    const ShapedGather gather = [&](const ApertureShape &shape, double coc, double scale, bool exactly) {
        return pictures.gather(shape, coc, scale, exactly);
    };
    const ShapeFit found =
        find_shape(pictures.pictures, gather, known_lens(match, pictures), guess_near(round, pictures));
    if (!found.is_told) return {};
    return MatchedShape{found.shape.blades, found.shape.rotation, found.shape.squeeze};
}

MatchRequest with_shape(MatchRequest request, const MatchedShape &shape) {
    LookValues &values = request.looks.values;
    values.blades = shape.blades;
    values.rotation = shape.rotation;
    values.squeeze = shape.squeeze;
    return request;
}

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
