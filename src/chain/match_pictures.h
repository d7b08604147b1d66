// The pictures that match_lens() compares: a plate, and what an LDI shows through a lens, both reduced; and the
// values of the lens that it reports.
#pragma once

#include "chain/match_lens.h"
#include "dof/gather_picture.h"
#include "match/blocks.h"
#include "match/lens_search.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// A shot to match: what does not depend on the size of the compared pictures.
struct Match {
    // Throws as match_lens() does.
    Match(const OpenedLdi &in, const Image &plate, const std::string &plate_name,
          const MatchRequest &request);

    const OpenedLdi &in;
    Image plate; // its clipped highlights are raised
    const std::string &plate_name;
    const MatchRequest &request;
    Camera camera;
    Imath::Box2i region; // pixels of the plate
    int across = 1;      // sub-pixels of the LDI to a pixel of the plate
};

// Both pictures, `by` times smaller than the plate. Throws UsageError if they share no pixel of the region.
class Reduced {
public:
    Reduced(const Match &match, int by, bool is_final);
    Reduced(const Reduced &) = delete; // `pictures` gathers from this
    Reduced &operator=(const Reduced &) = delete;

    Comparison pictures;

    int by() const { return by_; }
    double radius() const { return radius_; }
    double depth_scale() const; // R F, pixels times scene units
    // The deviation of a fitted lens that an error of small blur (MatchTuning::small_blur_error) causes.
    BlurGuess blur_error(const BlurGuess &guess, const KnownLens &known) const;
    const ApertureShape &shape() const { return exactly_.gather.lens.looks.aperture; }
    // Gathers the compared pixels through a lens of this shape. `coc`, `scale`: as in BlurGuess.
    Rgb gather(const ApertureShape &shape, double coc, double scale, bool exactly) const;

private:
    void choose_gathers(const Match &match, bool is_final);
    ThinLens lens(double focus, double scale) const; // `focus`: its disparity
    void find_usable();
    void find_depths();

    std::string name_; // of the LDI, for messages
    int by_;
    Ldi ldi_;
    double radius_ = 0, focal_px_ = 0;
    PictureOptions quickly_, exactly_;
    Imath::Box2i box_;           // the compared pixels
    std::vector<double> depths_; // disparity, of its usable pixels, sorted
};

// What the request says about the lens, and the guess that has the blur of a lens found before.
KnownLens known_lens(const Match &match, const Reduced &in);
BlurGuess guess_near(const MatchedLens &near, const Reduced &in);

// The pixels of both; throws UsageError if there are none.
Imath::Box2i common_pixels(const Imath::Box2i &a, const Imath::Box2i &b);

// The values of a matched lens, from what the search found, and the ranges that should hold the true ones; and why they
// may be wrong.
inline constexpr double certain = 1.645; // standard deviations to each side that hold 90 %
inline constexpr double infinite = std::numeric_limits<double>::infinity();

// The distance whose reciprocal this is; infinite if that is not above 0.
double distance_at(double inverse);

void set_values(MatchedLens &of, const Match &match, const Reduced &in, const LensFit &fit);

// The f-number times the radius of the lens, scene units, if the camera tells it.
std::optional<double> stops_by_radius(const Camera &camera);

// The ranges, from the values and their deviations; and the f-stop.
void set_intervals(MatchedLens &of, std::optional<double> stops_by_radius);

// Why the values that a search found are not those of the plate's lens, and what to do; empty: there is no doubt.
// `is_ambiguous`: another lens fits as well.
std::string doubt_of(const MatchedLens &lens, const Reduced &in, const LensFit &fit, const Evidence &evidence,
                     bool is_ambiguous);

} // namespace sparselens
