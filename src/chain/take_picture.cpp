#include "chain/take_picture.h"

#include "base/error.h"
#include "chain/channels.h"
#include "chain/devices.h"
#include "chain/parameters.h"
#include "deep/flatten.h"
#include "dof/border_reach.h"
#include "dof/false_colour.h"
#include "dof/gather_rows.h"
#include "dof/grain.h"
#include "io/camera/camera_header.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_header.h"
#include "io/photograph.h"
#include "lens/photograph.h"
#include "view/lens_views.h"
#include "view/resolve_lens.h"

#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

Ldi holdout_of(const PictureRequest &request, const OpenedLdi &in, const OpenedLdi &holdout) {
    require_same_field(in.camera, in.name, holdout.camera, holdout.name,
                       {in.ldi.windows.display_width(), holdout.ldi.windows.display_width()});
    return holdout_for(in, request.windows, holdout.ldi, holdout.name);
}

bool needs_gather(Show show) { return show == Show::picture || show == Show::tiles; }

// Takes the picture of `in`. Its samples may be used up if they are `own`.
class PictureTask {
public:
    PictureTask(const OpenedLdi &in, Ldi *own, const PictureRequest &request, const PictureWork &work)
        : in_(in), own_(own), request_(request), work_(work), by_(request.picture) {}

    TakenPicture picture(std::optional<GatherWindows> made_before = {}) {
        prepare(std::move(made_before));
        if (request_.front_depth)
            out_.depth = frame_.picture_of(crop(front_depth(ldi()), frame_.needed), depth_of_nothing);
        gather();
        write_picture_camera(out_.header, out_.camera);
        return std::move(out_);
    }

    TakenPicture without_values() {
        prepare({});
        Image bare(ldi().windows, {});
        bare.windows.data = frame_.needed;
        out_.image = frame_.picture_of(std::move(bare));
        out_.image.channels = channels_of_picture();
        write_picture_camera(out_.header, out_.camera);
        return std::move(out_);
    }

private:
    const Ldi &ldi() const { return frame_.ldi(in_); }

    void prepare(std::optional<GatherWindows> made_before) {
        if (needs_gather(request_.show)) require_channels(in_);
        out_.header = in_.header;
        out_.samples_read = in_.samples_read;
        out_.samples_invisible = in_.invisible;
        if (in_.depth == DepthMeaning::disparity && request_.any_quality)
            by_.gather.lens.quality = Quality::final;
        aim();
        hold_out();
        frame_ = made_before ? std::move(*made_before) : gather_windows(request_.windows, in_);
        lens_ = lens_in_gathered(request_.windows, in_, resolve_lens(out_.camera, in_.ldi.windows));
        choose_pixels();
        work_.progress.may_end();
    }

    // The channels of the picture of one pixel in which there is nothing.
    std::vector<Channel> channels_of_picture() {
        Ldi nothing;
        nothing.windows = windows_of_size(1, 1);
        nothing.channels = ldi().channels;
        nothing.values.resize(nothing.channels.size());
        nothing.begin.assign(2, 0);
        PictureOptions by = by_;
        by.holdout = nullptr;
        const Imath::Box2i &pixel = nothing.windows.data;
        Progress quiet;
        return chosen_channels(gather_picture(nothing, lens_, pixel, pixel, by, quiet), request_.channels)
            .channels;
    }

    void aim() {
        notify_camera(work_.notify, in_.name, in_.camera); // even if the lens is still incomplete
        out_.camera =
            picture_camera(request_, in_, [this](const Imath::V2i &at) { return front_depth(in_.ldi, at); });
        if (const auto &pixel = request_.focus_pixel)
            work_.notify({.kind = NoticeKind::focused,
                          .values = {*out_.camera.focus_distance, double(pixel->x), double(pixel->y)}});
        else if (in_.focus && !request_.lens.focus_distance) {
            const Imath::V2i &of_file = in_.focus->pixel;
            const Imath::V2i at = reduced({of_file, of_file}, subpixels_of(request_.windows, in_).across).min;
            work_.notify({NoticeKind::usual_focus, in_.name, {double(at.x), double(at.y)}});
        }
        out_.lens = picture_lens(request_, in_, out_.camera);
        if (out_.lens.radius > 0)
            work_.notify({.kind = NoticeKind::used_lens,
                          .values = {out_.lens.radius, out_.lens.focal_px, out_.lens.focus}});
        if (request_.grain && in_.depth != DepthMeaning::disparity)
            throw UsageError("`grain`: is for photographs, whose depth is a disparity (`disparity`)");
        const PhotographBlur blur = request_.blur.value_or(PhotographBlur());
        if (const double change = blur.in_pixels(in_.ldi.windows.display_width()) * in_.flicker;
            change > 0.5) // pixels: it is seen
            work_.notify({NoticeKind::flicker, in_.name, {change}});
        if (sees_past_views(out_.camera, out_.lens))
            work_.notify({.kind = NoticeKind::wide_lens, .parameter = "fstop"});
    }

