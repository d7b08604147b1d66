#include "warp/warp.h"

#include "base/matte.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "view/resolve_lens.h"
#include "warp/coverage.h"
#include "warp/extend_surfaces.h"
#include "warp/images/image_depths.h"
#include "warp/lamps/lamp_light.h"
#include "warp/photo_consistency.h"
#include "warp/surfaces.h"
#include "warp/tuning.h"
#include "warp/warp_device.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

class Warper {
public:
    Warper(std::vector<PackedView> views, const WarpOptions &options);
    Ldi run(Progress &progress); // once

private:
    void grow_window();
    using Marks = std::vector<Disagreement>; // one per block of image_depths.h
    // `rows`: memory that a band leaves to the next one.
    Ldi warp_band(int first_row, int last_row, Marks &differ, ReprojectedRows &rows) const;
    WarpedViews warp_by_bands(Progress &progress) const;
    std::optional<WarpedViews> warp_on_device() const;
    std::vector<PlacedView> placed() const;
    void emit(const Surface &surface, bool agree, Ldi &out) const;

    bool averages() const { return options_.merge == Merge::average; }

    WarpOptions options_;
    double scale_;                    // R F: disparity is scale / z
    double tolerance_;                // of 1 / z, within one surface
    std::optional<ThinLens> focused_; // if the focus is known
    ReprojectedViews views_;
    Ldi layout_; // windows and channels of the result
    std::vector<Matte> mattes_;
    SurfaceMeans means_;
};

Warper::Warper(std::vector<PackedView> views, const WarpOptions &options)
    : options_(options), scale_(disparity_scale(options.radius, options.focal_px)),
      tolerance_(scale_ > 0 ? inverse_depth_step(scale_, options.surface_px)
                            : std::numeric_limits<double>::infinity()),
      views_(std::move(views), options.focal_px, scale_,
             averages() && options.split_silhouettes ? options.surface_px : 0),
      mattes_(find_mattes(views_.samples(0).channels)), means_(views_, tolerance_, mattes_) {
    if (options.focus)
        focused_ = ThinLens{.radius = options.radius, .focal_px = options.focal_px, .focus = *options.focus};
    layout_.windows = views_.samples(0).windows;
    layout_.channels = views_.samples(0).channels;
    layout_.values.resize(layout_.channels.size());
    if (averages()) grow_window();
}

void Warper::grow_window() {
    const Imath::Box2i centre = layout_.windows.data;
    Imath::Box2i &data = layout_.windows.data;
    for (std::size_t v = 0; v < views_.size(); ++v) data.extendBy(views_.reprojection(v).reach());
    for (int axis = 0; axis < 2; ++axis) {
        data.min[axis] = std::max(data.min[axis], centre.min[axis] - WarpTuning::most_overscan);
        data.max[axis] = std::min(data.max[axis], centre.max[axis] + WarpTuning::most_overscan);
    }
}

void Warper::emit(const Surface &surface, bool agree, Ldi &out) const {
    if (!averages() || (!agree && surface.seen_by_centre()))
        means_.append_nearest(surface, out);
    else if (means_.is_of_parts(surface))
        means_.append_of_parts(surface, out);
    else if (surface.seen_by_centre() && surface.samples.size() > 1 &&
             some_view_is_missing(views_, surface.samples))
        means_.append_of_pixels(balanced(surface.samples), out);
    else
        means_.append_of_pixels(surface.samples, out);
}

Ldi Warper::warp_band(int first_row, int last_row, Marks &differ, ReprojectedRows &rows) const {
    rows = views_.place(layout_.windows.data, first_row, last_row, std::move(rows));
    const Surfaces surfaces = find_surfaces(views_, tolerance_, rows);
    const Grid pixels(
        Imath::Box2i({layout_.windows.data.min.x, first_row}, {layout_.windows.data.max.x, last_row}));
    std::vector<bool> agree(rows.pixels(), true);
    if (averages() && options_.test_photo_consistency) {
        PhotoConsistency found = find_photo_consistency(views_, {focused_, scale_, options_.across},
                                                        layout_.windows.data, surfaces);
        agree = std::move(found.averages);
        const Tiles blocks(layout_.windows.data, image_block);
        for (std::size_t pixel = 0; pixel < rows.pixels(); ++pixel)
            differ[blocks.tile_of(pixels.pixel(pixel))] = found.differ[pixel];
    }
    Ldi out = empty_like(layout_);
    out.begin.reserve(rows.pixels() + 1);
    for (std::vector<float> *array : {&out.z, &out.dx, &out.dy, &out.weight})
        array->reserve(surfaces.list.size());
    if (means_.volumes()) out.z_back.reserve(surfaces.list.size());
    for (std::vector<float> &values : out.values) values.reserve(surfaces.list.size());
    out.begin.push_back(0);
    for (std::size_t pixel = 0; pixel < rows.pixels(); ++pixel) {
        out.begin.push_back(out.begin.back());
        for (const Surface &surface : surfaces.pixel(pixel)) emit(surface, agree[pixel], out);
        if (surfaces.pixel(pixel).empty()) means_.append_beyond(pixels.pixel(pixel), out);
    }
    return out;
}

