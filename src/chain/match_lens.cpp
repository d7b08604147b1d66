#include "chain/match_lens.h"

#include "base/error.h"
#include "base/subpixels.h"
#include "chain/match_doubt.h"
#include "chain/match_pictures.h"
#include "chain/match_values.h"
#include "lens/perceptive_depth.h"
#include "match/evidence.h"
#include "match/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
    if (match.request.fit == MatchFit::focus) known.scale = 1;
    if (match.request.fit != MatchFit::fstop) return known;
    if (!match.camera.focus_distance)
        throw UsageError("the focus distance is unknown: give `focus_distance`");
    known.focus = perceptive_depth(in.depth_scale(), *match.camera.focus_distance);
    return known;
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
    set_intervals(result, stops_by_radius(match.camera));
    const Evidence evidence = find_evidence(fine.pictures.plate, fine.pictures.usable, fit.shown);
    result.matched_share = evidence.matched_share();
    result.doubt = doubt_of(result, fine, fit, evidence, is_ambiguous);
    result.fit = side_by_side(brightness(fit.shown), fine.pictures.plate);
    progress.advance();
    return result;
}

} // namespace sparselens