    void hold_out() {
        if (const OpenedLdi *opened = request_.opened_holdout)
            holdout_ = holdout_of(request_, in_, *opened);
        else if (!request_.holdout.empty())
            holdout_ = open_holdout(request_, in_);
        if (holdout_) by_.holdout = &*holdout_;
    }

    void choose_pixels() {
        LooksReader own_reader;
        const LensFile given =
            (work_.looks ? *work_.looks : own_reader).read(request_.looks, out_.camera.fstop);
        LensLooks &looks = by_.gather.lens.looks;
        if (request_.picture.method->by_lens_points)
            looks = picture_looks(given, out_.camera, out_.header, lens_, ldi().windows);
        else if (shape_aperture(out_.camera.looks))
            work_.notify({.kind = NoticeKind::round_aperture,
                          .values = {request_.picture.method->name},
                          .parameter = "method"});
        const auto *packed = std::get_if<PackedRows>(&in_.held);
        const auto border = packed ? std::optional(border_of(*packed)) : std::nullopt;
        notify_border_reach(work_.notify, in_.name, border ? *border : ldi(), lens_, frame_.subpixels.across,
                            looks);
        choose_windows(frame_, request_.windows, in_, lens_, looks);
        raise_highlights(frame_, in_, highlight_gain(given.values));
    }

    void gather() {
        by_.gather.lens.chosen = &out_.tiles;
        by_.gather.lens.across = frame_.subpixels.across;
        by_.gather.views_radius = views_radius(out_.camera);
        const bool shows_pixels = request_.show == Show::picture && request_.windows.proxy == 1;
        by_.gather.lens.watch = shows_pixels && frame_.subpixels.across == 1 ? work_.watch : nullptr;
        if (in_.reduced() && merges_by_rows(in_.ldi.channels)) by_.layer_tolerance = 0; // already merged
        const auto gather_by = [&](TileDevice *device) {
            by_.gather.lens.device = device;
            if (!needs_gather(request_.show)) return;
            Image all = frame_.picture_of(with_grain());
            for (const std::string &warning : lost_matte_warnings(all))
                work_.notify({NoticeKind::file_warning, in_.name, {warning}});
            out_.image = chosen_channels(std::move(all), request_.channels);
        };
        if (work_.device)
            work_.device->with(request_.device, work_.notify, work_.progress, gather_by);
        else
            gather_by(nullptr);
        if (request_.show != Show::picture) out_.image = frame_.picture_of(crop(shown(), frame_.needed));
    }

    Image with_grain() {
        const double strength = in_.depth == DepthMeaning::disparity ? request_.grain.value_or(1) : 0;
        const bool blurs = request_.show == Show::picture && request_.picture.method->by_lens_points;
        const int bits = extras_of(in_.header).value_or(ShownExtras{.bits = 0}).bits;
        const Grain grain = strength > 0 && blurs && lens_.radius > 0 ? measure_grain(ldi(), bits) : Grain();
        if (grain.none()) return gathered();
        if (!frame_.changed && own_) frame_.changed = std::move(*own_); // `own_ ? move : in_.ldi` would copy
        if (!frame_.changed) frame_.changed = in_.ldi;
        add_kept_share(*frame_.changed, lens_);
        Image picture = gathered();
        add_grain(grain, float(strength), std::uint32_t(work_.frame), out_.tiles, frame_.gathered, picture);
        return picture;
    }

