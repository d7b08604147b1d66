#include "viewing/shot.h"

#include "base/error.h"
#include "harness/process.h"
#include "chain/channels.h"
#include "chain/picture_looks.h"
#include "loading/holdout_file.h"
#include "loading/ldi_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace sparselens {

namespace {

// The first of several is the one that a page uses; the others were tried on the way to it.
constexpr std::size_t most_small = 2;

// What is shown of it.
bool is_rgba(const Channel &channel) {
    return channel.name == "R" || channel.name == "G" || channel.name == "B" || channel.name == "A";
}
Image rgba_of(Image image) {
    if (std::ranges::all_of(image.channels, is_rgba)) return image;
    std::vector<Channel> channels;
    std::ranges::copy_if(image.channels, std::back_inserter(channels), is_rgba);
    Image out(image.windows, channels);
    for (std::size_t k = 0; k < channels.size(); ++k)
        std::ranges::copy(image.plane(find_channel(image.channels, channels[k].name)), out.plane(k).begin());
    return out;
}

// What a file is read as: the focal length of its frame makes the lengths of rays planar.
std::string name_of(const GatherCommand &options) {
    if (options.depth.meaning != DepthMeaning::distance) return options.input;
    return fmt::format("{}:{}:{}", options.input, options.lens.focal_length_mm.value_or(0),
                       options.lens.sensor_width_mm.value_or(0));
}

std::vector<std::string> names_of(const std::vector<GatherCommand> &frames) {
    std::vector<std::string> names;
    for (const GatherCommand &frame : frames) names.push_back(name_of(frame));
    return names;
}

// By the options of the first frame of that name.
Reel::Read reader_of(const std::vector<GatherCommand> &frames, const ToolContext &tool) {
    return [frames, &tool](const std::string &name) {
        const GatherCommand &options = *std::ranges::find(frames, name, name_of);
        LdiCache cache;
        OpenedLdi &in = cache.load({options.input, options.recolor}, options.channels,
                                   {options.lens, options.depth}, options.colour, tool);
        return shot_frame(std::move(in), options.windows, options.colour);
    };
}

// The last one that is alike, else the result of `make`, which takes the place of the oldest of a few. Those of frames that have
// been let go are let go.
template <typename Kept, typename Alike, typename Make>
const Kept &last_few(std::deque<Kept> &kept, const Alike &alike, const Make &make) {
    std::erase_if(kept, [](const Kept &one) { return one.of.expired(); });
    if (const auto found = std::ranges::find_if(kept, alike); found != kept.end()) return *found;
    if (kept.size() >= most_small) kept.pop_front();
    return kept.emplace_back(make());
}

// Of the method that knows any; what another leaves out is warned of.
LensLooks looks_through(const LensFile &given, const GatherMethod &method, Subject &from, TakenPicture &out) {
    if (&method == &gather_methods().front())
        return picture_looks(given, out.camera, from.in.header, from.lens, from.ldi().windows);
    if (const auto warning = warning_of_round_aperture(out.camera.looks, method.name))
        out.warnings.push_back(*warning);
    return {};
}

// The samples are used up.
Image gathered(Subject &from, const PictureOptions &by, Progress &progress) {
    return gather_picture(std::move(from.ldi()), from.lens, from.windows.gathered, from.windows.needed, by,
                          progress);
}

Image false_colours(Show show, Subject &from, PictureOptions by, Progress &progress) {
    const Ldi &ldi = from.ldi();
    const GatherWindows &windows = from.windows;
    LensTiles tiles;
    by.gather.lens.chosen = &tiles;
    by.gather.lens.watch = nullptr; // what it would be told of is not what is shown
    if (needs_gather(show)) gather_picture(ldi, from.lens, windows.gathered, windows.needed, by, progress);
    ThinLens of_picture = from.lens;
    of_picture.focal_px /= windows.subpixels.across;
    return crop(shown(show, ldi, of_picture, windows.gathered, std::move(tiles)), windows.needed);
}

} // namespace

Shot::Shot(const std::vector<GatherCommand> &frames, const ToolContext &tool)
    : reel_(names_of(frames), memory_for_frames(tool.max_memory), reader_of(frames, tool)) {
    frame(frames.front());
}

