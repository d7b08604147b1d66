#include "options/match_json.h"

#include <cmath>

namespace sparselens {

namespace {

using Json = nlohmann::ordered_json;

Json as_json(const MatchedValue &v) {
    return {{"value", finite_json(v.value)}, {"interval", {finite_json(v.low), finite_json(v.high)}}};
}

} // namespace

Json finite_json(double value) { return std::isfinite(value) ? Json(value) : Json("inf"); }

Json as_json(const MatchedShape &shape) {
    return {{"blades", shape.blades}, {"blade_rotation", shape.rotation}, {"squeeze", shape.squeeze}};
}

Json as_json(const MatchedLens &lens) {
    Json line{{"focus_distance", as_json(lens.focus_distance)}, {"lens_radius", as_json(lens.lens_radius)}};
    if (lens.fstop) line["fstop"] = as_json(*lens.fstop);
    line["softness"] = lens.softness;
    line["matched_share"] = lens.matched_share;
    line["largest_coc"] = lens.largest_coc;
    if (!lens.doubt.empty()) line["doubt"] = lens.doubt;
    return line;
}

} // namespace sparselens
