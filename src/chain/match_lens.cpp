#include "chain/match_lens.h"

#include "base/error.h"
#include "base/subpixels.h"
#include "chain/match_pictures.h"
#include "lens/f_number.h"
#include "lens/perceptive_depth.h"
#include "match/evidence.h"
#include "match/smooth_keys.h"
#include "match/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sparselens {

namespace {

constexpr double certain = 1.645; // standard deviations to each side that hold 90 %
constexpr double infinite = std::numeric_limits<double>::infinity();

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

struct Found {
    BlurGuess guess;
    bool is_ambiguous = false; // another lens fits as well
};

Found search(const Comparison &pictures, const KnownLens &known) {
    std::vector<LensFit> fits;
    for (const BlurGuess &guess : search_lens(pictures, known))
        fits.push_back(refine_lens(pictures, known, guess, MatchTuning::search_steps));
    const auto best = std::ranges::max_element(fits, {}, &LensFit::likelihood);
    Found found{best->guess};
    for (const LensFit &other : fits)
        found.is_ambiguous =
            found.is_ambiguous || (distance(pictures, best->guess, other.guess) > MatchTuning::apart_px &&
                                   lead(*best, other) < MatchTuning::least_lead);
    return found;
}

// The guess for pictures that are `ratio` times larger.
BlurGuess enlarged(BlurGuess guess, double ratio) {
    guess.coc *= ratio;
    guess.softness *= ratio * ratio;
    return guess;
}

BlurGuess guess_near(const MatchedLens &near, const Reduced &in) {
    const double scale = near.lens_radius.value / in.radius();
    const double focus = perceptive_depth(in.depth_scale(), near.focus_distance.value);
    return {scale * (focus - in.pictures.middle), scale, std::pow(near.softness / in.by(), 2)};
}

KnownLens known_lens_of(const Match &match, const Reduced &in) {
    KnownLens known;
    if (!match.request.match_fstop) known.scale = 1;
    if (match.request.match_focus) return known;
    if (!match.camera.focus_distance)
        throw UsageError("the focus distance is unknown: give `focus_distance`");
    known.focus = perceptive_depth(in.depth_scale(), *match.camera.focus_distance);
    return known;
}

// The values and their intervals. Deviations get the error of gathered pictures besides that of the blocks.
void set_values(MatchedLens &of, const Match &match, const Reduced &in, const LensFit &fit) {
    const auto &[coc, scale, softness] = fit.guess;
    const auto wider = [](double variance, double least) {
        return std::hypot(MatchTuning::joint_blocks * std::sqrt(std::max(variance, 0.0)), least);
    };
    const double focus = in.pictures.middle + coc / scale;
    // The variance of middle + coc / scale.
    const double by_coc = 1 / scale, by_scale = -coc / (scale * scale);
    const auto &c = fit.covariance;
    const double focus_variance =
        by_coc * by_coc * c[0][0] + 2 * by_coc * by_scale * c[0][1] + by_scale * by_scale * c[1][1];
    const auto coc_at = [middle = in.pictures.middle, coc = coc, scale = scale](double depth) {
        return std::abs(coc - scale * (depth - middle));
    };
    const double largest = std::max(coc_at(in.pictures.near), coc_at(in.pictures.far));
    of.largest_coc = in.by() * largest;
    of.coc_deviation = in.by() * wider(c[0][0], MatchTuning::gather_coc_px);
    of.focus_deviation = wider(focus_variance, MatchTuning::gather_coc_px / scale) / in.depth_scale();
    of.radius_deviation =
        wider(c[1][1] / (scale * scale),
              std::hypot(MatchTuning::gather_share, MatchTuning::gather_coc_px / std::max(largest, 1e-6)));
    if (!match.request.match_focus) of.focus_deviation = 0;
    if (!match.request.match_fstop) of.radius_deviation = 0;
    of.softness = std::sqrt(softness) * in.by();
    of.focus_distance.value = focus > 0 ? depth_of_perceptive(in.depth_scale(), focus) : infinite;
    of.lens_radius.value = in.radius() * scale;
}

void set_intervals(MatchedLens &of, const Camera &camera) {
    const double focus = 1 / of.focus_distance.value;
    const auto distance_at = [](double inverse) { return inverse > 0 ? 1 / inverse : infinite; };
    of.focus_distance.low = distance_at(focus + certain * of.focus_deviation);
    of.focus_distance.high = distance_at(focus - certain * of.focus_deviation);
    const double factor = std::exp(certain * of.radius_deviation);
    of.lens_radius.low = of.lens_radius.value / factor;
    of.lens_radius.high = of.lens_radius.value * factor;
    if (!camera.focal_length_mm) return;
    const auto fstop = [&](double radius) {
        return fstop_of(radius, *camera.focal_length_mm, camera.metres_per_unit.value_or(1));
    };
    of.fstop = {fstop(of.lens_radius.value), fstop(of.lens_radius.high), fstop(of.lens_radius.low)};
}

// Why these values are not those of the plate's lens.
std::string doubt_of(const MatchedLens &lens, const Reduced &in, const LensFit &fit, const Evidence &evidence,
                     bool is_ambiguous) {
    if (evidence.textured < MatchTuning::least_textured)
        return "the region of the plate shows nothing to compare; choose one with texture";
    if (lens.matched_share < MatchTuning::least_matched)
        return fmt::format(
            "the plate shows something else than the LDI: {:.0f} % of the blocks match; check the "
            "shot, the frame and the region",
            100 * lens.matched_share);
    const double motion = std::hypot(fit.motion[3], fit.motion[4]);
    if (motion > MatchTuning::motion_variance)
        return fmt::format(
            "the plate is blurred by motion over about {:.0f} pixels; choose a region or a frame "
            "that stands still",
            in.by() * std::sqrt(12 * motion));
    if (lens.largest_coc < MatchTuning::all_in_focus_px)
        return "nothing in the region is out of focus, so any narrow lens fits; choose a region that is "
               "blurred";
    if (is_ambiguous)
        return "the focus may lie in front of or behind what the region shows; choose a region with more "
               "depths";
    if (certain * lens.coc_deviation > MatchTuning::widest_coc_px && lens.focus_deviation > 0)
        return fmt::format(
            "the focus cannot be told: its blur is certain to {:.1f} pixels only; choose a larger "
            "region with more texture",
            certain * lens.coc_deviation);
    const double stops = 2 / std::numbers::ln2 * certain * lens.radius_deviation;
    if (stops > MatchTuning::widest_stops)
        return fmt::format(
            "the f-stop cannot be told: it is certain to {:.1f} stops only; choose a region with "
            "more depths, or give the f-stop and `fit=focus`",
            stops);
    if (lens.lens_radius.value > MatchTuning::widest * in.radius())
        return "the plate's lens is wider than that of the LDI; render the views with a wider lens";
    return {};
}

} // namespace

