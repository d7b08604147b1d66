// Matches the plates of a shot one after the other: each is looked for near the lens of the one before first, and the
// lenses are smooth over time.
#pragma once

#include "match_lens.h"

#include <string>
#include <vector>

namespace sparselens {

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
