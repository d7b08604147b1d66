// ldi-warp: warps a centre view and views from the rim of the lens into one layered depth image.
#include "deep/checks/view_warnings.h"
#include "deep/rounded.h"
#include "harness/stats.h"
#include "harness/tool.h"
#include "io/camera/camera_write.h"
#include "io/exr/exr_deep.h"
#include "loading/denoised.h"
#include "loading/notices.h"
#include "loading/views.h"
#include "options/chosen_device.h"
#include "options/colour_options.h"
#include "options/warp_options.h"
#include "warp/reprojected_views.h"
#include "warp/warp.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

using namespace sparselens;

namespace {

// Reports views whose framing differs from that of the centre view: a frustum that is misread makes ghosts, too.
void say_framings(const ToolContext &tool, std::span<const PackedView> views) {
    for (const PackedView &view : views.subspan(1)) {
        const Framing &centre = views[0].framing, &own = view.framing;
        if (own == Framing{.principal_point = centre.principal_point}) continue;
        const Imath::V2d axis = in_pixels(own.principal_point, view.samples.windows) -
                                in_pixels(centre.principal_point, view.samples.windows);
        tool.say(fmt::format(
            "{}: optical axis {:g},{:g} pixels from that of the centre view, focal length {:g} times "
            "that of the centre view, {:g} scene units in front of it",
            view.name, axis.x, axis.y, own.zoom, own.forward));
    }
}

// What views give to a warp, which takes their pixels.
struct GivenViews {
    std::size_t views, empty, pixels, all_pixels;
};

// Cropped and masked views do not give them all.
std::size_t pixels_given(const ViewSamples &view) {
    std::size_t count = 0;
    const std::size_t alpha = view.alpha();
    for (std::size_t i = 0; i < view.windows.pixels(); ++i) count += alpha_at(view, alpha, i) > 0;
    return count;
}

GivenViews given_views(std::span<const PackedView> views) {
    GivenViews given{views.size(), 0, 0, views.size() * views[0].samples.windows.pixels()};
    for (const PackedView &view : views) {
        const std::size_t pixels = pixels_given(view.samples);
        given.pixels += pixels;
        given.empty += pixels == 0 ? 1 : 0;
    }
    return given;
}

Stats warp_stats(const GivenViews &given, const Ldi &ldi) {
    const auto [views, empty, pixels, all] = given;
    return {{"views", views},           {"views_empty", empty},
            {"pixels_given", pixels},   {"pixels_not_given", all - std::min(all, pixels)},
            {"samples", ldi.samples()}, {"samples_merged", pixels - std::min(pixels, ldi.samples())}};
}

void run(const WarpCommand &options, const ToolContext &tool, ChosenWarpDevice &device) {
    OpenedViews in = open_views(options.views, {options.lens, options.depth});
    check_views(in.views); // before anything is said of views that do not go together
    say_camera(tool, in.views[0].name, in.camera);
    say_framings(tool, in.views);
    for (std::size_t i = 0; i < in.views.size(); ++i) {
        say_reading(tool, in.views[i].name, in.notes[i], in.warnings[i]);
        warn_of_invalid_values(tool, in.views[i].name, in.bad[i]);
    }
    say_layers(tool, in.views[0].name, in.views[0].samples.channels);
    const Imf::Header as_read = in.header;
    for (PackedView &view : in.views) in.header = to_linear(tool, options.colour, view.name, as_read, view);
    const WarpOptions warp_by = with_lens({.merge = options.merge,
                                           .split_silhouettes = options.split_silhouettes,
                                           .test_photo_consistency = options.test_photo_consistency,
                                           .find_images = options.find_images,
                                           .device = device.open(options.device, tool)},
                                          in.camera, in.views);
    take_denoised(tool, options, in.views, warp_by);
    write_camera(in.header, in.camera);
    append_history(in.header, tool, options.history);
    write_picture_window(in.header, in.views[0].samples.windows.data);
    const std::vector<std::string> warnings =
        view_warnings(in.views, {options.depth.meaning, in.depth_filtered, in.camera,
                                 in.unpremultiplied}); // while the pixels are there
    const GivenViews given = given_views(in.views);
    Ldi ldi = warp(std::move(in.views), warp_by, *tool.progress);
    if (options.round_for_lens) round_for_lens(ldi, scale_in_picture(warp_by));
    device.report(tool);
    warn_of(tool, warnings);
    tool.say(
        fmt::format("{} views, {} samples in {} pixels", given.views, ldi.samples(), ldi.windows.pixels()));
    if (const auto lens = known_lens(in.camera, ldi.windows))
        say_border_reach(tool, options.output, ldi, *lens, in.camera.supersample.value_or(1), {});
    *tool.last_step = [&tool, stats = warp_stats(given, ldi), ldi = std::move(ldi), header = in.header,
                       output = options.output, compression = options.compression] {
        warn_of_clamped(tool, output, write_ldi(output, ldi, header, compression));
        write_stats(tool, stats);
    };
}

// What one step frees the next one takes, of whatever size: without this, the kernel clears most pages several times.
void keep_freed_memory() { mallopt(M_MMAP_MAX, 0); }

} // namespace

int main(int argc, char **argv) {
    keep_freed_memory();
    ChosenWarpDevice device;
    return run_frames(
        "ldi-warp",
        "Warps a centre view and views from the rim of the lens into one layered depth image (LDI)", argc,
        argv, [&](CLI::App &app) {
            const auto options = std::make_shared<WarpCommand>();
            add_warp_options(app, *options);
            return Job{.work = [options, &device](const ToolContext &tool) { run(*options, tool, device); },
                       .keeps = [options] { return kept_device(options->device); }};
        });
}
