#include "viewing/shot.h"

#include "chain/channels.h"
#include "chain/take_moments.h"
#include "chain/words.h"
#include "harness/one_line.h"
#include "harness/process.h"
#include "io/moment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace sparselens {

namespace {

// How many proxies or holdouts are kept: a page settles on one, and tries others on the way to it.
constexpr std::size_t most_small = 2;

constexpr const char *shown_channels = "rgba";

// Identifies how a file is read: its name and the focal length of the picture, which turns ray lengths into planar
// depths.
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

// Reads a file with the options of the first frame that has its name.
Reel::Read reader_of(const std::vector<GatherCommand> &frames, const ToolContext &tool) {
    return [frames, &tool](const std::string &name) {
        const GatherCommand &options = *std::ranges::find(frames, name, name_of);
        LdiCache cache;
        return shot_frame(std::move(cache.load(middle_moment(options), tool.tell())), options.windows,
                          options.colour);
    };
}

// Returns the last matching entry, else the result of `make`, which replaces the oldest of a few entries. Entries of
// frames that are no longer held are dropped first.
template <typename Kept, typename Alike, typename Make>
const Kept &last_few(std::deque<Kept> &kept, const Alike &alike, const Make &make) {
    std::erase_if(kept, [](const Kept &one) { return one.of.expired(); });
    if (const auto found = std::ranges::find_if(kept, alike); found != kept.end()) return *found;
    if (kept.size() >= most_small) kept.pop_front();
    return kept.emplace_back(make());
}

} // namespace

Shot::Shot(const std::vector<GatherCommand> &frames, const ToolContext &tool)
    : reel_(names_of(frames), memory_for_frames(tool.max_memory), reader_of(frames, tool)) {
    frame(frames.front());
}

Reel::Held Shot::frame(const GatherCommand &options) { return reel_.at(name_of(options)); }

GatherWindows Shot::small(const Reel::Held &frame, const WindowOptions &options) {
    const Small &made = last_few(
        small_, [&](const Small &other) { return other.of.lock() == frame && other.proxy == options.proxy; },
        [&] {
            GatherWindows windows = gather_windows(options, frame->unpacked());
            const Ldi ldi = *std::exchange(windows.changed, {});
            PackedRows rows(ldi.windows);
            rows.append(ldi);
            return Small{frame, options.proxy, std::move(rows), std::move(windows)};
        });
    GatherWindows windows = made.windows;
    windows.changed = all_rows(made.ldi);
    return windows;
}

const Ldi *Shot::holdout(const GatherCommand &options, const Reel::Held &frame) {
    if (options.holdout.empty()) return nullptr;
    const auto alike = [&](const ReadHoldout &other) {
        return other.path == options.holdout && other.of.lock() == frame &&
               other.proxy == options.windows.proxy;
    };
    return &last_few(holdouts_, alike, [&] {
                return ReadHoldout{options.holdout, frame, options.windows.proxy,
                                   open_holdout(middle_moment(options), frame->in)};
            }).ldi;
}

ShotPicture Shot::taken(const GatherCommand &options, const ToolContext &tool, Progress &progress,
                        const TileWatch *watch) {
    const Reel::Held of = frame(options);
    ShotPicture out;
    out.depths = of->depths;
    const Tell tell = [&](const Notice &notice) {
        if (level_of(notice) == NoticeLevel::note)
            tool.say(words_of(notice));
        else
            out.warnings.push_back(with_options(words_of(notice)));
    };
    PictureRequest request = options;
    request.lens.focus_distance = of->camera(options).focus_distance;
    request.focus_pixel.reset();
    request.channels = shown_channels;
    const PictureWork work{progress, tell, &device_, watch, &looks_};
    if (names_moments(options.input) && options.windows.proxy == 1) {
        LdiCache cache;
        static_cast<TakenPicture &>(out) = take_moments(cache, false, request, work);
        return out;
    }
    request.shutter_curve.clear();
    request.rolling_shutter = 1;
    request.picture.holdout = holdout(options, of);
    request.holdout.clear();
    if (options.windows.proxy > 1) {
        static_cast<TakenPicture &>(out) = take_picture(of->in, small(of, options.windows), request, work);
    } else {
        give_back_memory(); // held by drafts
        static_cast<TakenPicture &>(out) = take_picture(of->unpacked(), request, work);
    }
    return out;
}

ShownPixels Shot::displayed(Image image, double exposure, const ShotFrame &frame) {
    image = chosen_channels(std::move(image), shown_channels);
    const auto gain = float(std::exp2(exposure));
    if (exposure != 0)
        for (std::size_t k = 0; k < image.channels.size(); ++k)
            if (image.channels[k].name != "A")
                for (float &value : image.plane(k)) value *= gain;
    transform_colours(frame.to_display, image);
    return shown_pixels(frame.in.name, image);
}

} // namespace sparselens