MatchedLens match_lens(const OpenedLdi &in, const Image &plate, const std::string &plate_name,
                       const MatchRequest &request, Progress &progress) {
    Match match{in,
                plate,
                plate_name,
                request,
                camera_with_options(request.lens, in.camera),
                {},
                in.camera.supersample.value_or(1)};
    const Imath::Box2i display = reduced(in.ldi.windows.display, match.across);
    if (plate.windows.display != display)
        throw Error(
            fmt::format("{}: its display window is {} x {}, that of {} is {} x {}: give a plate of the "
                        "same size",
                        plate_name, plate.windows.display_width(), plate.windows.display_height(), in.name,
                        Grid(display).width(), Grid(display).height()));
    if (!(resolve_radius(match.camera) > 0))
        throw UsageError("the lens of the LDI has no blur to compare: give `fstop`");
    match.region = common_pixels(request.region.value_or(display), display);
    progress.start("matching", 2);
    const int width = Grid(match.region).width();
    const Reduced fine(match, pieces_of(width, MatchTuning::final_width), true);
    const KnownLens known = known_lens_of(match, fine);
    BlurGuess guess;
    bool is_ambiguous = false;
    if (request.near) {
        guess = guess_near(*request.near, fine);
    } else {
        const Reduced small(match, pieces_of(width, MatchTuning::search_width), false);
        const Found found = search(small.pictures, known_lens_of(match, small));
        guess = enlarged(found.guess, double(small.by()) / fine.by());
        is_ambiguous = found.is_ambiguous;
    }
    progress.advance();
    const LensFit fit = refine_lens(fine.pictures, known, guess,
                                    request.near ? MatchTuning::next_frame_steps : MatchTuning::final_steps);
    MatchedLens result;
    set_values(result, match, fine, fit);
    set_intervals(result, match.camera);
    const Evidence evidence = find_evidence(fine.pictures.plate, fine.pictures.usable, fit.shown);
    result.matched_share = evidence.matched_share();
    result.doubt = doubt_of(result, fine, fit, evidence, is_ambiguous);
    result.fit = side_by_side(brightness(fit.shown), fine.pictures.plate);
    progress.advance();
    return result;
}

std::vector<MatchedLens> smooth_over_frames(std::span<const MatchedLens> frames) {
    std::vector<KeyedValue> focus, radius;
    for (const MatchedLens &lens : frames) {
        const bool is_known = lens.doubt.empty();
        const auto key = [&](double value, double deviation) {
            return KeyedValue{is_known ? value : 0, is_known ? std::max(deviation, 1e-12) : infinite};
        };
        focus.push_back(key(1 / lens.focus_distance.value, lens.focus_deviation));
        radius.push_back(key(std::log(lens.lens_radius.value), lens.radius_deviation));
    }
    focus = smooth_keys(focus);
    radius = smooth_keys(radius);
    std::vector<MatchedLens> result(frames.begin(), frames.end());
    for (std::size_t i = 0; i < result.size(); ++i) {
        MatchedLens &lens = result[i];
        const double stops_by = lens.fstop ? lens.fstop->value * lens.lens_radius.value : 0;
        lens.focus_distance.value = focus[i].value > 0 ? 1 / focus[i].value : infinite;
        lens.focus_deviation = focus[i].deviation;
        lens.lens_radius.value = std::exp(radius[i].value);
        lens.radius_deviation = radius[i].deviation;
        set_intervals(lens, {});
        if (lens.fstop)
            lens.fstop = {stops_by / lens.lens_radius.value, stops_by / lens.lens_radius.high,
                          stops_by / lens.lens_radius.low};
    }
    return result;
}

} // namespace sparselens
