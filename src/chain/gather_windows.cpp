#include "chain/gather_windows.h"

#include "base/error.h"
#include "chain/channels.h"
#include "chain/notices.h"
#include "deep/checks/view_warnings.h"
#include "deep/flatten.h"
#include "deep/proxy.h"
#include "dof/lens/lens_gather.h"
#include "io/camera/camera_header.h"
#include "io/files/memory_limit.h"
#include "kernels/warp_rules.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

Imath::Box2i common(const Imath::Box2i &a, const Imath::Box2i &b, const char *what) {
    const Imath::Box2i box = common_box(a, b);
    if (box.isEmpty()) throw UsageError(fmt::format("{} contains no pixel of the picture", what));
    return box;
}

// Whether `data` contains the whole window.
bool holds(const Imath::Box2i &data, const Imath::Box2i &window) {
    return data.intersects(window.min) && data.intersects(window.max);
}

// The bytes taken by the samples of a picture, and by the index of its pixels.
double bytes_of(const Ldi &ldi) {
    std::size_t floats = ldi.values.size() * ldi.samples();
    for (const auto *of : {&ldi.z, &ldi.z_back, &ldi.dx, &ldi.dy, &ldi.weight, &ldi.image_z, &ldi.solid})
        floats += of->size();
    return double(floats * sizeof(float)) + double(ldi.begin.size() * sizeof(ldi.begin[0]));
}

// Checks the memory for `copies` of the LDI in total.
void check_copies(const std::string &name, const Ldi &ldi, int copies) {
    check_memory(name, copies * bytes_of(ldi), std::uint64_t(bytes_of(ldi)));
}

// A few near samples in a huge display window may require a picture of gigabytes.
void check_growth(const OpenedLdi &in, const Ldi &ldi, const Imath::Box2i &window) {
    const double pixels =
        (double(window.max.x) - window.min.x + 1) * (double(window.max.y) - window.min.y + 1);
    const std::size_t channels = ldi.channels.size() * sizeof(float), offset = sizeof(ldi.begin[0]);
    try {
        check_memory(in.name, pixels * double(channels + offset),
                     ldi.samples() * channels + ldi.windows.pixels() * offset);
    } catch (const Error &e) {
        throw Error(fmt::format("{}; `overscan=keep` cuts the blur off at the data window", e.what()));
    }
}

// `box`, extended inside the display window to whole blocks of so many pixels, counted from the window's corner.
Imath::Box2i whole_blocks(Imath::Box2i box, const Imath::Box2i &display, int size) {
    const Imath::Box2i inside = common_box(box, display);
    if (inside.isEmpty()) return box;
    for (const int axis : {0, 1}) {
        const int corner = display.min[axis];
        const auto begin_of = [&](int pixel) { return corner + (pixel - corner) / size * size; };
        box.min[axis] = std::min(box.min[axis], begin_of(inside.min[axis]));
        box.max[axis] =
            std::max(box.max[axis], std::min(display.max[axis], begin_of(inside.max[axis]) + size - 1));
    }
    return box;
}

// The gathered pixels, and as many more as the blur reaches inside the display window, in whole blocks of sub-pixels.
Imath::Box2i with_blur(const GatherWindows &frame, const Ldi &ldi, const ThinLens &lens,
                       const LensLooks &looks) {
    const Imath::Box2i &display = ldi.windows.display;
    Imath::Box2i box = frame.gathered;
    if (lens.radius > 0 && !holds(box, display)) box.extendBy(reached_display(ldi, lens, looks));
    return whole_blocks(box, display, frame.subpixels.across);
}

// Gathers whole tiles, and adds the pixels to the LDI that it lacks. A pixel then lies in the same tile, and a lamp in the
// same cell, wherever the data window begins.
void gather_whole_tiles(GatherWindows &frame, const OpenedLdi &in) {
    const Ldi &ldi = frame.ldi(in);
    frame.gathered = whole_blocks(frame.gathered, ldi.windows.display, lens_tile_size);
    if (holds(ldi.windows.data, frame.gathered)) return;
    check_growth(in, ldi, frame.gathered);
    frame.changed = padded(ldi, frame.gathered);
}