    Image gathered() {
        const auto of = [&](auto &&ldi) {
            return gather_picture(std::forward<decltype(ldi)>(ldi), lens_, frame_.gathered, frame_.needed,
                                  by_, work_.progress);
        };
        if (const auto *packed = std::get_if<PackedRows>(&in_.held))
            return gather_rows(*packed, lens_, frame_.gathered, frame_.needed, by_,
                               {memory_to_gather(in_.samples_read, in_.ldi.windows.pixels())},
                               work_.progress);
        if (request_.show != Show::picture) return of(ldi());
        if (frame_.changed) return of(std::move(*frame_.changed));
        return own_ ? of(std::move(*own_)) : of(in_.ldi);
    }

    Image shown() const {
        ThinLens lens = lens_;
        lens.focal_px /= frame_.subpixels.across; // circles of confusion are in pixels of the picture
        if (request_.show != Show::tiles) return false_colours(request_.show, ldi(), lens);
        const Windows windows{ldi().windows.display, frame_.gathered, ldi().windows.pixel_aspect};
        LensTiles tiles = out_.tiles;
        if (tiles.lens_points.empty()) tiles = {std::max(windows.width(), windows.height()), 1, 1, {0}};
        return tile_colours(tiles, windows);
    }

    const OpenedLdi &in_;
    Ldi *own_;
    const PictureRequest &request_;
    const PictureWork &work_;
    PictureOptions by_;
    std::optional<Ldi> holdout_;
    GatherWindows frame_;
    ThinLens lens_; // for the pixels that are gathered
    TakenPicture out_;
};

// How samples are reduced while the file is read; empty if more than the picture is made from them.
ChooseSamples choose_samples(const PictureRequest &request, bool keep, const PictureWork &work) {
    if (keep || request.show != Show::picture || request.front_depth || !request.holdout.empty() ||
        request.opened_holdout || request.picture.holdout || request.focus_pixel || !request.recolor.empty())
        return {};
    return [&request, &work](const Imf::Header &header, const Camera &camera,
                             const Ldi &rows) -> ReduceSamples {
        const LookValues values = work.looks->read(request.looks, camera.fstop).values;
        if (!keeps_pixels(request.windows, header, camera) || highlight_gain(values).gain != 1 ||
            !is_linear(work.notify, request.colour, request.input, header))
            return {};
        const ThinLens lens = resolve_lens(camera, rows.windows);
        if (!can_reduce_first(request.picture, lens, values.breathing || camera.looks.breathing,
                              rows.channels))
            return {};
        return [&request, lens](Ldi some) { return reduced_first(std::move(some), lens, request.picture); };
    };
}

// Gives the camera of a photograph the lens that has the blur of the request.
void set_blur(Camera &camera, const PictureRequest &request, const OpenedLdi &in) {
    if (in.depth != DepthMeaning::disparity)
        throw UsageError(
            "`blur`: is for depths that are a disparity (`disparity`); for others, give the lens by "
            "`fstop` or `lens_radius`");
    const LensValues &lens = request.lens;
    if (lens.fstop || lens.lens_radius || lens.focal_length_mm || lens.sensor_width_mm)
        throw UsageError(in.name +
                         ": is a photograph, which needs no lens: give the largest radius of its blur in "
                         "place of a lens (`blur=2%`)");
    if (!camera.focus_distance && !request.focus_pixel && in.focus) camera.focus_distance = in.focus->depth;
    const double blur = request.blur.value_or(PhotographBlur()).in_pixels(in.ldi.windows.display_width());
    camera.lens_radius = radius_of_blur(blur, resolve_focal_px(camera, in.ldi.windows));
}

} // namespace

Image false_colours(Show show, const Ldi &ldi, const ThinLens &lens) {
    if (show == Show::coc) return coc_colours(ldi, lens);
    return show == Show::focus ? focus_colours(ldi, lens) : layer_colours(ldi);
}

void check_method(const PictureRequest &request,
                  const std::function<bool(const std::string &parameter)> &is_given) {
    const GatherMethod &method = *request.picture.method;
    for (const Parameter *row : picture_parameters())
        if (*row->method != '\0' && row->method != std::string_view(method.name) &&
            is_given(keyword_of(row->name)))
            throw UsageError(
                fmt::format("`{}`: works with `method={}` only", keyword_of(row->name), row->method));
    if (request.device != "cpu" && request.device != "auto" && !method.on_devices)
        throw UsageError(
            fmt::format("`device={}`: works with `method=lens` and `method=selective` only", request.device));
    if (request.show == Show::tiles && !method.by_lens_points)
        throw UsageError("`show=tiles`: works with `method=lens` only");
}

