#include "chain/match_pictures.h"

#include "base/error.h"
#include "base/subpixels.h"
#include "chain/channels.h"
#include "deep/flatten.h"
#include "deep/proxy.h"
#include "lens/thin_lens.h"
#include "match/measure_lens.h"
#include "match/tone_curve.h"
#include "match/tuning.h"
#include "view/resolve_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

constexpr float opaque = 0.99f;

// The colours of `box`, scene-linear.
Rgb colours_in(const Image &image, const Imath::Box2i &box, const std::string &name) {
    const auto rgb = find_rgb(image.channels);
    if (!all_found(rgb)) throw Error(name + ": it lacks R, G or B");
    Rgb result{Grid(box), {}};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < result.grid.size(); ++i) {
            const Imath::V2i at = result.grid.pixel(i);
            result.rgb[k].push_back(image.at(rgb[k], at.x, at.y));
        }
    return result;
}

} // namespace

Match::Match(const OpenedLdi &in_, const Image &plate_, const std::string &plate_name_,
             const MatchRequest &request_)
    : in(in_), plate(plate_), plate_name(plate_name_), request(request_),
      camera(camera_with_options(request.lens, in.camera)), across(in.camera.supersample.value_or(1)) {
    const Imath::Box2i display = reduced(in.ldi.windows.display, across);
    if (plate.windows.display != display)
        throw Error(
            fmt::format("{}: its display window is {}, that of {} is {}: give a plate of the same size",
                        plate_name, size_text(plate.windows.display), in.name, size_text(display)));
    if (!(resolve_radius(camera) > 0))
        throw UsageError("the lens of the LDI has no blur to compare: give `fstop`");
    region = common_pixels(request.region.value_or(display), display);
    for (const std::size_t c : find_rgb(plate.channels))
        if (c != npos) raise_clipped(plate.plane(c));
}

KnownLens known_lens(const Match &match, const Reduced &in) {
    KnownLens known;
    if (match.request.fit == MatchFit::focus) known.scale = 1;
    if (match.request.fit != MatchFit::fstop) return known;
    if (!match.camera.focus_distance)
        throw UsageError("the focus distance is unknown: give `focus_distance`");
    known.focus = disparity(in.depth_scale(), *match.camera.focus_distance);
    return known;
}

BlurGuess guess_near(const MatchedLens &near, const Reduced &in) {
    const double scale = near.lens_radius.value / in.radius();
    const double focus = disparity(in.depth_scale(), near.focus_distance.value);
    return {scale * (focus - in.pictures.middle), scale, std::pow(near.softness / in.by(), 2)};
}

Reduced::Reduced(const Match &match, int by, bool is_final) : name_(match.in.name), by_(by) {
    const int factor = by * match.across;
    if (factor > 1)
        ldi_ = proxy(match.in.ldi, factor,
                     {.scale = *disparity_scale(match.camera, match.in.ldi.windows, true),
                      .tolerance = layer_tolerance_px * factor});
    else
        ldi_ = match.in.ldi;
    keep_channels(ldi_, "rgba");
    radius_ = resolve_radius(match.camera);
    focal_px_ = resolve_focal_px(match.camera, ldi_.windows);
    const Imath::Box2i plate_data = reduced(match.plate.windows.data, by);
    box_ = common_pixels(common_pixels(reduced(match.region, by), ldi_.windows.data), plate_data);
    choose_gathers(match, is_final);
    const Image small = by == 1 ? match.plate : mean_of_subpixels(match.plate, {by, {}}, plate_data);
    pictures.colours = tone_mapped(colours_in(small, box_, match.plate_name));
    pictures.plate = brightness(pictures.colours);
    find_usable();
    find_depths();
    pictures.gather = [this](double coc, double scale, bool exactly) {
        return gather(shape(), coc, scale, exactly);
    };
}

double Reduced::depth_scale() const { return disparity_scale(radius_, focal_px_); }

void Reduced::choose_gathers(const Match &match, bool is_final) {
    const GivenLooks &looks = match.request.looks;
    quickly_.gather.lens.looks =
        resolve_looks(look_values_over(read_looks(looks, match.camera.fstop).values, match.camera.looks),
                      match.camera, lens(1, 1), ldi_.windows);
    quickly_.gather.views_radius = views_radius(match.camera);
    exactly_ = quickly_;
    quickly_.gather.lens.lens_samples = MatchTuning::search_points;
    if (is_final)
        exactly_.gather.lens.quality = match.request.near ? Quality::normal : Quality::final;
    else
        exactly_.gather.lens.lens_samples = MatchTuning::refine_points;
}

