#include "python/gather.h"

#include "base/error.h"
#include "deep/front_samples.h"
#include "dof/gather_picture.h"
#include "io/camera/camera_write.h"
#include "chain/channels.h"
#include "chain/gather_windows.h"
#include "chain/picture_looks.h"
#include "python/device.h"
#include "python/job.h"
#include "python/keywords.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens::python {

namespace {

// What the keywords ask for.
struct Asked {
    PictureOptions picture; // without the holdout
    WindowOptions windows;
    std::string channels; // comma-separated; empty: all
    std::string device;   // as with_gather_device() has it
    std::optional<Imath::V2i> focus_pixel;
    const OpenedLdi *holdout = nullptr; // kept alive by `keep_holdout`
    py::object keep_holdout, progress;
    LensValues lens;
    GivenLooks looks;
};

bool knows_looks(const Asked &asked) { return asked.picture.method == &gather_methods().front(); }

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
    refuse_ignored(asked.picture.method->name,
                   [&](const std::string &parameter) { return keywords.is_given(parameter); });
    asked.device = keywords.text("device");
    if (asked.device.empty()) asked.device = "cpu";
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
        asked.holdout = &argument<OpenedLdi>(asked.keep_holdout, "holdout", "an Ldi");
    asked.picture.holdout_defocused = keywords.flag("holdout_defocused");
    if (asked.picture.holdout_defocused && !asked.holdout)
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

Camera focused(Camera camera, const OpenedLdi &in, const Asked &asked) {
    const std::optional<Imath::V2i> &pixel = asked.focus_pixel;
    if (!pixel) return camera;
    require_inside(*pixel, in, subpixels_of(asked.windows, in).across);
    const float z = front_depth(in.ldi, middle_subpixel(*pixel, subpixels_of(asked.windows, in).across));
    if (!(z > 0))
        throw UsageError(
            fmt::format("focus_pixel: ldi has no sample at ({}, {}); choose a pixel that shows something",
                        pixel->x, pixel->y));
    camera.focus_distance = double(z);
    return camera;
}

PictureObject gathered_all(const Asked &asked, const OpenedLdi &in, Camera camera, ThinLens lens,
                           TileDevice *device, Progress &progress) {
    PictureObject out{{}, in.header};
    std::optional<Ldi> holdout;
    if (asked.holdout) holdout = holdout_for(in, asked.windows, asked.holdout->ldi, "holdout");
    GatherWindows frame = gather_windows(asked.windows, in, lens);
    const LensFile looks = read_looks(asked.looks, camera.fstop);
    PictureOptions options = asked.picture;
    if (knows_looks(asked))
        options.gather.lens.looks = picture_looks(looks, camera, out.header, lens, frame.ldi(in).windows);
    choose_windows(frame, asked.windows, in, lens, options.gather.lens.looks);
    raise_highlights(frame, in, highlight_gain(looks.values));
    const Ldi &ldi = frame.ldi(in);
    options.holdout = holdout ? &*holdout : nullptr;
    options.gather.lens.device = device;
    options.gather.lens.across = frame.subpixels.across;
    options.gather.views_radius = views_radius(camera);
    out.image = frame.picture_of(gather_picture(ldi, lens, frame.gathered, frame.needed, options, progress));
    write_picture_camera(out.header, camera);
    return out;
}

// The same of the channels that are asked for, of a copy of the LDI.
PictureObject gathered(const Asked &asked, const OpenedLdi &in, const Camera &camera, const ThinLens &lens,
                       TileDevice *device, Progress &progress) {
    require_channels(in);
    if (asked.channels.empty()) return gathered_all(asked, in, camera, lens, device, progress);
    OpenedLdi fewer = in;
    keep_channels(fewer.ldi, asked.channels);
    PictureObject out = gathered_all(asked, fewer, camera, lens, device, progress);
    out.image = chosen_channels(std::move(out.image), asked.channels);
    return out;
}

} // namespace

PictureObject gather(const py::object &ldi, const py::kwargs &given) {
    const Asked asked = asked_by(given);
    const OpenedLdi &in = argument<OpenedLdi>(ldi, "ldi", "an Ldi");
    const Camera camera = focused(camera_with_options(asked.lens, in.camera), in, asked);
    const ThinLens lens = resolve_lens(camera, in.ldi.windows);
    if (const auto warning = warning_of_wide_lens(camera, lens)) warn(*warning);
    if (!knows_looks(asked))
        if (const auto warning = warning_of_round_aperture(camera.looks, asked.picture.method->name))
            warn(*warning);
    std::vector<std::string> warnings;
    auto picture = job<PictureObject>(asked.progress, [&](Progress &said) {
        PictureObject made;
        with_gather_device(asked.device, warnings, [&](TileDevice *device) {
            made = gathered(asked, in, camera, lens, device, said);
        });
        return made;
    });
    for (const std::string &warning : warnings) warn(warning);
    return picture;
}

} // namespace sparselens::python