Reel::Held Shot::frame(const GatherCommand &options) { return reel_.at(name_of(options)); }

const Shot::Small &Shot::small(const Reel::Held &frame, const WindowOptions &options) {
    return last_few(
        small_, [&](const Small &other) { return other.of.lock() == frame && other.proxy == options.proxy; },
        [&] {
            ThinLens any;
            OpenedLdi in = frame->unpacked();
            GatherWindows windows = gather_windows(options, in, any);
            in.ldi = std::move(*std::exchange(windows.changed, {}));
            return Small{frame, options.proxy, pack(std::move(in)), std::move(windows)};
        });
}

Subject Shot::subject(const GatherCommand &options, const Reel::Held &frame, const Camera &camera) {
    ThinLens lens = resolve_lens(camera, frame->in.ldi.windows);
    if (options.windows.proxy > 1) {
        const Small &made = small(frame, options.windows);
        lens.focal_px /= options.windows.proxy * frame->across;
        return {made.ldi.unpacked(), made.windows, lens};
    }
    give_back_memory(); // of drafts
    OpenedLdi in = frame->unpacked();
    GatherWindows windows = gather_windows(options.windows, in, lens);
    return {std::move(in), std::move(windows), lens};
}

LensFile Shot::looks_of(const GivenLooks &given, std::optional<double> fstop) {
    if (!looks_ || looks_->lens != given.lens_file || looks_->aperture != given.aperture_file ||
        looks_->fstop != fstop)
        looks_ = ReadLooks{given.lens_file, given.aperture_file, fstop,
                           read_looks({{}, given.lens_file, given.aperture_file}, fstop)};
    LensFile looks = looks_->said;
    looks.values = look_values_over(given.values, looks.values);
    return looks;
}

const Ldi *Shot::holdout(const GatherCommand &options, const Reel::Held &frame) {
    if (options.holdout.empty()) return nullptr;
    const auto alike = [&](const ReadHoldout &other) {
        return other.path == options.holdout && other.of.lock() == frame &&
               other.proxy == options.windows.proxy;
    };
    return &last_few(holdouts_, alike, [&] {
                return ReadHoldout{options.holdout, frame, options.windows.proxy,
                                   *open_holdout(options.holdout, frame->in, options.windows,
                                                 {options.lens, options.depth})};
            }).ldi;
}

TakenPicture Shot::taken(const GatherCommand &options, const ToolContext &tool, Progress &progress,
                         const TileWatch *watch) {
    const Reel::Held of = frame(options);
    TakenPicture out{{}, of->camera(options), {}, of->depths};
    out.lens = of->lens(out.camera);
    if (const auto warning = warning_of_wide_lens(out.camera, out.lens)) out.warnings.push_back(*warning);
    Subject from = subject(options, of, out.camera);
    const LensFile given = looks_of(options.looks, out.camera.fstop);
    PictureOptions by = options.picture;
    by.gather.lens.looks = looks_through(given, *by.method, from, out);
    choose_windows(from.windows, options.windows, from.in, from.lens, by.gather.lens.looks);
    raise_highlights(from.windows, from.in, highlight_gain(given.values));
    progress.may_end();
    by.holdout = holdout(options, of);
    by.gather.lens.device = device_.open(options.device, tool);
    by.gather.lens.across = from.windows.subpixels.across;
    by.gather.views_radius = views_radius(out.camera);
    if (options.windows.proxy == 1 && of->across == 1) by.gather.lens.watch = watch;
    Image made = options.show == Show::picture ? gathered(from, by, progress)
                                               : false_colours(options.show, from, by, progress);
    device_.report(tool);
    out.image = from.windows.picture_of(rgba_of(std::move(made)));
    return out;
}

ShownPixels Shot::displayed(Image image, double exposure, const ShotFrame &frame) {
    image = rgba_of(std::move(image));
    const auto gain = float(std::exp2(exposure));
    if (exposure != 0)
        for (std::size_t k = 0; k < image.channels.size(); ++k)
            if (image.channels[k].name != "A")
                for (float &value : image.plane(k)) value *= gain;
    transform_colours(frame.to_display, image);
    return shown_pixels(frame.in.name, image);
}

} // namespace sparselens
