#include "base/error.h"
#include "chain/colours.h"
#include "finish/finish_picture.h"
#include "io/exr/exr_header.h"
#include "python/job.h"
#include "python/verbs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparselens::python {

namespace {

using Pictures = std::vector<const PictureObject *>;

Pictures pictures_of(const py::object &given, const char *name) {
    constexpr const char *wanted = "a sequence of Picture";
    Pictures found;
    if (given.is_none()) return found;
    for (const py::handle &item : sequence_of(given, name, wanted))
        found.push_back(&argument<PictureObject>(item, name, wanted));
    return found;
}

// Returns the samples that the headers state, if all headers do; else the same number for all.
std::vector<double> stated_samples(const Pictures &rays) {
    std::vector<double> samples;
    for (const PictureObject *picture : rays)
        if (const auto stated = render_samples(picture->header)) samples.push_back(*stated);
    return samples.size() == rays.size() ? samples : std::vector<double>(rays.size(), 1);
}

std::vector<double> samples_of(const py::object &given, const Pictures &rays) {
    if (given.is_none()) return stated_samples(rays);
    std::vector<double> samples;
    constexpr const char *wanted = "a sequence of numbers";
    for (const py::handle &item : sequence_of(given, "samples", wanted)) {
        if (!py::isinstance<py::float_>(item) && !py::isinstance<py::int_>(item))
            wrong_type("samples", wanted, item);
        samples.push_back(item.cast<double>());
        if (!(samples.back() > 0) || !std::isfinite(samples.back()))
            Keywords::refuse("samples", "above 0", fmt::format("{:g}", samples.back()));
    }
    return samples;
}

void check_count(const char *name, std::size_t count, std::size_t rays) {
    if (count != rays)
        throw UsageError(fmt::format("{}: {} for {} renders: give one for each", name, count, rays));
}

// `add` is TwoHalves::add or add_noisy.
TwoHalves added_up(const char *name, const Pictures &pictures, const std::vector<double> &samples,
                   const PictureObject &gathered, const Notify &notify,
                   void (TwoHalves::*add)(const Render &)) {
    TwoHalves halves(gathered.image);
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        Image image = pictures[k]->image;
        const NamedHeader render{pictures[k]->header, fmt::format("{}[{}]", name, k)};
        to_space_of(notify, {}, {gathered.header, "gathered"}, render, image);
        notify_other_lens(notify, gathered.header, render.header, render.name);
        (halves.*add)({render.name, std::move(image), samples[k]});
    }
    return halves;
}

// Pairs of a gathered picture and its renders.
std::vector<std::pair<const PictureObject *, Pictures>> frames_of(const py::object &given,
                                                                  std::size_t renders) {
    std::vector<std::pair<const PictureObject *, Pictures>> frames;
    if (given.is_none()) return frames;
    constexpr const char *wanted = "a sequence of pairs: a Picture and its renders";
    for (const py::handle &item : sequence_of(given, "around", wanted)) {
        const bool is_pair =
            (py::isinstance<py::tuple>(item) || py::isinstance<py::list>(item)) && py::len(item) == 2;
        if (!is_pair) wrong_type("around", wanted, given);
        const auto pair = py::reinterpret_borrow<py::sequence>(item);
        frames.emplace_back(&argument<PictureObject>(pair[0], "around", wanted),
                            pictures_of(pair[1], "around"));
        check_count("around", frames.back().second.size(), renders);
    }
    return frames;
}

// A picture with the channel Y: one value per pixel.
PictureObject map_of(const Values &values, const Windows &windows) {
    PictureObject map{Image(windows, {{"Y", PixelType::float32}}), {}};
    std::ranges::copy(values, map.image.plane(0).begin());
    return map;
}

} // namespace

py::dict finish(const py::object &gathered, const py::object &rays, const py::kwargs &given) {
    Keywords keywords("finish", given);
    const PictureObject &in = argument<PictureObject>(gathered, "gathered", "a Picture");
    const Pictures renders = pictures_of(rays, "rays");
    if (renders.size() < 2)
        throw UsageError(
            "rays: the noise of a single render is unknown: give two or more, each with another seed");
    const std::vector<double> samples = samples_of(keywords.take("samples"), renders);
    check_count("samples", samples.size(), renders.size());
    const Pictures denoised = pictures_of(keywords.take("denoised"), "denoised");
    if (!denoised.empty()) check_count("denoised", denoised.size(), renders.size());
    const auto around = frames_of(keywords.take("around"), renders.size());
    const py::object progress = keywords.take("progress");
    keywords.done();
    FinishedPicture made = job_with_notices<FinishedPicture>(progress, [&](Progress &said,
                                                                           const Notify &notify) {
        PictureToFinish picture{in.image,
                                added_up("rays", renders, samples, in, notify, &TwoHalves::add_noisy)};
        if (!denoised.empty())
            picture.denoised.push_back(added_up("denoised", denoised, samples, in, notify, &TwoHalves::add));
        for (const auto &[other, of_other] : around)
            picture.around.push_back(
                {other->image, added_up("around", of_other, samples, in, notify, &TwoHalves::add_noisy)});
        return finish_picture(std::move(picture), said);
    });
    for (const std::string &text : made.warnings) warn(text);
    const auto known = decibels(made.error);
    for (float &e : made.error.map) e = std::sqrt(e);
    py::dict found;
    found["trust"] = map_of(made.kept, made.image.windows);
    found["error"] = map_of(made.error.map, made.image.windows);
    found["psnr"] = known ? py::object(py::float_(*known)) : py::object(py::none());
    found["mse"] = made.error.mean;
    found["mse_deviation"] = made.error.standard_deviation;
    found["picture"] = PictureObject{std::move(made.image), in.header};
    return found;
}

} // namespace sparselens::python