ThinLens Reduced::lens(double focus, double scale) const {
    return {.radius = radius_ * scale,
            .focal_px = focal_px_,
            .focus = focus > 0 ? depth_at_disparity(depth_scale(), focus)
                               : std::numeric_limits<double>::infinity(),
            .pixel_aspect = ldi_.windows.pixel_aspect};
}

// Pixels that the LDI covers and the plate has.
void Reduced::find_usable() {
    const Image flat = flatten(ldi_);
    const std::size_t alpha = find_channel(flat.channels, "A");
    for (std::size_t i = 0; i < pictures.plate.values.size(); ++i) {
        const Imath::V2i at = pictures.plate.grid.pixel(i);
        const bool covered = alpha == npos || flat.at(alpha, at.x, at.y) >= opaque;
        pictures.usable.push_back(covered && std::isfinite(pictures.plate.values[i]) ? 1 : 0);
    }
}

void Reduced::find_depths() {
    for (std::size_t i = 0; i < pictures.usable.size(); ++i)
        if (const float z = front_depth(ldi_, pictures.plate.grid.pixel(i)); pictures.usable[i] && z > 0)
            depths_.push_back(disparity(depth_scale(), double(z)));
    if (depths_.empty()) throw UsageError("`region` contains no pixel that the LDI covers; give another");
    std::ranges::sort(depths_);
    const auto at = [&](double share) { return depths_[std::size_t(share * double(depths_.size() - 1))]; };
    pictures.far = at(0.02);
    pictures.near = at(0.98);
    pictures.middle = (pictures.far + pictures.near) / 2;
}

BlurGuess Reduced::blur_error(const BlurGuess &guess, const KnownLens &known) const {
    BlockFit all{.pixels = 1, .left = 1};
    for (const double depth : depths_) {
        const double from_middle = depth - pictures.middle, coc = guess.coc - guess.scale * from_middle;
        // The variance of a disc is a quarter of its squared radius. Changes: the CoC, the scale, the softness.
        const std::array by{coc / 2, known.focus ? coc * coc / (2 * guess.scale) : -coc * from_middle / 2,
                            1.0};
        for (std::size_t i = 0; i < by.size(); ++i) {
            all.pull[i] += by[i] * MatchTuning::small_blur_error / (1 + coc * coc);
            for (std::size_t k = 0; k < by.size(); ++k) all.stiffness[i][k] += by[i] * by[k];
        }
    }
    const Changes found = solve_blocks({all}, {!known.focus, !known.scale, true}).by;
    return {found[0], found[1], found[2]};
}

Rgb Reduced::gather(const ApertureShape &shape, double coc, double scale, bool exactly) const {
    const double focus = std::max(pictures.middle + coc / scale, 0.0);
    Progress none;
    PictureOptions by = exactly ? exactly_ : quickly_;
    by.gather.lens.looks.aperture = shape;
    return colours_in(gather_picture(ldi_, lens(focus, scale), box_, box_, by, none), box_, name_);
}

Imath::Box2i common_pixels(const Imath::Box2i &a, const Imath::Box2i &b) {
    const Imath::Box2i box = common_box(a, b);
    if (box.isEmpty()) throw UsageError("`region` contains no pixel that both pictures show");
    return box;
}

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
    const BlurGuess blur = in.blur_error(fit.guess, known_lens(match, in));
    const double focus_error = by_coc * blur.coc + by_scale * blur.scale;
    const auto coc_at = [middle = in.pictures.middle, coc = coc, scale = scale](double depth) {
        return std::abs(coc - scale * (depth - middle));
    };
    const double largest = std::max(coc_at(in.pictures.near), coc_at(in.pictures.far));
    of.largest_coc = in.by() * largest;
    of.coc_deviation = in.by() * std::hypot(own(c.coc), error.coc_px, blur.coc);
    of.focus_deviation = {own(focus_variance) / in.depth_scale(),
                          std::hypot(error.coc_px / scale, focus_error) / in.depth_scale()};
    of.radius_deviation = {
        own(c.scale / (scale * scale)),
        std::hypot(error.share, error.coc_px / std::max(largest, 1e-6), blur.scale / scale)};
    if (match.request.fit == MatchFit::fstop) of.focus_deviation = {};
    if (match.request.fit == MatchFit::focus) of.radius_deviation = {};
    of.softness = std::sqrt(std::max(softness, 0.0)) * in.by();
    of.focus_distance.value = focus > 0 ? depth_at_disparity(in.depth_scale(), focus) : infinite;
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
        return "the region of the plate shows nothing to compare, or something else than the LDI; check the "
               "shot and the frame, or choose a region with texture";
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
