// ldi-warp: warps a centre view and views from the rim of the lens into one layered depth image.
#include "base/memory.h"
#include "chain/devices.h"
#include "chain/make_ldi.h"
#include "chain/notices.h"
#include "harness/tool.h"
#include "io/exr/exr_deep.h"
#include "options/warp_options.h"

#include <algorithm>
#include <memory>
#include <optional>

using namespace sparselens;

namespace {

Stats warp_stats(const MadeLdi &made) {
    const std::size_t pixels = made.pixels_given, given = made.samples_given, samples = made.ldi.samples();
    return {
        {"views", made.views},    {"views_empty", made.empty_views},
        {"pixels_given", pixels}, {"pixels_not_given", made.all_pixels - std::min(made.all_pixels, pixels)},
        {"samples", samples},     {"samples_merged", given - std::min(given, samples)}};
}

void run(const WarpCommand &options, const ToolContext &tool, WarpingDevice &device) {
    LdiFromViews request = options;
    request.name = options.output;
    if (!request.camera.frame) request.camera.frame = tool.frame;
    request.files = options.views.files;
    for (const auto &[position, file] : options.views.placed)
        request.placed.emplace_back(view_offset(position), file);
    std::optional<Timed> timed(std::in_place, *tool.progress, "read and warp");
    MadeLdi made = make_ldi(request, {*tool.progress, tool.notify(), &device});
    timed.emplace(*tool.progress, "write");
    append_history(made.header, tool, options.history);
    notify_clamped(tool.notify(), options.output,
                   write_ldi(options.output, made.ldi, made.header, options.compression));
    timed.reset();
    write_stats(tool, warp_stats(made));
}

// Each step reuses the memory that the step before freed, whatever its size. Without this, the kernel clears most pages
// several times.
void keep_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 0);
#endif
}

} // namespace

int main(int argc, char **argv) {
    keep_freed_memory();
    WarpingDevice device;
    return run_frames(
        "ldi-warp",
        "Warps a centre view and views from the rim of the lens into one layered depth image (LDI)", argc,
        argv, [&](CLI::App &app) {
            const auto options = std::make_shared<WarpCommand>();
            add_warp_options(app, *options);
            return Job{[options, &device](const ToolContext &tool) { run(*options, tool, device); }};
        });
}
