#include "base/error.h"
#include "deep/checks/view_warnings.h"
#include "deep/cluster.h"
#include "deep/flatten.h"
#include "deep/front_samples.h"
#include "deep/rounded.h"
#include "denoised/denoised_views.h"
#include "dof/false_colour.h"
#include "io/camera/camera_read.h"
#include "io/camera/camera_write.h"
#include "chain/merge_ldis.h"
#include "io/recolor_ldi.h"
#include "lens/perceptive_depth.h"
#include "measure/image_error.h"
#include "measure/regions.h"
#include "python/arrays.h"
#include "python/device.h"
#include "python/finish.h"
#include "python/gather.h"
#include "python/job.h"
#include "python/objects.h"
#include "python/write.h"
#include "view/place_views.h"
#include "warp/reprojected_views.h"
#include "warp/warp.h"

#include <pybind11/stl.h>
#include <sparselens_docs.h>

namespace sparselens::python {

namespace {

constexpr const char *a_view = "a View", *an_ldi = "an Ldi";

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
    warn_of(name, view.in.warnings, view.in.bad);
    return view;
}

LdiObject open_ldi(const py::object &path, const py::kwargs &given) {
    Keywords keywords("open_ldi", given);
    const std::string name = path_of(path, "path");
    const OpenOptions options = file_options(keywords);
    keywords.done();
    auto ldi = job<OpenedLdi>(py::none(), [&](Progress &) { return open_ldi(name, options); });
    warn_of(name, ldi.warnings, ldi.bad);
    return ldi;
}

PictureObject open_picture(const py::object &path, const py::kwargs &given) {
    Keywords keywords("open_picture", given);
    const std::string name = path_of(path, "path");
    const PictureChoice picture = picture_choice(keywords);
    keywords.done();
    auto file = job<FlatFile>(py::none(), [&](Progress &) { return read_flat_exr(name, picture); });
    warn_of(name, file.warnings, {});
    return {std::move(file.image), std::move(file.header)};
}

// The objects of a sequence, or the one object.
template <typename Object>
std::vector<const Object *> several(const py::object &given, const char *name, const char *wanted) {
    if (py::isinstance<Object>(given)) return {&given.cast<const Object &>()};
    if (!py::isinstance<py::sequence>(given)) wrong_type(name, wanted, given);
    std::vector<const Object *> found;
    for (const py::handle &item : py::reinterpret_borrow<py::sequence>(given))
        found.push_back(&argument<Object>(py::reinterpret_borrow<py::object>(item), name, wanted));
    if (found.empty()) throw UsageError(std::string(name) + ": there is none");
    return found;
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

// In the order of the views.
std::vector<DenoisedPicture> denoised_pictures(Keywords &keywords, std::size_t views) {
    const py::object given = keywords.take("denoised");
    if (given.is_none()) return {};
    std::vector<DenoisedPicture> pictures;
    for (const PictureObject *picture : several<PictureObject>(given, "denoised", "a sequence of Picture"))
        pictures.push_back(
            {"denoised[" + std::to_string(pictures.size()) + "]",
             ready_beauty({.image = picture->image, .header = picture->header}, "denoised").image});
    if (pictures.size() != views)
        throw UsageError("denoised: " + std::to_string(pictures.size()) + " for " + std::to_string(views) +
                         " views; give one for each, in the order of the views");
    return pictures;
}

LdiObject warp(const py::object &views, const py::kwargs &given) {
    Keywords keywords("warp", given);
    const auto from = several<ViewObject>(views, "views", "a sequence of View");
    const WarpOptions options = warp_options(keywords);
    const bool rounds = keywords.word<bool>("precision", {{"exact", false}, {"lens", true}}).value_or(false);
    const LensValues lens = lens_values(keywords);
    const auto across = keywords.whole("supersample", 1, most_across);
    const std::string given_device = keywords.text("device");
    std::vector<DenoisedPicture> denoised = denoised_pictures(keywords, from.size());
    const std::string noisy = keywords.text("noisy");
    if (!denoised.empty() && !noisy.empty()) throw UsageError("noisy and denoised exclude each other");
    const py::object progress = keywords.take("progress");
    keywords.done();
    std::vector<std::string> warnings;
    OpenedLdi made = job<OpenedLdi>(progress, [&](Progress &said) {
        std::vector<PackedView> placed;
        std::vector<StatedView> stated;
        for (const ViewObject *view : from) {
            placed.emplace_back(View(view->in.view)); // a copy
            stated.push_back(
                {view->in.view.name, camera_with_options(lens, view->in.camera), view->position});
            if (across) stated.back().camera.supersample = across;
        }
        OpenedLdi out;
        out.name = "warp";
        out.header = from[0]->in.header;
        out.camera = place_views(placed, stated);
        write_camera(out.header, out.camera);
        write_picture_window(out.header, placed[0].samples.windows.data);
        check_views(placed);
        if (!noisy.empty())
            for (PackedView &view : placed) denoised.push_back(part_denoised(view, noisy));
        const WarpOptions of_lens = with_lens(options, out.camera, placed);
        if (!denoised.empty())
            take_denoised(placed, denoised, of_lens.focal_px,
                          perceptive_scale(of_lens.radius, of_lens.focal_px));
        // While their pixels are there.
        std::vector<std::string> of_views = view_warnings(
            placed, {from[0]->in.depth, from[0]->in.depth_filtered, out.camera, from[0]->in.unpremultiplied});
        with_warp_device(given_device.empty() ? "cpu" : given_device, warnings, [&](WarpDevice *device) {
            WarpOptions by = of_lens;
            by.device = device;
            out.ldi = warp(std::move(placed), by, said);
            if (rounds) round_for_lens(out.ldi, scale_in_picture(by));
        });
        for (std::string &warning : of_views) warnings.push_back(std::move(warning));
        return out;
    });
    for (const std::string &warning : warnings) warn(warning);
    LdiObject out{std::move(made)};
    return out;
}

// The LDI without its samples.
OpenedLdi described_as(const OpenedLdi &in) {
    OpenedLdi out;
    out.name = in.name;
    out.header = in.header;
    out.camera = in.camera;
    return out;
}

ClusterOptions cluster_options(const Camera &camera, const Windows &windows, std::optional<double> tolerance,
                               int layers) {
    ClusterOptions options{.layers = layers};
    const double by = tolerance.value_or(0.25);
    const auto scale = perceptive_scale(camera, windows, by > 0 && (tolerance || layers == 0));
    if (!scale) return options;
    options.scale = *scale;
    options.tolerance = by;
    return options;
}

// Returns what is to be warned of.
std::vector<std::string> recolored_by(const PictureObject &picture, OpenedLdi &ldi) {
    const Beauty beauty = ready_beauty({.image = picture.image, .header = picture.header}, "recolor");
    std::vector<std::string> warnings = recolor(ldi, beauty);
    if (beauty.bad.any()) warnings.push_back(beauty.name + ": " + beauty.bad.text());
    return warnings;
}

LdiObject cluster(const py::object &ldi, const py::kwargs &given) {
    Keywords keywords("cluster", given);
    const auto from = several<LdiObject>(ldi, "ldi", "an Ldi, or a sequence of them");
    const auto tolerance = keywords.number("tolerance", at_least_0);
    const int layers = keywords.whole("layers", 0, 1 << 20).value_or(0);
    const auto across = keywords.whole("supersample", 1, most_across);
    const py::object colours = keywords.take("recolor");
    const LensValues lens = lens_values(keywords);
    const py::object progress = keywords.take("progress");
    keywords.done();
    const PictureObject *beauty =
        colours.is_none() ? nullptr : &argument<PictureObject>(colours, "recolor", "a Picture");
    std::vector<std::string> warnings;
    LdiObject made = job<OpenedLdi>(progress, [&](Progress &said) {
        OpenedLdi merged; // of one LDI only what describes it: its samples are not copied
        if (from.size() > 1 || beauty) {
            std::vector<OpenedLdi> parts;
            for (const OpenedLdi *part : from) {
                parts.push_back(*part);
                if (across) parts.back().camera.supersample = across;
            }
            merged = merge_ldis(std::move(parts));
            if (beauty) warnings = recolored_by(*beauty, merged);
        } else {
            merged = described_as(*from[0]);
            if (across) merged.camera.supersample = across;
        }
        const Ldi &in = from.size() > 1 || beauty ? merged.ldi : from[0]->ldi;
        merged.camera = camera_with_options(lens, merged.camera);
        merged.ldi = cluster(in, cluster_options(merged.camera, in.windows, tolerance, layers), said).ldi;
        return merged;
    });
    for (const std::string &warning : warnings) warn(warning);
    return made;
}

PictureObject flatten(const py::object &ldi) {
    const LdiObject &in = argument<LdiObject>(ldi, "ldi", an_ldi);
    return job<PictureObject>(py::none(), [&](Progress &) {
        PictureObject out{crop(flatten(in.ldi), read_picture_window(in.header)), in.header};
        write_camera(out.header, in.camera);
        return out;
    });
}

// A picture of the pixels that the LDI is to give.
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
    if (name == "layers")
        return job<PictureObject>(py::none(),
                                  [&](Progress &) { return picture_of_ldi(in, layer_colours(in.ldi)); });
    if (name != "coc" && name != "focus") Keywords::refuse("what", "one of coc, focus, layers", name);
    const ThinLens lens = resolve_lens(camera_with_options(values, in.camera), in.ldi.windows);
    const auto colours = name == "coc" ? coc_colours : focus_colours;
    return job<PictureObject>(py::none(),
                              [&](Progress &) { return picture_of_ldi(in, colours(in.ldi, lens)); });
}

PlanObject plan(const py::object &view, const py::kwargs &given) {
    Keywords keywords("plan", given);
    const OpenedView &centre = argument<ViewObject>(view, "view", a_view).in;
    PlanOptions options;
    options.views = keywords.whole("views", 0, 64).value_or(options.views);
    options.margin = keywords.whole("margin", 0, 1024).value_or(options.margin);
    options.noise = keywords.number("noise", at_least_0);
    options.across =
        keywords.whole("supersample", 1, most_across).value_or(centre.camera.supersample.value_or(1));
    const LensValues values = lens_values(keywords);
    const py::object progress = keywords.take("progress");
    keywords.done();
    const Windows &windows = centre.view.image.windows;
    const ThinLens lens = resolve_lens(camera_with_options(values, centre.camera), windows);
    return job<PlanObject>(progress, [&](Progress &said) -> PlanObject {
        return {make_plan(centre.view, lens, options, said),
                {centre.view.name, windows, lens, options.margin, options.across}};
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

std::vector<std::uint8_t> bits_of(const OpenedLdi &in, const LensValues &values, const Windows &target) {
    const Windows &w = in.ldi.windows;
    if (w.display_width() != target.display_width() || w.display_height() != target.display_height())
        throw UsageError("regions: its display window differs in size from that of the reference");
    const ThinLens lens = resolve_lens(camera_with_options(values, in.camera), w);
    const std::vector<float> c = front_circles_of_confusion(in.ldi, lens);
    return bits_over(region_bits(c, w.width(), w.height(), lens.pixel_aspect), w, target);
}

py::dict compare(const py::object &image, const py::object &reference, const py::kwargs &given) {
    Keywords keywords("compare", given);
    const Image a = picture_of(image, "image"), b = picture_of(reference, "reference");
    const py::object regions = keywords.take("regions");
    const OpenedLdi *by = regions.is_none() ? nullptr : &argument<LdiObject>(regions, "regions", an_ldi);
    const LensValues lens = lens_values(keywords);
    keywords.done();
    const auto figures = job<std::vector<ErrorFigures>>(py::none(), [&](Progress &) {
        const auto bits = by ? bits_of(*by, lens, b.windows) : std::vector<std::uint8_t>();
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
        .def("flatten", &flatten, py::arg("ldi"), doc::flatten)
        .def("front_depth", py::overload_cast<const py::object &>(&front_depth), py::arg("ldi"),
             doc::front_depth)
        .def("show", &show, py::arg("ldi"), py::arg("what"), doc::show)
        .def("plan", &plan, py::arg("view"), doc::plan)
        .def("compare", &compare, py::arg("image"), py::arg("reference"), doc::compare)
        .def("write", &write, py::arg("path"), py::arg("what"), doc::write);
}

} // namespace sparselens::python
