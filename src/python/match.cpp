#include "base/error.h"
#include "chain/match_frames.h"
#include "python/job.h"
#include "python/verbs.h"

#include <fmt/format.h>

#include <utility>

namespace sparselens::python {

namespace {

struct Asked : MatchRequest {
    py::object progress = {};
};

Asked asked_by(const py::kwargs &given) {
    Keywords keywords("match", given);
    Asked asked;
    asked.region = keywords.box("region");
    asked.fit =
        keywords
            .word<MatchFit>(
                "fit", {{"both", MatchFit::both}, {"focus", MatchFit::focus}, {"fstop", MatchFit::fstop}})
            .value_or(MatchFit::both);
    asked.lens = lens_values(keywords);
    asked.progress = keywords.take("progress");
    keywords.done();
    return asked;
}

// The LDI of each plate: one for all, or one for each.
std::vector<const LdiObject *> ldis_for(const py::object &given, std::size_t plates) {
    std::vector<const LdiObject *> ldis = several<LdiObject>(given, "ldi", "an Ldi, or a sequence of them");
    if (ldis.size() == 1) ldis.resize(plates, ldis.front());
    if (ldis.size() != plates)
        throw UsageError(
            fmt::format("ldi: {} for {} plates: give one for all, or one for each", ldis.size(), plates));
    return ldis;
}

py::dict dict_of(const MatchedValue &of) {
    py::dict found;
    found["value"] = of.value;
    found["interval"] = py::make_tuple(of.low, of.high);
    return found;
}

py::dict dict_of(const MatchedLens &lens, Image fit) {
    py::dict found;
    found["focus_distance"] = dict_of(lens.focus_distance);
    found["lens_radius"] = dict_of(lens.lens_radius);
    found["fstop"] = lens.fstop ? py::object(dict_of(*lens.fstop)) : py::object(py::none());
    found["softness"] = lens.softness;
    found["matched_share"] = lens.matched_share;
    found["largest_coc"] = lens.largest_coc;
    found["doubt"] = lens.doubt;
    found["fit"] = PictureObject{std::move(fit), {}};
    return found;
}

} // namespace

py::object match(const py::object &ldi, const py::object &plate, const py::kwargs &given) {
    const auto plates = several<PictureObject>(plate, "plate", "a Picture, or a sequence of them");
    const std::vector<const LdiObject *> ldis = ldis_for(ldi, plates.size());
    const Asked asked = asked_by(given);
    std::vector<Image> fits;
    MatchedFrames found = job<MatchedFrames>(asked.progress, [&](Progress &progress) {
        FrameMatcher matcher(asked);
        for (std::size_t i = 0; i < plates.size(); ++i)
            fits.push_back(matcher.match(*ldis[i], plates[i]->image, fmt::format("plate[{}]", i), progress));
        return matcher.smooth();
    });
    for (const std::string &text : found.warnings) warn(text);
    if (py::isinstance<PictureObject>(plate)) return dict_of(found.lenses[0], std::move(fits[0]));
    py::list all;
    for (std::size_t i = 0; i < fits.size(); ++i) all.append(dict_of(found.lenses[i], std::move(fits[i])));
    return all;
}

} // namespace sparselens::python
