#include "chain/match_values.h"

#include "lens/f_number.h"
#include "lens/perceptive_depth.h"
#include "match/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {

void set_values(MatchedLens &of, const Match &match, const Reduced &in, const LensFit &fit) {
    const auto &[coc, scale, softness] = fit.guess;
    const auto own = [](double variance) { return std::sqrt(std::max(variance, 0.0)); };
    const auto error = match.request.near ? MatchTuning::next_frame_error : MatchTuning::first_frame_error;
    const double focus = in.pictures.middle + coc / scale;
    // The variance of middle + coc / scale.
    const double by_coc = 1 / scale, by_scale = -coc / (scale * scale);
    const auto &c = fit.covariance;
    const double focus_variance =
        by_coc * by_coc * c.coc + 2 * by_coc * by_scale * c.both + by_scale * by_scale * c.scale;
    const auto coc_at = [middle = in.pictures.middle, coc = coc, scale = scale](double depth) {
        return std::abs(coc - scale * (depth - middle));
    };
    const double largest = std::max(coc_at(in.pictures.near), coc_at(in.pictures.far));
    of.largest_coc = in.by() * largest;
    of.coc_deviation = in.by() * std::hypot(own(c.coc), error.coc_px);
    of.focus_deviation = {own(focus_variance) / in.depth_scale(), error.coc_px / scale / in.depth_scale()};
    of.radius_deviation = {own(c.scale / (scale * scale)),
                           std::hypot(error.share, error.coc_px / std::max(largest, 1e-6))};
    if (match.request.fit == MatchFit::fstop) of.focus_deviation = {};
    if (match.request.fit == MatchFit::focus) of.radius_deviation = {};
    of.softness = std::sqrt(std::max(softness, 0.0)) * in.by();
    of.focus_distance.value = focus > 0 ? depth_of_perceptive(in.depth_scale(), focus) : infinite;
    of.lens_radius.value = in.radius() * scale;
}

std::optional<double> stops_by_radius(const Camera &camera) {
    if (!camera.focal_length_mm) return {};
    return fstop_of(1, *camera.focal_length_mm, camera.metres_per_unit.value_or(1));
}

double distance_at(double inverse) { return inverse > 0 ? 1 / inverse : infinite; }

void set_intervals(MatchedLens &of, std::optional<double> stops_by_radius) {
    const double focus = 1 / of.focus_distance.value;
    of.focus_distance.low = distance_at(focus + certain * of.focus_deviation.both());
    of.focus_distance.high = distance_at(focus - certain * of.focus_deviation.both());
    const double factor = std::exp(certain * of.radius_deviation.both());
    of.lens_radius.low = of.lens_radius.value / factor;
    of.lens_radius.high = of.lens_radius.value * factor;
    if (!stops_by_radius) return;
    const auto fstop = [&](double radius) { return *stops_by_radius / radius; };
    of.fstop = {fstop(of.lens_radius.value), fstop(of.lens_radius.high), fstop(of.lens_radius.low)};
}

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
    if (certain * lens.coc_deviation > MatchTuning::widest_coc_px && lens.focus_deviation.both() > 0)
        return fmt::format(
            "the focus cannot be told: its blur is certain to {:.1f} pixels only; choose a larger "
            "region with more texture",
            certain * lens.coc_deviation);
    const double stops = 2 / std::numbers::ln2 * certain * lens.radius_deviation.both();
    if (stops > MatchTuning::widest_stops)
        return fmt::format(
            "the f-stop cannot be told: it is certain to {:.1f} stops only; choose a region with "
            "more depths, or give the f-stop and `fit=focus`",
            stops);
    if (lens.lens_radius.value > MatchTuning::widest * in.radius())
        return "the plate's lens is wider than that of the LDI; render the views with a wider lens";
    return {};
}

} // namespace sparselens
