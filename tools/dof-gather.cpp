// dof-gather: computes the picture that a lens takes from a layered depth image.
#include "base/kept.h"
#include "chain/devices.h"
#include "chain/notices.h"
#include "chain/take_moments.h"
#include "harness/tool.h"
#include "io/exr/exr_flat.h"
#include "options/gather_options.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

using namespace sparselens;

namespace {

// `tiles` is absent if the method does not gather by tiles.
Stats gather_stats(const LdiCache &cache, const TakenPicture &picture) {
    const std::optional<double> &focused = picture.camera.focus_distance;
    const Stats focus = focused && std::isfinite(*focused) ? Stats(*focused) : Stats(nullptr);
    Stats points = Stats::object();
    std::size_t copied = 0;
    for (const auto &[number, count] : histogram(picture.tiles)) {
        if (number == 0)
            copied = std::size_t(count);
        else
            points[fmt::to_string(number)] = count;
    }
    return {{"input_read", cache.read_now()},
            {"samples_invisible", picture.samples_invisible},
            {"samples", picture.samples_read},
            {"moments", picture.moments},
            {"channels_left_out", cache.channels_left_out()},
            {"focus_distance", focus},
            {"tiles", picture.tiles.lens_points.size()},
            {"tiles_copied", copied},
            {"lens_points", points}};
}

void run(const GatherCommand &options, const ToolContext &tool, LdiCache &cache, GatherDevice &device) {
    TakenPicture made = take_moments(cache, tool.keeps, options, {*tool.progress, tool.tell(), &device});
    append_history(made.header, tool, options.history);
    *tool.last_step = [&tool, stats = gather_stats(cache, made), made = std::move(made),
                       output = options.output, depth_output = options.depth_output, type = options.type,
                       colour = options.colour, compression = options.compression,
                       in_tiles = options.tiles]() mutable {
        if (!depth_output.empty())
            write_flat_exr(depth_output, made.depth, made.header, compression, in_tiles);
        tell_clamped(tool.tell(), output,
                     write_picture(tool.tell(), colour, output, in_type(std::move(made.image), type),
                                   made.header, compression, in_tiles));
        write_stats(tool, stats);
    };
}

} // namespace

int main(int argc, char **argv) {
    // Frames of one file share its LDI, so that a focus pull over one file reads it once.
    Kept<std::string, std::shared_ptr<LdiCache>> caches(1);
    std::mutex guard; // for `caches`
    const auto cache_of = [&](const std::string &input) {
        const std::lock_guard lock(guard);
        return caches.get(input, [](const std::string &) { return std::make_shared<LdiCache>(); });
    };
    GatherDevice device;
    return run_frames("dof-gather", "Gathers the picture that a lens takes from a layered depth image (LDI)",
                      argc, argv, [&](CLI::App &app) {
                          const auto options = std::make_shared<GatherCommand>();
                          add_gather_options(app, *options);
                          return Job{.work =
                                         [&cache_of, &device, options](const ToolContext &tool) {
                                             run(*options, tool, *cache_of(options->input), device);
                                         },
                                     .keeps =
                                         [options] {
                                             const std::string kept = kept_device(options->device);
                                             return kept.empty() ? options->input : kept;
                                         },
                                     .joins_moments = true};
                      });
}
