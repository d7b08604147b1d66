#include "python/verbs.h"

#include "base/error.h"
#include "chain/colours.h"
#include "chain/make_ldi.h"
#include "chain/match_lens.h"
#include "chain/plan_views.h"
#include "chain/regions.h"
#include "chain/take_picture.h"
#include "deep/flatten.h"
#include "io/camera/camera_header.h"
#include "io/display/shown_picture.h"
#include "measure/image_error.h"
#include "measure/regions.h"
#include "python/arrays.h"
#include "python/job.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <sparselens_docs.h>

#include <utility>

namespace sparselens::python {

namespace {

constexpr const char *a_view = "a View", *an_ldi = "an Ldi", *views_wanted = "a sequence of View and Ldi";

ViewObject open_view(const py::object &path, const py::kwargs &given) {
    Keywords keywords("open_view", given);
    const std::string name = path_of(path, "path");
    const auto position = keywords.pair("position");
    const py::object center = keywords.take("center");
    const Camera otherwise =
        center.is_none() ? Camera{} : argument<ViewObject>(center, "center", a_view).in.camera;
    const OpenOptions options = file_options(keywords);
    keywords.done();
    ViewObject view{
        job<OpenedView>(py::none(), [&](Progress &) { return open_view(name, options, otherwise); }),
        position};
    warn_of(name, view.in);
    return view;
}

LdiObject open_ldi(const py::object &path, const py::kwargs &given) {
    Keywords keywords("open_ldi", given);
    const std::string name = path_of(path, "path");
    const OpenOptions options = file_options(keywords);
    keywords.done();
    auto ldi = job<OpenedLdi>(py::none(), [&](Progress &) {
        OpenedLdi opened = open_ldi(name, options);
        if (has_shown_ending(name))
            opened.header = to_linear([](const Notice &) {}, {}, name, opened.header, opened.ldi);
        return opened;
    });
    warn_of(name, ldi);
    return ldi;
}

PictureObject open_picture(const py::object &path, const py::kwargs &given) {
    Keywords keywords("open_picture", given);
    const std::string name = path_of(path, "path");
    const PictureChoice picture = picture_choice(keywords);
    keywords.done();
    auto file = job<FlatFile>(py::none(), [&](Progress &) { return read_flat_exr(name, picture); });
    for (const std::string &warning : file.warnings) warn(name + ": " + warning);
    return {std::move(file.image), std::move(file.header)};
}

WarpOptions warp_options(Keywords &keywords) {
    const auto merge = keywords.word<Merge>("merge", {{"average", Merge::average}, {"keep", Merge::keep}});
    const auto split = keywords.word<bool>("silhouettes", {{"split", true}, {"whole", false}});
    const auto test = keywords.word<bool>("agreement", {{"test", true}, {"assume", false}});
    const auto images = keywords.word<bool>("optical", {{"on", true}, {"off", false}});
    return {.merge = merge.value_or(Merge::average),
            .split_silhouettes = split.value_or(true),
            .test_photo_consistency = test.value_or(true),
            .find_images = images.value_or(true)};
}

// Makes the object of a MadeLdi or a ClusteredLdi.
template <typename Made>
LdiObject ldi_of(const std::string &name, Made made) {
    LdiObject out;
    out.name = name;
    out.ldi = std::move(made.ldi);
    out.header = std::move(made.header);
    out.camera = std::move(made.camera);
    return out;
}

// The pictures of all views, in their order.
std::vector<DenoisedPicture> denoised_pictures(Keywords &keywords) {
    const py::object given = keywords.take("denoised");
    std::vector<DenoisedPicture> pictures;
    if (given.is_none()) return pictures;
    for (const PictureObject *picture : several<PictureObject>(given, "denoised", "a sequence of Picture"))
        pictures.push_back({"denoised[" + std::to_string(pictures.size()) + "]", picture->image});
    return pictures;
}

ViewInMemory view_in_memory(const py::handle &object) {
    if (py::isinstance<ViewObject>(object)) {
        const auto &view = object.cast<const ViewObject &>();
        return {.flat = &view.in, .position = view.position};
    }
    return {.deep = &argument<LdiObject>(object, "views", views_wanted)};
}

std::vector<ViewInMemory> views_in_memory(const py::object &views) {
    if (py::isinstance<ViewObject>(views) || py::isinstance<LdiObject>(views)) return {view_in_memory(views)};
    std::vector<ViewInMemory> found;
    for (const py::handle &item : sequence_of(views, "views", views_wanted))
        found.push_back(view_in_memory(item));
    if (found.empty()) throw UsageError("views: there is none");
    return found;
}

LdiObject warp(const py::object &views, const py::kwargs &given) {
    Keywords keywords("warp", given);
    const std::vector<ViewInMemory> from = views_in_memory(views);
    LdiFromViews request{.warp = warp_options(keywords)};
    request.denoised_pictures = denoised_pictures(keywords);
    request.noisy = keywords.text("noisy");
    if (!request.denoised_pictures.empty() && !request.noisy.empty())
        throw UsageError("noisy and denoised exclude each other");
    request.lens = lens_values(keywords);
    request.supersample = keywords.whole("supersample", 1, most_across);
    if (const std::string device = keywords.text("device"); !device.empty()) request.device = device;
    const py::object progress = keywords.take("progress");
    keywords.done();
    return job_with_notices<LdiObject>(progress, [&](Progress &said, const Notify &notify) -> LdiObject {
        MadeLdi made = make_ldi(from, request, {said, notify, &warp_device()});
        return ldi_of(request.name, std::move(made));
    });
}

LdiObject cluster(const py::object &ldi, const py::kwargs &given) {
    Keywords keywords("cluster", given);
    const auto from = several<LdiObject>(ldi, "ldi", "an Ldi, or a sequence of them");
    ClusterRequest request{.tolerance = keywords.number("tolerance", at_least_0)};
    request.layers = keywords.whole("layers", 0, 1 << 20).value_or(0);
    request.supersample = keywords.whole("supersample", 1, most_across);
    const py::object colours = keywords.take("recolor");
    request.lens = lens_values(keywords);
    const py::object progress = keywords.take("progress");
    keywords.done();
    const PictureObject *flat =
        colours.is_none() ? nullptr : &argument<PictureObject>(colours, "recolor", "a Picture");
    return job_with_notices<LdiObject>(progress, [&](Progress &said, const Notify &notify) -> LdiObject {
        FlatFile beauty;
        if (flat) beauty = {.image = flat->image, .header = flat->header};
        if (flat) request.beauty = &beauty;
        ClusteredLdi made = cluster_ldi(from, request, said, notify);
        return ldi_of(from[0]->name, std::move(made));
    });
}

PictureObject flatten(const py::object &ldi) {
    const LdiObject &in = argument<LdiObject>(ldi, "ldi", an_ldi);
    return job<PictureObject>(py::none(), [&](Progress &) {
        PictureObject out{crop(flatten(in.ldi), read_picture_window(in.header)), in.header};
        write_camera(out.header, in.camera);
        return out;
    });
}

// A picture of the pixels that pictures of the LDI have.
PictureObject picture_of_ldi(const OpenedLdi &in, const Image &image) {
    return {crop(image, read_picture_window(in.header)), in.header};
}

PictureObject front_depth(const py::object &ldi) {
    const LdiObject &in = argument<LdiObject>(ldi, "ldi", an_ldi);
    return job<PictureObject>(py::none(),
                              [&](Progress &) { return picture_of_ldi(in, front_depth(in.ldi)); });
}

PictureObject show(const py::object &ldi, const py::object &what, const py::kwargs &given) {
    Keywords keywords("show", given);
    const LdiObject &in = argument<LdiObject>(ldi, "ldi", an_ldi);
    const LensValues values = lens_values(keywords);
    keywords.done();
    if (!py::isinstance<py::str>(what)) wrong_type("what", "a str", what);
    const auto name = what.cast<std::string>();
    const std::pair<const char *, Show> words[] = {
        {"coc", Show::coc}, {"focus", Show::focus}, {"layers", Show::layers}};
    const auto found = std::ranges::find(words, name, [](const auto &word) { return word.first; });
    if (found == std::end(words)) Keywords::refuse("what", "one of coc, focus, layers", name);
    ThinLens lens;
    if (found->second != Show::layers)
        lens = resolve_lens(camera_with_options(values, in.camera), in.ldi.windows);
    return job<PictureObject>(py::none(), [&](Progress &) {
        return picture_of_ldi(in, false_colours(found->second, in.ldi, lens));
    });
}

PlanObject plan(const py::object &view, const py::kwargs &given) {
    Keywords keywords("plan", given);
    const auto moments =
        several<ViewObject>(view, "view", "a View, or a sequence of the moments of a shutter");
    const OpenedView &centre = moments[moments.size() / 2]->in;
    PlanOptions options;
    options.views = keywords.whole("views", 0, 64).value_or(options.views);
    options.margin = keywords.whole("margin", 0, 1024).value_or(options.margin);
    options.noise = keywords.number("noise", at_least_0);
    const auto across = keywords.whole("supersample", 1, most_across);
    const auto rays = keywords.whole("rays", 1, 1 << 20);
    const LensValues lens = lens_values(keywords);
    const py::object progress = keywords.take("progress");
    keywords.done();
    return job_with_notices<PlanObject>(progress, [&](Progress &said, const Notify &notify) -> PlanObject {
        PlannedViews made = plan_views(centre, options, lens, across, rays, said, notify);
        if (moments.size() > 1)
            made.setting.moments =
                plan_moments(moments.front()->in, moments.back()->in, moments.size(), made, lens);
        return {std::move(made.plan), std::move(made.setting)};
    });
}

// A picture to compare: a Picture, a View or an array of [row][column][3 or 4].
Image picture_of(const py::object &given, const char *name) {
    if (py::isinstance<PictureObject>(given)) return given.cast<const PictureObject &>().image;
    if (py::isinstance<ViewObject>(given)) return given.cast<const ViewObject &>().in.view.image;
    if (py::isinstance<py::array>(given)) return image_from(given, name, Layout::hwc, {}, "Y");
    wrong_type(name, "a Picture, a View or a numpy array", given);
}

py::dict dict_of(const ErrorFigures &figures) {
    py::dict found;
    for (const Figure &figure : figure_table) found[figure.name] = figures.*figure.value;
    found["pixels"] = figures.pixels;
    py::dict nonfinite;
    nonfinite["image"] = figures.nonfinite_image;
    nonfinite["reference"] = figures.nonfinite_reference;
    found["nonfinite"] = nonfinite;
    return found;
}

py::dict compare(const py::object &image, const py::object &reference, const py::kwargs &given) {
    Keywords keywords("compare", given);
    const Image a = picture_of(image, "image"), b = picture_of(reference, "reference");
    const py::object regions = keywords.take("regions");
    const OpenedLdi *by = regions.is_none() ? nullptr : &argument<LdiObject>(regions, "regions", an_ldi);
    const LensValues lens = lens_values(keywords);
    keywords.done();
    const auto figures =
        job_with_notices<std::vector<ErrorFigures>>(py::none(), [&](Progress &, const Notify &notify) {
            const auto bits = by ? regions_over(b.windows, *by, lens, notify) : std::vector<std::uint8_t>();
            return image_error(rgba_over(a, b.windows, "image"), rgba_over(b, b.windows, "reference"), bits,
                               bits.empty() ? 0 : region_names.size());
        });
    py::dict found = dict_of(figures.front());
    if (!by) return found;
    py::dict each;
    for (std::size_t r = 1; r < figures.size(); ++r) each[region_names[r - 1]] = dict_of(figures[r]);
    found["regions"] = each;
    return found;
}

} // namespace

void bind_verbs(py::module_ &module) {
    module.def("open_view", &open_view, py::arg("path"), doc::open_view)
        .def("open_ldi", &open_ldi, py::arg("path"), doc::open_ldi)
        .def("open_picture", &open_picture, py::arg("path"), doc::open_picture)
        .def("warp", &warp, py::arg("views"), doc::warp)
        .def("cluster", &cluster, py::arg("ldi"), doc::cluster)
        .def("gather", &gather, py::arg("ldi"), doc::gather)
        .def("finish", &finish, py::arg("gathered"), py::arg("rays"), doc::finish)
        .def("match", &match, py::arg("ldi"), py::arg("plate"), doc::match)
        .def("flatten", &flatten, py::arg("ldi"), doc::flatten)
        .def("front_depth", py::overload_cast<const py::object &>(&front_depth), py::arg("ldi"),
             doc::front_depth)
        .def("show", &show, py::arg("ldi"), py::arg("what"), doc::show)
        .def("plan", &plan, py::arg("view"), doc::plan)
        .def("compare", &compare, py::arg("image"), py::arg("reference"), doc::compare)
        .def("write", &write, py::arg("path"), py::arg("what"), doc::write);
}

namespace {

struct MatchArguments : MatchRequest {
    py::object progress = {};
};

MatchArguments arguments_from(const py::kwargs &given) {
    Keywords keywords("match", given);
    MatchArguments arguments;
    arguments.region = keywords.box("region");
    arguments.fit =
        keywords
            .word<MatchFit>(
                "fit", {{"both", MatchFit::both}, {"focus", MatchFit::focus}, {"fstop", MatchFit::fstop}})
            .value_or(MatchFit::both);
    arguments.lens = lens_values(keywords);
    arguments.progress = keywords.take("progress");
    keywords.done();
    return arguments;
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
    const MatchArguments arguments = arguments_from(given);
    std::vector<Image> fits;
    MatchedFrames found = job<MatchedFrames>(arguments.progress, [&](Progress &progress) {
        FrameMatcher matcher(arguments);
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
