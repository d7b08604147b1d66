// Finds the lens of a plate: the focus distance and the f-number at which the picture of an LDI is blurred as the plate
// is. The plate shows what the LDI shows, from the same camera. It may differ in exposure, grade, tone curve, grain,
// softness and compression, and show other things in front in some places.
#pragma once

#include "../base/image.h"
#include "../base/progress.h"
#include "../io/lens_file.h"
#include "../io/open_ldi.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// A value, and the range that should hold the true one in 90 % of cases.
struct MatchedValue {
    double value = 0, low = 0, high = 0;
};

// A standard deviation, in two parts: one that is independent in each frame, and the error of gathered pictures, which
// all frames share.
struct MatchedDeviation {
    double own = 0, shared = 0;
    double both() const { return std::hypot(own, shared); }
};

// The lens of one plate.
struct MatchedLens {
    MatchedValue focus_distance;       // scene units, (0, inf]
    MatchedValue lens_radius;          // scene units
    std::optional<MatchedValue> fstop; // if the focal length is known
    double softness = 0;               // of the whole plate: standard deviation, pixels of the plate
    double matched_share = 0; // of the blocks that show something: those that show what the LDI shows
    double largest_coc = 0;   // in the region, pixels of the plate
    double coc_deviation = 0; // standard deviation of the CoC at the middle depth, pixels of the plate
    MatchedDeviation focus_deviation;  // of 1 / focus_distance
    MatchedDeviation radius_deviation; // of the radius's natural logarithm
    std::string doubt = {};            // why this is not the lens of the plate; empty: it is
    Image fit = {}; // the gathered picture beside the plate, in grey, tone-mapped as they were compared
};

// Which values of the lens to find; a value that is not to be found is taken as given.
enum class MatchFit { both, focus, fstop };

struct MatchRequest {
    std::optional<Imath::Box2i> region = {}; // pixels of the plate; empty: all
    LensValues lens = {};                    // override the file's values
    GivenLooks looks = {};                   // the shape of the lens
    MatchFit fit = MatchFit::both;
    const MatchedLens *near = nullptr; // where to look first: the lens of the frame before
};

// Throws Error if the plate has another size or no colours, UsageError if a value of the lens is unknown or the region
// is empty.
MatchedLens match_lens(const OpenedLdi &in, const Image &plate, const std::string &plate_name,
                       const MatchRequest &request, Progress &progress);

// The shape of a plate's lens: the blades and the squeeze that the discs of its lamps show.
struct MatchedShape {
    int blades = 0;      // 0: round
    double rotation = 0; // degrees, as ApertureShape has it
    double squeeze = 1;
};

// Finds the shape. Returns nothing if the plate does not tell: no lens can be found for it, it has too little blur, or
// all shapes fit about as well. Throws as match_lens() does.
std::optional<MatchedShape> match_shape(const OpenedLdi &in, const Image &plate,
                                        const std::string &plate_name, const MatchRequest &request,
                                        Progress &progress);

// The request with this shape.
MatchRequest with_shape(MatchRequest request, const MatchedShape &shape);

// Matches the plates of a shot one after the other. The lens of each is first looked for near that of the plate before
// it. Then the lenses are smoothed over time.
struct MatchedFrames {
    std::vector<MatchedLens> lenses; // without the pictures of their fits
    std::vector<std::string> warnings;
};

class FrameMatcher {
public:
    explicit FrameMatcher(const MatchRequest &request) : request_(request) {}

    // Returns the picture of the fit. Throws as match_lens() does.
    Image match(const OpenedLdi &in, const Image &plate, const std::string &plate_name, Progress &progress);

    // The lenses so far. A plate that cannot be matched gets its neighbours' values, with a warning. Throws Error if
    // these are most of the plates.
    MatchedFrames smooth() const;

private:
    MatchRequest request_;
    std::vector<std::string> names_; // of the plates
    std::vector<MatchedLens> lenses_;
};

} // namespace sparselens
