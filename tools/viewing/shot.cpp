#include "viewing/shot.h"

#include "base/error.h"
#include "io/channels.h"
#include "io/picture_looks.h"
#include "loading/holdout_file.h"
#include "loading/ldi_cache.h"

#include <unistd.h>

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

// For the frames that are held beside each other: --max-memory, else a quarter of the machine's.
std::uint64_t memory_for_frames(const ToolContext &tool) {
    if (tool.max_memory) return *tool.max_memory;
    return std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE)) / 4;
}

std::vector<std::string> paths_of(const std::vector<GatherCommand> &frames) {
    std::vector<std::string> paths;
    for (const GatherCommand &frame : frames) paths.push_back(frame.input);
    return paths;
}

// By the options of its frame, of which the focal length may depend.
Reel::Read reader_of(const std::vector<GatherCommand> &frames, const ToolContext &tool) {
    return [frames, &tool](const std::string &path) {
        const GatherCommand &options = *std::ranges::find(frames, path, &GatherCommand::input);
        LdiCache cache;
        OpenedLdi &in =
            cache.load(path, options.channels, {options.lens, options.depth}, options.colour, tool);
        return shot_frame(std::move(in), options.windows);
    };
}

// The last one that is alike, else the result of `make`, which takes the place of the oldest of a few.
template <typename Kept, typename Alike, typename Make>
const Kept &last_few(std::deque<Kept> &kept, const Alike &alike, const Make &make) {
    if (const auto found = std::ranges::find_if(kept, alike); found != kept.end()) return *found;
    if (kept.size() >= most_small) kept.pop_front();
    return kept.emplace_back(make());
}

} // namespace

Shot::Shot(const std::vector<GatherCommand> &frames, const ToolContext &tool)
    : name_(frames.front().input), reel_(paths_of(frames), memory_for_frames(tool), reader_of(frames, tool)),
      device_([](const gpu::DeviceInfo &info) { return gpu::open_gather_device(info); },
              {"gathers", "tiles gathered"}),
      to_display_(output_transform(frames.front().colour, frame(frames.front())->in.header)) {}

const Shot::Small &Shot::small(const Reel::Held &frame, const WindowOptions &options) {
    return last_few(
        small_, [&](const Small &other) { return other.of == frame && other.proxy == options.proxy; },
        [&] {
            ThinLens any;
            GatherWindows windows = gather_windows(options, frame->unpacked(), any);
            Small made{frame, options.proxy, {}, windows.gathered};
            made.in.name = frame->in.name;
            made.in.ldi = std::move(*windows.changed);
            return made;
        });
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
        return other.path == options.holdout && other.of == frame && other.proxy == options.windows.proxy;
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
    ThinLens lens = resolve_lens(out.camera, of->in.ldi.windows);
    out.lens = of->lens(out.camera);
    if (const auto warning = warning_of_wide_lens(out.camera, lens)) out.warnings.push_back(*warning);
    OpenedLdi whole;
    const OpenedLdi *in = &whole;
    GatherWindows windows;
    if (options.windows.proxy > 1) {
        const Small &made = small(of, options.windows);
        in = &made.in;
        windows.gathered = made.gathered;
        lens.focal_px /= options.windows.proxy * of->across;
    } else {
        whole = of->unpacked();
        windows = gather_windows(options.windows, whole, lens);
    }
    const LensFile given_looks = looks_of(options.looks, out.camera.fstop);
    Imf::Header header = of->in.header;
    LensLooks looks;
    if (options.picture.method == &gather_methods().front())
        looks = picture_looks(given_looks, out.camera, header, lens, windows.ldi(*in).windows);
    else if (const auto warning = warning_of_round_aperture(out.camera.looks, options.picture.method->name))
        out.warnings.push_back(*warning);
    choose_windows(windows, options.windows, *in, lens, looks);
    raise_highlights(windows, *in, highlight_gain(given_looks.values));
    progress.may_end();
    LensTiles tiles;
    PictureOptions by = options.picture;
    by.holdout = holdout(options, of);
    by.gather.lens.chosen = &tiles;
    by.gather.lens.device = device_.open(options.device, tool);
    by.gather.lens.looks = looks;
    by.gather.lens.across = windows.subpixels.across;
    if (in == &whole && of->across == 1 && options.show == Show::picture) by.gather.lens.watch = watch;
    const auto gather = [&](auto &&ldi) {
        return gather_picture(std::forward<decltype(ldi)>(ldi), lens, windows.gathered, windows.needed, by,
                              progress);
    };
    Image made;
    if (options.show == Show::picture) // the samples are used up where they are of this picture alone
        made = windows.changed ? gather(std::move(*windows.changed))
               : in == &whole  ? gather(std::move(whole.ldi))
                               : gather(in->ldi);
    else if (needs_gather(options.show))
        made = gather(windows.ldi(*in));
    device_.report(tool);
    if (options.show != Show::picture) {
        ThinLens of_picture = lens;
        of_picture.focal_px /= windows.subpixels.across;
        made =
            crop(shown(options.show, windows.ldi(*in), of_picture, windows.gathered, tiles), windows.needed);
    }
    out.image = windows.picture_of(rgba_of(std::move(made)));
    return out;
}

ShownPixels Shot::displayed(Image image, double exposure) const {
    image = rgba_of(std::move(image));
    const auto gain = float(std::exp2(exposure));
    if (exposure != 0)
        for (std::size_t k = 0; k < image.channels.size(); ++k)
            if (image.channels[k].name != "A")
                for (float &value : image.plane(k)) value *= gain;
    transform_colours(to_display_, image);
    return shown_pixels(name_, image);
}

} // namespace sparselens