// How many pixels of the LDI, across and down, become one gathered pixel: more than 1 for previews.
int smaller_by(const WindowOptions &options, int across) {
    return options.proxy > 1 || options.joins_subpixels ? options.proxy * across : 1;
}

// Checks the pixels for which the LDI was warped, because the warp looks for images in steps of the picture's pixels.
void check_warped_for(int across, int said, const OpenedLdi &in) {
    if (in.camera.lens_points.size() < 2 || kernels::motion_unit(across) <= kernels::motion_unit(said))
        return;
    throw UsageError(
        fmt::format("{}: it was warped for pixels of {} x {}, not of {} x {}: give `supersample` {} where "
                    "its views are warped",
                    in.name, said, said, across, across, across));
}

// Needs all gathered pixels, for all pixels of the picture in its display window that show any of them.
void need_all(GatherWindows &frame, const Imath::Box2i &display) {
    frame.needed = frame.gathered;
    frame.picture = reduced(frame.gathered, frame.subpixels.across);
    const Imath::Box2i more =
        common_box(reduced(display, frame.subpixels.across), pixels_reached(frame.gathered, frame.subpixels));
    if (!more.isEmpty()) frame.picture.extendBy(more);
}

} // namespace

Subpixels subpixels_of(const WindowOptions &options, const OpenedLdi &in) {
    const int said = in.camera.supersample.value_or(1);
    const Subpixels by{options.supersample.value_or(said),
                       options.filter.value_or(in.camera.pixel_filter.value_or(PixelFilter{}))};
    const Imath::Box2i &display = in.ldi.windows.display;
    if (subpixels_in(reduced(display, by.across), by.across) != display)
        throw UsageError(fmt::format(
            "{}: its display window cannot be divided into pixels of {} x {}: give another `supersample`",
            in.name, by.across, by.across));
    check_warped_for(by.across, said, in);
    return by;
}

Image GatherWindows::picture_of(Image needed_pixels, float nothing) const {
    if (subpixels.across == 1) return needed_pixels;
    return mean_of_subpixels(needed_pixels, subpixels, picture, nothing);
}

void require_inside(const Imath::V2i &focus_pixel, const OpenedLdi &in, int across) {
    const Imath::Box2i inside = reduced(in.ldi.windows.data, across);
    if (inside.intersects(focus_pixel)) return;
    throw UsageError(fmt::format(
        "`focus_pixel`: {},{} lies outside of {}, whose pixels go from {},{} to {},{}", focus_pixel.x,
        focus_pixel.y, in.name, inside.min.x, inside.min.y, inside.max.x, inside.max.y));
}

void require_channels(const OpenedLdi &in) {
    if (in.ldi.channels.empty())
        throw Error(in.name +
                    ": has depth but no colours, so there is nothing to gather; give the picture, and "
                    "its depth by `depth_file` where that is in a file of its own");
}

bool keeps_pixels(const WindowOptions &options, const Imf::Header &header, const Camera &camera) {
    return smaller_by(options, options.supersample.value_or(camera.supersample.value_or(1))) == 1 &&
           (options.overscan != OutputOverscan::grow || holds(header.dataWindow(), header.displayWindow()));
}

ThinLens lens_in_gathered(const WindowOptions &options, const OpenedLdi &in, ThinLens lens) {
    lens.focal_px /= smaller_by(options, subpixels_of(options, in).across);
    return lens;
}

GatherWindows gather_windows(const WindowOptions &options, const OpenedLdi &in) {
    const Subpixels by = subpixels_of(options, in);
    const int smaller = smaller_by(options, by.across);
    GatherWindows frame{reduced(read_picture_window(in.header), smaller), {}, {}, {}, {}};
    if (smaller > 1)
        frame.changed = proxy(in.ldi, smaller);
    else
        frame.subpixels = by;
    need_all(frame, frame.ldi(in).windows.display);
    return frame;
}

