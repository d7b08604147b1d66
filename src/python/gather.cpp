#include "python/gather.h"

#include "base/error.h"
#include "chain/take_picture.h"
#include "python/job.h"
#include "python/keywords.h"
#include "python/told.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens::python {

namespace {

// The request that the keywords make.
struct Asked : PictureRequest {
    py::object keep_holdout = {}, progress = {}; // the former keeps `opened_holdout` alive
};

void set_method(Asked &asked, Keywords &keywords) {
    const std::string name = keywords.text("method");
    if (!name.empty()) {
        const auto methods = gather_methods();
        const auto found =
            std::ranges::find_if(methods, [&](const GatherMethod &m) { return m.name == name; });
        if (found == methods.end()) throw UsageError("method: must be lens or selective, not " + name);
        asked.picture.method = &*found;
    }
    asked.picture.gather.lens.quality = keywords
                                            .word<Quality>("quality", {{"draft", Quality::draft},
                                                                       {"normal", Quality::normal},
                                                                       {"final", Quality::final}})
                                            .value_or(asked.picture.gather.lens.quality);
    asked.picture.gather.lens.lens_samples = keywords.whole("lens_samples", 0, 1 << 20).value_or(0);
    asked.picture.gather.layers = keywords.whole("layers", 1, 4096).value_or(asked.picture.gather.layers);
    asked.picture.layer_tolerance =
        keywords.number("layer_tolerance", at_least_0).value_or(asked.picture.layer_tolerance);
    asked.device = keywords.text("device");
    if (asked.device.empty()) asked.device = "cpu";
    check_method(asked, [&](const std::string &parameter) { return keywords.is_given(parameter); });
}

GivenLooks look_keywords(Keywords &keywords) {
    GivenLooks given;
    LookValues &values = given.values;
    keywords.numbers_of(look_numbers(), values);
    if (keywords.flag("cat_eye_darkening")) values.cat_eye_darkening = true;
    values.chromatic_type = keywords.word("axial_chromatic_type", chromatic_types());
    if (const auto tilt = keywords.pair("tilt")) {
        if (!is_tilt(tilt->x) || !is_tilt(tilt->y))
            Keywords::refuse("tilt", "two numbers between -89 and 89",
                             fmt::format("({:g}, {:g})", tilt->x, tilt->y));
        values.tilt_x = tilt->x;
        values.tilt_y = tilt->y;
    }
    given.lens_file = keywords.path("lens");
    given.aperture_file = keywords.path("aperture");
    const bool shaped = values.blades || values.curvature || values.rotation;
    if (shaped && !given.aperture_file.empty())
        throw UsageError("aperture: is given with blades; give one of the two");
    return given;
}

void take_highlights(Keywords &keywords, LookValues &values) {
    keywords.numbers_of(highlight_numbers(), values);
    if ((values.highlight_threshold || values.highlight_knee) && !values.highlight_gain)
        throw UsageError("highlight_gain: is needed by highlight_threshold and highlight_knee");
}

Asked asked_by(const py::kwargs &given) {
    Keywords keywords("gather", given);
    Asked asked;
    asked.keep_holdout = keywords.take("holdout");
    if (!asked.keep_holdout.is_none())
        asked.opened_holdout = &argument<OpenedLdi>(asked.keep_holdout, "holdout", "an Ldi");
    asked.picture.holdout_defocused = keywords.flag("holdout_defocused");
    if (asked.picture.holdout_defocused && !asked.opened_holdout)
        throw UsageError("holdout_defocused: needs a holdout");
    asked.looks = look_keywords(keywords);
    take_highlights(keywords, asked.looks.values);
    set_method(asked, keywords);
    const auto overscan = keywords.word<OutputOverscan>(
        "overscan",
        {{"grow", OutputOverscan::grow}, {"keep", OutputOverscan::keep}, {"crop", OutputOverscan::crop}});
    asked.windows = {.overscan = overscan.value_or(OutputOverscan::grow),
                     .proxy = keywords.whole("proxy", 1, 1024).value_or(1),
                     .region = keywords.box("region"),
                     .supersample = keywords.whole("supersample", 1, most_across)};
    if (const std::string filter = keywords.text("pixel_filter"); !filter.empty()) {
        asked.windows.filter = pixel_filter_of(filter);
        if (!asked.windows.filter)
            Keywords::refuse("pixel_filter", "box, blackman-harris or gaussian, with :WIDTH if wanted",
                             filter);
    }
    asked.channels = keywords.list("channels");
    asked.focus_pixel = keywords.pixel("focus_pixel");
    asked.lens = lens_values(keywords);
    if (asked.focus_pixel && asked.lens.focus_distance)
        throw UsageError("focus_pixel: is given with focus_distance; give one of the two");
    asked.progress = keywords.take("progress");
    keywords.done();
    return asked;
}

} // namespace

PictureObject gather(const py::object &ldi, const py::kwargs &given) {
    const Asked asked = asked_by(given);
    const OpenedLdi &in = argument<OpenedLdi>(ldi, "ldi", "an Ldi");
    return told_job<PictureObject>(
        asked.progress, [&](Progress &progress, const Tell &tell) -> PictureObject {
            TakenPicture made = take_picture(in, asked, {progress, tell, &gather_device()});
            return {std::move(made.image), std::move(made.header)};
        });
}

} // namespace sparselens::python
