// dof-gather: makes the picture that a lens takes from a layered depth image.
#include "deep/flatten.h"
#include "deep/front_depth.h"
#include "dof/defocused_holdout.h"
#include "dof/methods.h"
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

// The picture by the chosen method, held out by what stays sharp; for a lens of radius 0, the flattened LDI.
Image gathered_sharp(const GatherCommand &options, const Ldi &ldi, const ThinLens &lens,
                     const GatherWindows &frame, const std::optional<Holdout> &holdout,
                     const ToolContext &tool, LensTiles &tiles) {
    if (lens.radius == 0)
        return crop(holdout ? flatten_held_out(ldi, *holdout) : flatten(ldi), frame.written);
    GatherOptions by = options.gather;
    by.lens.region = frame.written;
    by.lens.holdout = holdout ? &*holdout : nullptr;
    by.lens.chosen = &tiles;
    return crop(options.method->gather(ldi, lens, frame.gathered, by, *tool.progress), frame.written);
}

Image gathered(const GatherCommand &options, const Ldi &ldi, const ThinLens &lens, const GatherWindows &frame,
               const std::optional<Ldi> &holdout, const ToolContext &tool, LensTiles &tiles) {
    if (holdout && options.holdout_defocused)
        return without_holdout(
            gathered_sharp(options, with_holdout(ldi, *holdout), lens, frame, {}, tool, tiles));
    const auto sharp = holdout ? std::optional<Holdout>(*holdout) : std::nullopt;
    return gathered_sharp(options, ldi, lens, frame, sharp, tool, tiles);
}

// A copy with brighter lights, if they are asked for: the LDI itself is kept for the next frame.
Ldi raised_highlights(const HighlightGain &by, const Ldi &ldi) {
    if (by.gain == 1) return {};
    Ldi raised = ldi;
    raise_highlights(raised, by);
    return raised;
}

void run(const GatherCommand &given, const ToolContext &tool, LdiCache &cache) {
    GatherCommand options = given;
    const OpenOptions by{options.lens, options.depth};
    OpenedLdi &in = cache.load(options.input, options.channels, by, options.colour, tool);
    say_camera(tool, options.input, in.camera);
    ThinLens lens = lens_for_ldi(in, options.focus_pixel, tool);
    const auto holdout = open_holdout(options.holdout, in.ldi.windows, options.windows.proxy, by);
    say_border_reach(tool, options.input, in.ldi, lens);
    const GatherWindows frame = gather_windows(options.windows, in, lens);
    const Ldi raised = raised_highlights(options.highlights, frame.changed ? *frame.changed : in.ldi);
    const Ldi &ldi = options.highlights.gain != 1 ? raised : frame.changed ? *frame.changed : in.ldi;
    options.gather.lens.looks = looks_for_ldi(in, read_looks(options.looks, in.camera.fstop), lens,
                                              ldi.windows, options.method, tool);
    LensTiles tiles;
    Image picture;
    if (needs_gather(options.show))
        picture =
            chosen_channels(gathered(options, ldi, lens, frame, holdout, tool, tiles), options.channels);
    if (options.show != Show::picture)
        picture = crop(shown(options.show, ldi, lens, frame.gathered, tiles), frame.written);
    Imf::Header header = in.header;
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
