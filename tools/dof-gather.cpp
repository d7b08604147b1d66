// dof-gather: makes the picture that a lens takes from a layered depth image.
#include "deep/front_samples.h"
#include "dof/border_reach.h"
#include "dof/gather_rows.h"
#include "dof/lens/lens_tiles.h"
#include "harness/stats.h"
#include "harness/tool.h"
#include "io/camera/camera_write.h"
#include "chain/channels.h"
#include "io/exr/exr_flat.h"
#include "chain/gather_windows.h"
#include "loading/holdout_file.h"
#include "loading/ldi_cache.h"
#include "loading/ldi_lens.h"
#include "loading/notices.h"
#include "options/chosen_device.h"
#include "options/colour_options.h"
#include "options/gather_options.h"
#include "options/picture_options.h"
#include "options/show.h"
#include "options/window_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>

using namespace sparselens;

namespace {

// The samples are used up where nothing else needs them.
Image gathered(const GatherCommand &options, GatherWindows &frame, const ThinLens &lens, LdiCache &cache,
               const ToolContext &tool) {
    const auto of = [&](auto &&ldi) {
        return gather_picture(std::forward<decltype(ldi)>(ldi), lens, frame.gathered, frame.needed,
                              options.picture, *tool.progress);
    };
    const OpenedLdi &in = cache.last();
    if (const auto *packed = std::get_if<PackedRows>(&in.held))
        return gather_rows(*packed, lens, frame.gathered, frame.needed, options.picture,
                           {memory_to_gather(in.samples_read, in.ldi.windows.pixels())}, *tool.progress);
    if (options.show != Show::picture) return of(frame.ldi(cache.last()));
    if (frame.changed) return of(std::move(*frame.changed));
    return tool.keeps ? of(cache.last().ldi) : of(cache.take_ldi());
}

// Whose circles of confusion are in pixels of the picture.
ThinLens in_pixels(ThinLens lens, const Subpixels &of) {
    lens.focal_px /= of.across;
    return lens;
}

// Those of one frame. A lens may come through a pipe: it is read once.
class Looks {
public:
    const LensFile &of(const GatherCommand &options, std::optional<double> fstop) {
        if (!read_) read_ = read_looks(options.looks, fstop);
        return *read_;
    }

private:
    std::optional<LensFile> read_;
};

// Empty if more than the picture is made of the samples, else by what they are reduced while the file is read.
ChooseSamples choose_samples(const GatherCommand &options, const ToolContext &tool, Looks &looks) {
    if (tool.keeps || options.show != Show::picture || !options.holdout.empty() ||
        !options.depth_output.empty() || options.focus_pixel || !options.recolor.empty())
        return {};
    return [&](const Imf::Header &header, const Camera &camera, const Ldi &rows) -> ReduceSamples {
        const LookValues &values = looks.of(options, camera.fstop).values;
        if (!keeps_pixels(options.windows, header) || highlight_gain(values).gain != 1 ||
            !is_linear(tool, options.colour, options.input, header))
            return {};
        const ThinLens lens = resolve_lens(camera, rows.windows);
        if (!can_reduce_first(options.picture, lens, values.breathing || camera.looks.breathing,
                              rows.channels))
            return {};
        return [&, lens](Ldi some) { return reduced_first(std::move(some), lens, options.picture); };
    };
}

// No tiles: not gathered by tiles.
Stats gather_stats(const LdiCache &cache, std::size_t samples, const LensTiles &tiles) {
    const std::optional<double> &focused = cache.last().camera.focus_distance;
    const Stats focus = focused && std::isfinite(*focused) ? Stats(*focused) : Stats(nullptr);
    Stats points = Stats::object();
    std::size_t copied = 0;
    for (const auto &[number, count] : histogram(tiles)) {
        if (number == 0)
            copied = std::size_t(count);
        else
            points[fmt::to_string(number)] = count;
    }
    return {{"input_read", cache.read_now()},
            {"samples_invisible", cache.last().invisible},
            {"samples", samples},
            {"channels_left_out", cache.channels_left_out()},
            {"focus_distance", focus},
            {"tiles", tiles.lens_points.size()},
            {"tiles_copied", copied},
            {"lens_points", points}};
}

void run(const GatherCommand &given, const ToolContext &tool, LdiCache &cache, ChosenGatherDevice &device) {
    GatherCommand options = given;
    const OpenOptions by{options.lens, options.depth};
    Looks looks_given;
    OpenedLdi &in = cache.load({options.input, options.recolor}, options.channels, by, options.colour, tool,
                               choose_samples(options, tool, looks_given));
    if (in.reduced() && merges_by_rows(in.ldi.channels))
        options.picture.layer_tolerance = 0; // they are merged
    if (needs_gather(options.show)) require_channels(in);
    say_camera(tool, options.input, in.camera);
    ThinLens lens = lens_for_ldi(in, options.focus_pixel, subpixels_of(options.windows, in).across, tool);
    const auto holdout = open_holdout(options.holdout, in, options.windows, by);
    const LensFile &given_looks = looks_given.of(options, in.camera.fstop);
    Imf::Header header = in.header;
    GatherWindows frame = gather_windows(options.windows, in, lens);
    const LensLooks looks = looks_for_ldi(given_looks, in.camera, header, lens, frame.ldi(in).windows,
                                          options.picture.method, tool);
    const auto *packed = std::get_if<PackedRows>(&in.held);
    const auto border = packed ? std::optional(border_of(*packed)) : std::nullopt;
    say_border_reach(tool, options.input, border ? *border : frame.ldi(in), lens, frame.subpixels.across,
                     looks);
    choose_windows(frame, options.windows, in, lens, looks);
    raise_highlights(frame, in, highlight_gain(given_looks.values));
    const Ldi &ldi = frame.ldi(in);
    const std::size_t samples = in.samples_read;
    Image depth;
    if (!options.depth_output.empty())
        depth = frame.picture_of(crop(front_depth(ldi), frame.needed), depth_of_nothing);
    LensTiles tiles;
    options.picture.holdout = holdout ? &*holdout : nullptr;
    options.picture.gather.lens.chosen = &tiles;
    options.picture.gather.lens.device = device.open(options.device, tool);
    options.picture.gather.lens.looks = looks;
    options.picture.gather.lens.across = frame.subpixels.across;
    options.picture.gather.views_radius = views_radius(in.camera);
    Image picture;
    if (needs_gather(options.show))
        picture =
            frame.picture_of(chosen_channels(gathered(options, frame, lens, cache, tool), options.channels));
    device.report(tool);
    if (options.show != Show::picture)
        picture = frame.picture_of(crop(
            shown(options.show, ldi, in_pixels(lens, frame.subpixels), frame.gathered, tiles), frame.needed));
    write_picture_camera(header, in.camera);
    append_history(header, tool, options.history);
    *tool.last_step = [&tool, header, depth = std::move(depth), picture = std::move(picture),
                       output = options.output, depth_output = options.depth_output, type = options.type,
                       colour = options.colour, compression = options.compression, in_tiles = options.tiles,
                       stats = gather_stats(cache, samples, tiles)]() mutable {
        if (!depth_output.empty()) write_flat_exr(depth_output, depth, header, compression, in_tiles);
        warn_of_clamped(tool, output,
                        write_picture(tool, colour, output, in_type(std::move(picture), type), header,
                                      compression, in_tiles));
        write_stats(tool, stats);
    };
}

// What frames of one file share, so that a pull of focus over it reads it once.
class Caches {
public:
    std::shared_ptr<LdiCache> of(const std::string &input) {
        const std::lock_guard lock(guard_);
        if (!last_ || input_ != input) last_ = std::make_shared<LdiCache>();
        input_ = input;
        return last_;
    }

private:
    std::mutex guard_; // of what follows
    std::string input_;
    std::shared_ptr<LdiCache> last_;
};

} // namespace

int main(int argc, char **argv) {
    Caches caches;
    ChosenGatherDevice device;
    return run_frames("dof-gather", "Gathers the picture that a lens takes from a layered depth image (LDI)",
                      argc, argv, [&](CLI::App &app) {
                          const auto options = std::make_shared<GatherCommand>();
                          add_gather_options(app, *options);
                          return Job{.work =
                                         [&caches, &device, options](const ToolContext &tool) {
                                             run(*options, tool, *caches.of(options->input), device);
                                         },
                                     .keeps =
                                         [options] {
                                             const std::string kept = kept_device(options->device);
                                             return kept.empty() ? options->input : kept;
                                         }};
                      });
}