std::optional<WarpedViews> Warper::warp_on_device() const {
    static_assert(kernels::photo_block == image_block);
    if (!options_.device || views_.some_are_deep()) return {};
    const WarpScene scene{.views = views_,
                          .layout = layout_,
                          .averages = averages(),
                          .tests_photo_consistency = averages() && options_.test_photo_consistency,
                          .tolerance = tolerance_,
                          .scale = scale_,
                          .focus = focused_,
                          .across = options_.across};
    return options_.device->warp(scene);
}

// Reserves room that nearly always holds all samples. It uses no memory before it is written to.
Ldi without_pixels(const Ldi &layout) {
    const std::size_t pixels = layout.windows.pixels(), samples = pixels + pixels / 4;
    Ldi ldi = empty_like(layout);
    ldi.begin.reserve(pixels + 1);
    ldi.begin.push_back(0);
    for (std::vector<float> *array : {&ldi.z, &ldi.dx, &ldi.dy, &ldi.weight}) array->reserve(samples);
    for (std::vector<float> &values : ldi.values) values.reserve(samples);
    return ldi;
}

std::vector<PlacedView> Warper::placed() const {
    std::vector<PlacedView> views;
    for (std::size_t v = 0; v < views_.size(); ++v)
        views.push_back({&views_.samples(v), &views_.reprojection(v).mapping()});
    return views;
}

WarpedViews Warper::warp_by_bands(Progress &progress) const {
    constexpr int rows_at_once = 16;
    static_assert(rows_at_once % image_block == 0);
    const Tiles bands(layout_.windows.data, layout_.windows.width(), rows_at_once);
    WarpedViews made{without_pixels(layout_), Marks(Tiles(layout_.windows.data, image_block).count())};
    tbb::enumerable_thread_specific<ReprojectedRows> memory;
    in_order(
        bands.count(),
        [&](std::size_t band) {
            const Imath::Box2i rows = bands.box(band);
            return warp_band(rows.min.y, rows.max.y, made.differ, memory.local());
        },
        [&](std::size_t n, const Ldi &band) {
            append_pixels(made.ldi, band);
            progress.advance(std::size_t(bands.box(n).size().y + 1));
        });
    return made;
}

Ldi Warper::run(Progress &progress) {
    const auto height = std::size_t(layout_.windows.height());
    progress.start("warping", height);
    std::optional<WarpedViews> on_device = warp_on_device();
    if (on_device) progress.advance(height);
    WarpedViews made = on_device ? std::move(*on_device) : warp_by_bands(progress);
    Ldi ldi = std::move(made.ldi);
    keep_opaque(views_, tolerance_, ldi);
    if (views_.size() < 2 || !(scale_ > 0)) return ldi;
    if (options_.find_images) show_images(placed(), scale_, options_.across, made.differ, ldi);
    if (averages()) keep_light_of_lamps(placed(), scale_, options_.surface_px, ldi);
    Sights sights(views_, scale_);
    give_back_memory(); // that the views had
    find_solids(sights, ldi);
    if (averages() && options_.extend_surfaces) extend_surfaces(std::move(sights), ldi);
    return ldi;
}

template <typename Views>
WarpOptions with_lens(WarpOptions options, const Camera &camera, const Views &views, const Windows &windows) {
    options.focus = camera.focus_distance;
    options.across = camera.supersample.value_or(1);
    if (views.size() == 1) return options;
    options.focal_px = resolve_focal_px(camera, windows);
    options.radius = lens_radius_of(camera).value_or(0);
    for (const auto &view : views) options.radius = std::max(options.radius, view.position.length());
    return options;
}

} // namespace

WarpOptions with_lens(WarpOptions options, const Camera &camera, std::span<const View> views) {
    return with_lens(options, camera, views, views[0].image.windows);
}

WarpOptions with_lens(WarpOptions options, const Camera &camera, const std::vector<PackedView> &views) {
    return with_lens(options, camera, views, views[0].samples.windows);
}

Ldi warp(std::span<const View> views, const WarpOptions &options, Progress &progress) {
    return warp(referring_to(views), options, progress);
}

Ldi warp(std::vector<View> &&views, const WarpOptions &options, Progress &progress) {
    return warp(packed(std::move(views)), options, progress);
}

Ldi warp(std::vector<PackedView> &&views, const WarpOptions &options, Progress &progress) {
    return Warper(std::move(views), options).run(progress);
}

} // namespace sparselens
