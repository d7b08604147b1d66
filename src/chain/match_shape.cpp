#include "chain/match_shape.h"

#include "chain/match_pictures.h"
#include "match/shape_search.h"
#include "match/tuning.h"

#include <algorithm>

namespace sparselens {

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

} // namespace sparselens