Camera picture_camera(const PictureRequest &request, const OpenedLdi &in,
                      const std::function<float(const Imath::V2i &)> &depth_of) {
    Camera camera = camera_with_options(request.lens, in.camera);
    if (request.blur || in.depth == DepthMeaning::disparity) set_blur(camera, request, in);
    if (!request.focus_pixel) return camera;
    const int across = subpixels_of(request.windows, in).across;
    require_inside(*request.focus_pixel, in, across);
    const float z = depth_of(middle_subpixel(*request.focus_pixel, across));
    if (!(z > 0))
        throw UsageError(
            fmt::format("`focus_pixel`: {} has no sample at ({}, {}); choose a pixel that shows something",
                        in.name, request.focus_pixel->x, request.focus_pixel->y));
    camera.focus_distance = double(z);
    return camera;
}

ThinLens picture_lens(const PictureRequest &request, const OpenedLdi &in, const Camera &camera) {
    ThinLens lens = resolve_lens(camera, in.ldi.windows);
    lens.focal_px /= subpixels_of(request.windows, in).across;
    return lens;
}

Ldi open_holdout(const PictureRequest &request, const OpenedLdi &in) {
    if (has_shown_ending(request.holdout))
        throw UsageError("`holdout`: " + request.holdout + " is not an EXR file");
    OpenOptions by{request.lens, request.depth};
    by.depth.picture.depth_file.clear(); // belongs to the picture
    return holdout_of(request, in, open_ldi(request.holdout, by));
}

TakenPicture take_picture(const OpenedLdi &in, const PictureRequest &request, const PictureWork &work) {
    if (request.channels.empty()) return PictureTask(in, nullptr, request, work).picture();
    OpenedLdi fewer = in;
    return take_picture(std::move(fewer), request, work);
}

TakenPicture take_picture(OpenedLdi &&in, const PictureRequest &request, const PictureWork &work) {
    keep_channels(in.ldi, request.channels);
    return PictureTask(in, &in.ldi, request, work).picture();
}

TakenPicture take_picture(const OpenedLdi &in, GatherWindows made_before, const PictureRequest &request,
                          const PictureWork &work) {
    return PictureTask(in, nullptr, request, work).picture(std::move(made_before));
}

TakenPicture take_picture(LdiCache &cache, bool keep, const PictureRequest &request,
                          const PictureWork &work) {
    LooksReader looks;
    PictureWork with = work;
    if (!with.looks) with.looks = &looks;
    const auto read = [&]() -> OpenedLdi & {
        const Timed reading(work.progress, "read");
        return cache.load(request, work.notify, choose_samples(request, keep, with));
    };
    OpenedLdi &in = read();
    const Timed taking(work.progress, "picture");
    return PictureTask(in, keep ? nullptr : &in.ldi, request, with).picture();
}

TakenPicture describe_picture(LdiCache &cache, const PictureRequest &request, const PictureWork &work) {
    if (request.show != Show::picture) return take_picture(cache, true, request, work);
    return PictureTask(cache.load(request, work.notify), nullptr, request, work).without_values();
}

LensFile LooksReader::read(const GivenLooks &given, std::optional<double> fstop) {
    LensFile looks = said_.get({given.lens_file, given.aperture_file, fstop}, [&](const auto &) {
        return read_looks({{}, given.lens_file, given.aperture_file}, fstop);
    });
    looks.values = look_values_over(given.values, looks.values);
    return looks;
}

LensLooks picture_looks(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows) {
    camera.looks = look_values_over(given.values, camera.looks);
    if (!given.name.empty()) set_attribute(header, "lensModel", Imf::StringAttribute(given.name));
    return resolve_looks(camera.looks, camera, lens, windows);
}

bool shape_aperture(const LookValues &looks) {
    return looks.blades.value_or(0) != 0 || looks.squeeze.value_or(1) != 1;
}

} // namespace sparselens
