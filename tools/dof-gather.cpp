// dof-gather: makes the picture that a lens takes from a layered depth image.
#include "deep/front_depth.h"
#include "harness/tool.h"
#include "io/camera/camera_write.h"
#include "io/exr/exr_flat.h"
#include "io/gather_windows.h"
#include "loading/holdout_file.h"
#include "loading/ldi_lens.h"
#include "loading/notices.h"
#include "loading/stage_stats.h"
#include "options/channels.h"
#include "options/colour_options.h"
#include "options/gather_options.h"
#include "options/picture_options.h"
#include "options/show.h"
#include "options/window_options.h"

using namespace sparselens;

namespace {

void run(const GatherCommand &given, const ToolContext &tool, LdiCache &cache) {
    GatherCommand options = given;
    const OpenOptions by{options.lens, options.depth};
    OpenedLdi &in = cache.load(options.input, options.channels, by, options.colour, tool);
    say_camera(tool, options.input, in.camera);
    ThinLens lens = lens_for_ldi(in, options.focus_pixel, tool);
    const auto holdout = open_holdout(options.holdout, in.ldi.windows, options.windows.proxy, by);
    say_border_reach(tool, options.input, in.ldi, lens);
    GatherWindows frame = gather_windows(options.windows, in, lens);
    raise_highlights(frame, in, options.highlights);
    const Ldi &ldi = frame.ldi(in);
    Imf::Header header = in.header;
    LensTiles tiles;
    options.picture.holdout = holdout ? &*holdout : nullptr;
    options.picture.gather.lens.chosen = &tiles;
    options.picture.gather.lens.looks =
        looks_for_ldi(read_looks(options.looks, in.camera.fstop), in.camera, header, lens, ldi.windows,
                      options.picture.method, tool);
    Image picture;
    if (needs_gather(options.show))
        picture = chosen_channels(
            gather_picture(ldi, lens, frame.gathered, frame.written, options.picture, *tool.progress),
            options.channels);
    if (options.show != Show::picture)
        picture = crop(shown(options.show, ldi, lens, frame.gathered, tiles), frame.written);
    write_camera(header, in.camera);
    append_history(header, tool, options.history);
    if (!options.depth_output.empty())
        write_flat_exr(options.depth_output, crop(front_depth(ldi), frame.written), header,
                       options.compression);
    picture = in_type(std::move(picture), options.type);
    warn_of_clamped(
        tool, options.output,
        write_picture(tool, options.colour, options.output, std::move(picture), header, options.compression));
    write_stats(tool, gather_stats(cache, tiles));
}

} // namespace

int main(int argc, char **argv) {
    LdiCache cache; // for a focus pull over one file, which is read once
    return run_frames("dof-gather", "Gathers the picture that a lens takes from a layered depth image (LDI)",
                      argc, argv, [&](CLI::App &app) {
                          const auto options = std::make_shared<GatherCommand>();
                          add_gather_options(app, *options);
                          return [&cache, options](const ToolContext &tool) { run(*options, tool, cache); };
                      });
}
