#include "base/error.h"
#include "chain/colours.h"
#include "chain/notices.h"
#include "io/camera/camera_header.h"
#include "io/display/shown_picture.h"
#include "python/arrays.h"
#include "python/job.h"
#include "python/verbs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace sparselens::python {

namespace {

std::optional<Imf::Compression> compression_from(Keywords &keywords, bool deep) {
    const std::string name = keywords.text("compression");
    if (name.empty()) return {};
    const auto found = std::ranges::find(compressions(), name, &NamedCompression::name);
    if (found == compressions().end() || (deep && !found->deep))
        throw UsageError(fmt::format("compression: {} files have one of {}, not {}", deep ? "deep" : "flat",
                                     compression_names(deep, ", "), name));
    return found->value;
}

// Sets the type of all channels except ids.
void set_type(std::vector<Channel> &channels, std::optional<PixelType> type) {
    for (Channel &channel : channels)
        if (type && channel.type != PixelType::uint32) channel.type = *type;
}

void refuse_wrong_name(const std::string &path, OutputKind kind) {
    if (const std::string wrong = wrong_with_output(path, kind); !wrong.empty())
        throw UsageError("path: " + wrong);
}

void write_picture(const std::string &path, PictureObject picture, Keywords &keywords) {
    const auto type =
        keywords.word<PixelType>("type", {{"half", PixelType::half}, {"float", PixelType::float32}});
    const auto compression = compression_from(keywords, false);
    const int tiles = keywords.whole("tiles", 0, 8192).value_or(0);
    const ColourOptions colour{.config = keywords.path("colorconfig"),
                               .display = keywords.text("display"),
                               .view = keywords.text("view_transform")};
    keywords.done();
    refuse_wrong_name(path, OutputKind::picture);
    if (type && is_shown_picture(path)) throw UsageError("type: applies to EXR, not to " + path);
    set_type(picture.image.channels, type);
    job_with_notices<bool>(py::none(), [&](Progress &, const Notify &notify) {
        sparselens::write_picture(notify, colour, path, std::move(picture.image), picture.header, compression,
                                  tiles);
        return true;
    });
}

void write_deep(const std::string &path, const LdiObject &in, Keywords &keywords) {
    const auto compression = compression_from(keywords, true);
    keywords.done();
    refuse_wrong_name(path, OutputKind::exr);
    Imf::Header header = in.header;
    write_camera(header, in.camera);
    const auto clamped = job<std::size_t>(
        py::none(), [&](Progress &) { return write_ldi(path, in.ldi, header, compression); });
    if (clamped > 0) warn(words_of({NoticeKind::clamped, path, {clamped}}));
}

void write_plan_file(const std::string &path, const PlanObject &plan, Keywords &keywords) {
    const std::string masks = keywords.path("masks");
    keywords.done();
    run_job(py::none(), [&](Progress &) { write_plan(path, plan.plan, plan.setting, masks); });
}

} // namespace

py::object png_of(const PictureObject &picture) {
    if (!all_found(find_rgb(picture.image.channels))) return py::none();
    return py::bytes(job<std::string>(py::none(), [&](Progress &) {
        Image image = picture.image;
        const auto extras = to_shown_colours({}, "picture.png", image, picture.header);
        return shown_picture("Picture", "png", image, *extras);
    }));
}

void write(const py::object &path, const py::object &what, const py::kwargs &given) {
    Keywords keywords("write", given);
    const std::string name = path_of(path, "path");
    if (py::isinstance<LdiObject>(what)) return write_deep(name, what.cast<const LdiObject &>(), keywords);
    if (py::isinstance<PlanObject>(what))
        return write_plan_file(name, what.cast<const PlanObject &>(), keywords);
    if (py::isinstance<PictureObject>(what))
        return write_picture(name, what.cast<const PictureObject &>(), keywords);
    if (py::isinstance<py::array>(what))
        return write_picture(name, {image_from(what, "what", Layout::hwc, {}, "Y"), {}}, keywords);
    wrong_type("what", "an Ldi, a Picture, a Plan or a numpy array", what);
}

} // namespace sparselens::python
