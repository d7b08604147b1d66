#include "chain/make_ldi.h"

#include "base/error.h"
#include "base/parallel.h"
#include "chain/devices.h"
#include "deep/checks/view_warnings.h"
#include "deep/merge.h"
#include "deep/tidy.h"
#include "io/camera/camera_header.h"
#include "view/lens_views.h"
#include "warp/reprojected_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace sparselens {

namespace {

// A view, flat or deep, ready for the warp.
struct OpenedPackedView : OpenedFile {
    PackedView view; // at the origin
};

// Where no coverage is known, all is covered: edges of surfaces can then be unmixed as in a view that says so.
void add_full_coverage(Image &image) {
    const std::array<std::size_t, 3> rgb = find_rgb(image.channels);
    if (!all_found(rgb) || find_channel(image.channels, "A") != npos) return;
    image.channels.push_back({"A", image.channels[rgb[0]].type});
    image.values.resize(image.channels.size() * image.windows.pixels(), 1);
}

OpenedPackedView packed(OpenedView opened) {
    add_full_coverage(opened.view.image);
    return {std::move(static_cast<OpenedFile &>(opened)), PackedView(std::move(opened.view))};
}

// Throws Error if the picture was made from several views, and so is not a view of one camera.
OpenedPackedView packed(OpenedLdi opened) {
    Ldi &ldi = opened.ldi;
    const auto any = [](const std::vector<float> &offsets) {
        return std::ranges::any_of(offsets, [](float offset) { return offset != 0; });
    };
    if (any(ldi.dx) || any(ldi.dy) || !ldi.image_z.empty() || !ldi.solid.empty())
        throw Error(opened.name + ": is an LDI, whose samples come from several views: give the views "
                                  "that it was made of, or merge LDIs with ldi-cluster");
    return {std::move(static_cast<OpenedFile &>(opened)), PackedView(opened.name, std::move(ldi))};
}

// Ray lengths need the frustum; if the file lacks it, it is taken from `otherwise`.
OpenedPackedView open_packed(const std::string &path, const OpenOptions &options,
                             const Camera &otherwise = {}) {
    return is_deep_alone(path) ? packed(open_ldi(path, options))
                               : packed(open_view(path, options, otherwise));
}

// The views on the lens.
struct PlacedViews {
    std::vector<PackedView> views; // the centre view first
    std::vector<OpenedFile> files; // of the views
    Camera camera;                 // of the centre view, with the lens points of all views
};

void add(PlacedViews &to, OpenedPackedView &opened) {
    to.views.push_back(std::move(opened.view));
    to.files.push_back(std::move(opened));
}

Camera with_subpixels(Camera camera, const LdiFromViews &request) {
    if (request.supersample) camera.supersample = request.supersample;
    return camera;
}

// The cameras that the request states for its files and then its placed views, or nothing for each.
std::vector<std::optional<FilmCamera>> films_of(const LdiFromViews &request,
                                                const std::vector<std::string> &paths) {
    const StatedCameras stated(request.camera);
    std::optional<FilmCamera> centre = stated.of_centre(paths[0]);
    if (!centre) return std::vector<std::optional<FilmCamera>>(paths.size());
    std::vector<std::optional<FilmCamera>> films =
        stated.of_views({request.files.begin() + 1, request.files.end()}, *centre);
    films.insert(films.begin(), centre);
    centre->places = false;
    films.resize(paths.size(), centre);
    return films;
}

constexpr std::size_t not_packed_yet = 2; // views read at once; packed, they take half the memory

// The position of a view is the given one, or else follows from worldToCamera (see position_on_lens, whose errors are
// thrown). Its framing comes from its metadata, or else from the centre view.
PlacedViews open_views(const LdiFromViews &request) {
    std::vector<std::optional<Imath::V2d>> positions(request.files.size());
    std::vector<std::string> paths = request.files;
    for (const auto &[position, path] : request.placed) {
        positions.push_back(position);
        paths.push_back(path);
    }
    const std::vector<DepthOptions> depths =
        depths_of_pictures(request.depth, request.depth_files, paths.size());
    const std::vector<std::optional<FilmCamera>> films = films_of(request, paths);
    OpenedPackedView centre = open_packed(paths[0], {request.lens, depths[0], films[0]});
    for (const std::string &warning : stated_warnings(films[0], request.lens))
        centre.warnings.push_back(warning);
    const Camera camera = with_subpixels(centre.camera, request);
    PlacedViews placed;
    std::vector<StatedView> stated{{paths[0], camera, positions[0]}};
    add(placed, centre);
    in_order(
        paths.size() - 1, // the rim views: while one is decompressed, the depths of another are settled
        [&](std::size_t n) {
            return open_packed(paths[n + 1], {request.lens, depths[n + 1], films[n + 1]}, camera);
        },
        [&](std::size_t n, OpenedPackedView next) {
            stated.push_back({paths[n + 1], with_subpixels(next.camera, request), positions[n + 1]});
            add(placed, next);
        },
        not_packed_yet);
    placed.camera = place_views(placed.views, stated);
    return placed;
}

// Copies the view, without what was said about its file.
OpenedPackedView opened(const ViewInMemory &view) {
    OpenedPackedView copy = view.flat ? packed(OpenedView(*view.flat)) : packed(OpenedLdi(*view.deep));
    copy.notes = copy.warnings = {};
    copy.speckles = 0;
    copy.bad = {};
    return copy;
}

PlacedViews copies_of(std::span<const ViewInMemory> views, const LdiFromViews &request) {
    PlacedViews placed;
    std::vector<StatedView> stated;
    for (const ViewInMemory &in : views) {
        OpenedPackedView view = opened(in);
        const Camera camera = camera_with_options(request.lens, view.camera);
        stated.push_back({view.view.name, with_subpixels(camera, request), in.position});
        add(placed, view);
    }
    placed.camera = place_views(placed.views, stated);
    return placed;
}

// Reports views whose framing differs from that of the centre view, because a misread frustum makes ghosts, too.
void notify_framings(const Notify &notify, std::span<const PackedView> views) {
    for (const PackedView &view : views.subspan(1)) {
        const Framing &centre = views[0].framing, &own = view.framing;
        if (own == Framing{.principal_point = centre.principal_point}) continue;
        const Imath::V2d axis = in_pixels(own.principal_point, view.samples.windows) -
                                in_pixels(centre.principal_point, view.samples.windows);
        notify({NoticeKind::framing, view.name, {axis.x, axis.y, own.zoom, own.forward}});
    }
}

void notify_views(const Notify &notify, const PlacedViews &in) {
    notify_camera(notify, in.views[0].name, in.camera);
    notify_framings(notify, in.views);
    for (std::size_t i = 0; i < in.files.size(); ++i) {
        notify_reading(notify, in.views[i].name, in.files[i].notes, in.files[i].warnings);
        notify_speckles(notify, in.views[i].name, in.files[i].speckles);
        notify_invalid_values(notify, in.views[i].name, in.files[i].bad);
    }
    notify_layers(notify, in.views[0].name, in.views[0].samples.channels);
}

std::size_t pixels_given(const ViewSamples &view) {
    std::size_t count = 0;
    const std::size_t alpha = view.alpha();
    for (std::size_t i = 0; i < view.windows.pixels(); ++i) count += alpha_at(view, alpha, i) > 0;
    return count;
}

// Counts what the views give to the warp, before the warp takes their pixels.
void count_given(std::span<const PackedView> views, MadeLdi &out) {
    out.views = views.size();
    out.all_pixels = views.size() * views[0].samples.windows.pixels();
    for (const PackedView &view : views) {
        const std::size_t pixels = pixels_given(view.samples);
        out.pixels_given += pixels;
        out.samples_given +=
            view.samples.deep() ? view.samples.count(0, std::size_t(view.samples.windows.height())) : pixels;
        out.empty_views += pixels == 0 ? 1 : 0;
    }
}

void warp_views(PlacedViews &in, const WarpOptions &by, const LdiFromViews &request, const WarpWork &work,
                MadeLdi &out) {
    const bool deep =
        std::ranges::any_of(in.views, [](const PackedView &view) { return view.samples.deep(); });
    const auto warp_by = [&](WarpDevice *device) {
        if (device && deep)
            work.notify(
                {NoticeKind::file_note, in.views[0].name, {std::string("deep views are warped by the CPU")}});
        WarpOptions with = by;
        with.device = device;
        const Timed warping(work.progress, "warp");
        out.ldi = warp(std::move(in.views), with, work.progress);
    };
    if (work.device)
        work.device->with(request.device, work.notify, work.progress, warp_by);
    else
        warp_by(nullptr);
}

MadeLdi made_of(PlacedViews in, const LdiFromViews &request, const WarpWork &work) {
    check_views(in.views); // before notices about views that do not fit together
    notify_views(work.notify, in);
    MadeLdi out;
    const OpenedFile &centre = in.files[0];
    out.header = centre.header;
    for (PackedView &view : in.views)
        if (request.colour)
            out.header = to_linear(work.notify, *request.colour, view.name, centre.header, view);
    const WarpOptions by = with_lens(request.warp, in.camera, in.views);
    take_denoised(request, by, in.views, work.notify);
    out.camera = in.camera;
    write_camera(out.header, out.camera);
    write_picture_window(out.header, in.views[0].samples.windows.data);
    const std::vector<std::string> warnings =
        view_warnings(in.views, {centre.depth, centre.depth_filtered, in.camera, centre.unpremultiplied});
    count_given(in.views, out);
    warp_views(in, by, request, work, out);
    notify_warnings(work.notify, warnings);
    work.notify(
        {.kind = NoticeKind::warped, .values = {out.views, out.ldi.samples(), out.ldi.windows.pixels()}});
    if (const auto lens = known_lens(out.camera, out.ldi.windows))
        notify_border_reach(work.notify, request.name, out.ldi, *lens, out.camera.supersample.value_or(1),
                            {});
    return out;
}

} // namespace

