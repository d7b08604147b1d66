// dof-accumulate: dense views over the lens, averaged so that the plane of focus stays put.
#include "base/error.h"
#include "common/lens_options.h"
#include "common/lens_view_files.h"
#include "common/picture_options.h"
#include "common/pictures.h"
#include "common/tool.h"
#include "common/words.h"
#include "dof/accumulate.h"
#include "io/camera_metadata.h"
#include "io/memory_limit.h"

#include <algorithm>
#include <map>

namespace {

using namespace sparselens;

struct Options {
    LensViewOptions views;
    LensOptions lens;
    std::string output;
    bool as_float = false;
    bool transparent_outside = false;
};

void add_options(CLI::App &app, Options &options) {
    const std::map<std::string, bool> outside{{"unknown", false}, {"transparent", true}};
    add_lens_view_options(app, options.views);
    app.add_option("-o,--output", options.output, "The average (EXR)")->required()->type_name("OUT");
    add_type_option(app, options.as_float);
    app.add_option(
           "--outside", options.transparent_outside,
           "What lies outside a view's data window: unknown (the view does not count there; the default) "
           "or transparent (black, inside the display window)")
        ->type_name("unknown|transparent")
        ->transform(words(outside));
    add_lens_options(app, options.lens);
}

// The aperture where the options ask for one: only then are views left out for standing outside of it.
std::optional<double> radius_asked_for(const LensViewFiles &files, const LensOptions &lens) {
    if (!lens.fstop && !lens.lens_radius) return {};
    return resolve_radius(lens, files.centre);
}

void stop_down(LensViewFiles &files, double radius) {
    constexpr double rounding = 1e-5; // of positions in metadata, relative
    std::erase_if(files.views,
                  [&](const LensViewFile &view) { return view.position.length() > radius * (1 + rounding); });
    if (files.views.empty()) throw Error("no view stands within the aperture asked for");
}

// A lens of radius 1, so that lens points are in scene units: moving the views needs no aperture. A pinhole
// moves nothing and needs nothing.
ThinLens moving_lens(const LensViewFiles &files, LensOptions lens, bool pinhole) {
    lens.fstop.reset();
    lens.lens_radius = pinhole ? 0 : 1;
    return resolve_lens(lens, files.centre, files.windows);
}

// A header may claim any display window: what it adds counts as what the file asks for.
Image with_surroundings(const std::string &path, const FlatFile &file) {
    const Imath::Box2i &display = file.image.windows.display, &data = file.image.windows.data;
    const auto extent = [](int a, int b, int c, int d) {
        return double(std::max(a, b)) - double(std::min(c, d)) + 1;
    };
    const double pixels = extent(display.max.x, data.max.x, display.min.x, data.min.x) *
                          extent(display.max.y, data.max.y, display.min.y, data.min.y);
    check_memory(path, pixels * double(file.image.channels.size() * sizeof(float)), file.file_size);
    return with_transparent_surroundings(file.image);
}

Image average_views(LensViewFiles &files, const ThinLens &lens, const Options &options,
                    const ToolContext &tool) {
    std::optional<Accumulation> sum;
    tool.progress->start("averaging", files.views.size());
    for (LensViewFile &file : files.views) {
        Image view = options.transparent_outside ? with_surroundings(file.path, file.take_pixels())
                                                 : file.take_pixels().image;
        if (!sum) sum = start_accumulation(view.windows, view.channels);
        const std::size_t bad = fill_nonfinite(view, sum->channels);
        if (bad > 0)
            warn(tool,
                 file.path + ": " + std::to_string(bad) + " values are not finite; filled from neighbours");
        const Imath::V2d shift = file.shift + seen_from_centre(lens, {0, 0}, lens.focus, file.position);
        accumulate(*sum, view, shift, file.path);
        tool.progress->advance();
    }
    return average(*sum);
}

Imf::Header header_of(const LensViewFiles &files) {
    Camera camera = files.centre;
    camera.lens_points.clear();
    for (const LensViewFile &view : files.views) camera.lens_points.push_back(view.position);
    Imf::Header header = files.header;
    write_camera(header, camera);
    return header;
}

void accumulate_files(const Options &options, const ToolContext &tool) {
    LensViewFiles files = open_lens_views(options.views);
    files.centre = camera_with_options(options.lens, files.centre);
    if (files.centre_guessed && files.views.size() > 1)
        warn(tool, "the lens centre is taken to be the mean of the views' positions; --center FILE says "
                   "where it is");
    const std::optional<double> radius = radius_asked_for(files, options.lens);
    if (radius) stop_down(files, *radius);
    tool.say(std::to_string(files.views.size()) + " views");
    const ThinLens lens = moving_lens(files, options.lens, radius == 0.0);
    const Image image = average_views(files, lens, options, tool);
    const Image picture = in_type(image, options.as_float);
    warn_of_clamped(tool, options.output, write_flat_exr(options.output, picture, header_of(files)));
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Average of views from many points of a lens (the accumulation buffer)", "dof-accumulate");
    Options options;
    add_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { accumulate_files(options, tool); });
}
