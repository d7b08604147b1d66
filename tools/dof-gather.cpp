// dof-gather: computes the picture that a lens takes from a layered depth image.
#include "chain/devices.h"
#include "chain/notices.h"
#include "chain/take_moments.h"
#include "harness/tool.h"
#include "io/exr/exr_flat.h"
#include "options/gather_options.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

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
    TakenPicture made = take_moments(cache, tool.keeps, options,
                                     {.progress = *tool.progress,
                                      .notify = tool.notify(),
                                      .device = &device,
                                      .frame = tool.frame.value_or(0)});
    std::optional<Timed> writing(std::in_place, *tool.progress, "write");
    append_history(made.header, tool, options.history);
    const Stats stats = gather_stats(cache, made);
    if (!options.depth_output.empty())
        write_flat_exr(options.depth_output, made.depth, made.header, options.compression, options.tiles);
    write_picture(tool.notify(), options.colour, options.output, in_type(std::move(made.image), options.type),
                  made.header, options.compression, options.tiles);
    writing.reset();
    write_stats(tool, stats);
}

} // namespace

int main(int argc, char **argv) {
    LdiCache cache(true); // frames of one file share its LDI: a focus pull over one file reads it once
    GatherDevice device;
    return run_frames(
        "dof-gather", "Gathers the picture that a lens takes from a layered depth image (LDI)", argc, argv,
        [&](CLI::App &app) {
            const auto options = std::make_shared<GatherCommand>();
            add_gather_options(app, *options);
            return Job{.work = [&cache, &device,
                                options](const ToolContext &tool) { run(*options, tool, cache, device); },
                       .keeps = [options] { return options->input; },
                       .joins_moments = true};
        });
}