MadeLdi make_ldi(const LdiFromViews &request, const WarpWork &work) {
    return made_of(open_views(request), request, work);
}

MadeLdi make_ldi(std::span<const ViewInMemory> views, const LdiFromViews &request, const WarpWork &work) {
    return made_of(copies_of(views, request), request, work);
}

std::vector<DepthOptions> depths_of_pictures(const DepthOptions &depth, const std::vector<std::string> &files,
                                             std::size_t pictures) {
    if (!files.empty() && files.size() != pictures)
        throw UsageError(
            fmt::format("`depth_file`: there are {} of them for {} pictures; give one for each, in the "
                        "order of the pictures",
                        files.size(), pictures));
    std::vector<DepthOptions> each(pictures, depth);
    for (std::size_t i = 0; i < files.size(); ++i) each[i].picture.depth_file = files[i];
    return each;
}

namespace {

void require_one_camera(const OpenedLdi &first, const OpenedLdi &other) {
    if (other.ldi.windows.display != first.ldi.windows.display)
        throw Error(fmt::format("{}: its display window differs from that of {}; merge pictures of one size",
                                other.name, first.name));
    require_same_subpixels(first.camera, first.name, other.camera, other.name);
    const int width = first.ldi.windows.display_width();
    require_same_field(first.camera, first.name, other.camera, other.name, {width, width});
}

// The pictures, of which there must be at least one, with their samples merged by depth (deep/merge.h).
OpenedLdi merged(std::vector<OpenedLdi> parts) {
    OpenedLdi first = std::move(parts.front());
    if (parts.size() == 1) return first;
    std::vector<Ldi> ldis;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        require_one_camera(first, parts[i]);
        first.invisible += parts[i].invisible;
        ldis.push_back(std::move(parts[i].ldi));
    }
    ldis.insert(ldis.begin(), std::move(first.ldi));
    first.ldi = tidy(deep_merge(ldis));
    return first;
}