void choose_windows(GatherWindows &frame, const WindowOptions &options, const OpenedLdi &in,
                    const ThinLens &lens, const LensLooks &looks) {
    const bool grows = options.overscan == OutputOverscan::grow;
    if (grows) frame.gathered = with_blur(frame, frame.ldi(in), lens, looks);
    need_all(frame, frame.ldi(in).windows.display);
    if (grows) gather_whole_tiles(frame, in);
    if (options.overscan == OutputOverscan::crop)
        frame.picture = common(frame.picture, reduced(frame.ldi(in).windows.display, frame.subpixels.across),
                               "`overscan=crop`: the display window");
    if (options.region)
        frame.picture = common(frame.picture, reduced(*options.region, options.proxy), "`region`");
    const Imath::Box2i under = subpixels_under(frame.picture, frame.subpixels);
    frame.needed = common(frame.gathered, under, "the picture");
}

Ldi holdout_for(const OpenedLdi &in, const WindowOptions &options, const Ldi &holdout,
                const std::string &name) {
    const Subpixels by = subpixels_of(options, in);
    const Imath::Box2i &display = in.ldi.windows.display;
    const bool coarse = holdout.windows.display != display;
    if (coarse && holdout.windows.display != reduced(display, by.across))
        throw Error(name + ": its display window differs from that of the picture it holds out; use a "
                           "holdout of the same size");
    const int smaller = smaller_by(options, by.across);
    if (smaller > 1) return proxy(holdout, coarse ? options.proxy : smaller);
    if (!coarse) return holdout;
    check_copies(name, holdout, 1 + by.across * by.across);
    return enlarged(holdout, by.across);
}

void raise_highlights(GatherWindows &frame, const OpenedLdi &in, const HighlightGain &by) {
    if (by.gain == 1) return;
    if (!frame.changed) {
        check_copies(in.name, in.ldi, 2);
        frame.changed = in.ldi;
    }
    raise_highlights(*frame.changed, by);
}

namespace {

std::vector<std::string> keep_and_notify(Ldi &ldi, const std::string &channels) {
    const std::vector<Channel> before = ldi.channels;
    keep_channels(ldi, channels);
    std::vector<std::string> left_out;
    for (const Channel &channel : before)
        if (find_channel(ldi.channels, channel.name) == npos) left_out.push_back(channel.name);
    return left_out;
}

// Checks flat renders only. Deep pictures are made by programs that write them correctly, and photographs have soft
// edges and an estimated depth.
void check_flat_picture(const Notify &notify, const OpenedLdi &in) {
    if (in.deep || in.depth == DepthMeaning::disparity) return;
    notify_warnings(notify, picture_warnings(front_view(in.ldi, in.name),
                                             {in.depth, in.depth_filtered, in.camera, in.unpremultiplied}));
}

} // namespace

OpenedLdi &LdiCache::load(const LdiRequest &request, const Notify &notify, const ChooseSamples &choose) {
    const std::string &path = request.input, &recolor = request.recolor;
    const LensValues &lens = request.lens;
    const ColourOptions &colour = request.colour;
    // An LDI whose samples were used up does not even have empty pixels.
    kept_.drop_if([](const Key &, const OpenedLdi &in) { return in.reduced() || in.ldi.begin.empty(); });
    read_now_ = false;
    const auto read = [&](const Key &) {
        read_now_ = true;
        notify({NoticeKind::reading, path});
        OpenedLdi opened = open_ldi(path, {lens, request.depth, {}, disparities_}, choose);
        if (of_sequence_) {
            disparities_ = opened.disparities;
            if (!focus_) focus_ = opened.focus;
            opened.focus = focus_;
        }
        notify_samples(notify, opened);
        recolor_by(recolor, request.depth.picture, colour, opened, notify);
        if (recolor.empty()) opened.header = to_linear(notify, colour, path, opened.header, opened.ldi);
        check_flat_picture(notify, opened);
        if (opened.depth == DepthMeaning::disparity)
            opened.flicker = flicker_.since_last(front_view(opened.ldi, opened.name));
        channels_left_out_ = keep_and_notify(opened.ldi, request.channels);
        if (auto *packed = std::get_if<PackedRows>(&opened.held)) packed->keep_channels(opened.ldi.channels);
        return opened;
    };
    OpenedLdi &opened = kept_.get({path, recolor, request.channels, request.depth, lens.focal_length_mm,
                                   lens.sensor_width_mm, colour.config, colour.input_space},
                                  read);
    if (opened.depth != DepthMeaning::disparity) opened.camera = read_camera(opened.header);
    return opened;
}

} // namespace sparselens
