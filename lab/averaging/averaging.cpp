#include "lab/averaging/averaging.h"

#include "base/error.h"
#include "chain/notices.h"
#include "io/files/memory_limit.h"
#include "lab/methods/accumulate.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

// The aperture radius, if the options give one; only then are views outside of it removed.
std::optional<double> radius_asked_for(const LensViewFiles &files, const LensValues &options) {
    if (!options.fstop && !options.lens_radius) return {};
    return resolve_radius(files.centre);
}

// A header may claim any display window, so the pixels that it adds are checked against the file's size.
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

} // namespace

ThinLens stop_down(LensViewFiles &files, const LensValues &options) {
    constexpr double rounding = 1e-5; // relative, of positions in metadata
    const std::optional<double> radius = radius_asked_for(files, options);
    if (radius)
        std::erase_if(files.views, [&](const LensViewFile &view) {
            return view.position.length() > *radius * (1 + rounding);
        });
    if (files.views.empty())
        throw Error(
            "all views lie outside the aperture; use a larger one (--lens-radius, or a smaller --fstop)");
    Camera moving = files.centre;
    moving.lens_radius = radius == 0.0 ? 0 : 1;
    return resolve_lens(moving, files.windows);
}

Image average_views(LensViewFiles &files, const ThinLens &lens, bool transparent_outside,
                    const ToolContext &tool) {
    std::optional<Accumulation> sum;
    tool.progress->start("averaging", files.views.size());
    for (LensViewFile &file : files.views) {
        FlatFile read = file.take_pixels();
        notify_reading(tool.notify(), file.path, read.notes, read.warnings);
        Image view = transparent_outside ? with_surroundings(file.path, read) : std::move(read.image);
        if (!sum) sum = start_accumulation(view.windows, view.channels);
        const std::size_t bad = fill_nonfinite(view, sum->channels);
        if (bad > 0)
            warn(tool, fmt::format("{}: {} values are not finite and were replaced from neighbouring pixels",
                                   file.path, bad));
        const Imath::V2d shift = file.shift + seen_from_centre(lens, {0, 0}, lens.focus, file.position);
        accumulate(*sum, view, shift, file.path);
        tool.progress->advance();
    }
    return average(*sum);
}

} // namespace sparselens
