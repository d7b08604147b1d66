// dof-accumulate: averages dense views over the lens, shifted so that the plane of focus stays in place.
#include "chain/notices.h"
#include "harness/tool.h"
#include "io/camera/camera_header.h"
#include "lab/averaging/accumulate_options.h"
#include "lab/averaging/averaging.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace sparselens;

Imf::Header header_of(const LensViewFiles &files) {
    Camera camera = files.centre;
    camera.lens_points.clear();
    for (const LensViewFile &view : files.views) camera.lens_points.push_back(view.position);
    Imf::Header header = files.header;
    write_camera(header, camera);
    return header;
}

void accumulate_files(const AccumulateOptions &options, const ToolContext &tool) {
    LensViewFiles files = open_lens_views(options.views);
    files.centre = camera_with_options(options.lens, files.centre);
    if (files.centre_guessed && files.views.size() > 1)
        warn(tool,
             "the lens centre is assumed to be the mean of the positions of the views; give --center FILE to "
             "set it");
    const ThinLens lens = stop_down(files, options.lens);
    tool.say(fmt::format("{} views", files.views.size()));
    const Image image = average_views(files, lens, options.transparent_outside, tool);
    const Image picture = in_type(image, options.type);
    Imf::Header header = header_of(files);
    append_history(header, tool, options.history);
    notify_clamped(tool.notify(), options.output,
                   write_flat_exr(options.output, picture, header, options.compression));
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Averages views from many points of the lens (the accumulation buffer)", "dof-accumulate");
    AccumulateOptions options;
    add_accumulate_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { accumulate_files(options, tool); });
}