Camera camera_for(const OpenedLdi &in, const ClusterRequest &request) {
    Camera camera = camera_with_options(request.lens, in.camera);
    if (request.supersample) camera.supersample = request.supersample;
    return camera;
}

// The options for clustering. If no scale is known, inverse depth alone decides.
ClusterOptions options_for(const Camera &camera, const Windows &windows, const ClusterRequest &request,
                           bool &has_scale) {
    ClusterOptions by{.layers = request.layers};
    // `layers` alone needs no lens, because inverse depths are compared without a scale. A `tolerance` of 0 needs none
    // either.
    const double tolerance = request.tolerance.value_or(0.25);
    const bool must_know = tolerance > 0 && (request.tolerance || request.layers == 0);
    const auto scale = disparity_scale(camera, windows, must_know);
    has_scale = scale.has_value();
    if (!scale) return by;
    by.scale = *scale;
    by.tolerance = tolerance;
    return by;
}

ClusteredLdi clustered(const OpenedLdi &in, const Camera &camera, const ClusterRequest &request,
                       Progress &progress, const Notify &notify) {
    bool has_scale = false;
    const ClusterOptions by = options_for(camera, in.ldi.windows, request, has_scale);
    ClusteredLdi out{cluster(in.ldi, by, progress), in.header, camera, in.ldi.samples(), in.invisible};
    Notice done{NoticeKind::clustered_blindly, {}, {out.samples_read, out.ldi.samples()}};
    if (has_scale) {
        done.kind = NoticeKind::clustered;
        done.values.emplace_back(out.largest_error);
    }
    notify(done);
    write_camera(out.header, out.camera);
    return out;
}

ClusteredLdi merged_and_clustered(std::vector<OpenedLdi> parts, const ClusterRequest &request,
                                  Progress &progress, const Notify &notify) {
    for (OpenedLdi &part : parts) part.camera = camera_for(part, request);
    OpenedLdi in = merged(std::move(parts));
    if (request.beauty) recolor_by(*request.beauty, "recolor", nullptr, in, notify);
    recolor_by(request.recolor, request.depth.picture, request.colour, in, notify);
    return clustered(in, in.camera, request, progress, notify);
}

} // namespace

ClusteredLdi cluster_ldi(const ClusterRequest &request, Progress &progress, const Notify &notify) {
    const std::vector<DepthOptions> depths =
        depths_of_pictures(request.depth, request.depth_files, request.inputs.size());
    std::vector<OpenedLdi> parts;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        parts.push_back(open_ldi(request.inputs[i], {request.lens, depths[i]}));
        notify_samples(notify, parts.back());
    }
    return merged_and_clustered(std::move(parts), request, progress, notify);
}

ClusteredLdi cluster_ldi(std::span<const OpenedLdi *const> ldis, const ClusterRequest &request,
                         Progress &progress, const Notify &notify) {
    if (ldis.size() == 1 && !request.beauty) // a single LDI is not copied
        return clustered(*ldis[0], camera_for(*ldis[0], request), request, progress, notify);
    std::vector<OpenedLdi> parts;
    for (const OpenedLdi *ldi : ldis) parts.push_back(*ldi);
    return merged_and_clustered(std::move(parts), request, progress, notify);
}

} // namespace sparselens
