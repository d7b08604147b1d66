#include "loading/denoised.h"

#include "base/error.h"
#include "denoised/denoised_views.h"
#include "io/recolor_ldi.h"
#include "lens/perceptive_depth.h"
#include "loading/notices.h"
#include "options/colour_options.h"

#include <fmt/format.h>

#include <cstddef>

namespace sparselens {

namespace {

std::vector<DenoisedPicture> open_denoised(const ToolContext &tool, const WarpCommand &options,
                                           std::size_t views) {
    if (options.denoised.size() != views)
        throw UsageError(fmt::format(
            "--denoised: there are {} of them for {} views; give one for each, in the order of the views",
            options.denoised.size(), views));
    std::vector<DenoisedPicture> denoised;
    for (const std::string &path : options.denoised) {
        tool.say("reading " + path);
        Beauty picture = open_beauty(path, options.depth.picture);
        say_reading(tool, path, picture.notes, picture.warnings);
        warn_of_invalid_values(tool, path, picture.bad);
        to_linear(tool, options.colour, path, picture.header, picture.image);
        denoised.push_back({path, std::move(picture.image)});
    }
    return denoised;
}

} // namespace

void take_denoised(const ToolContext &tool, const WarpCommand &options, std::vector<PackedView> &views,
                   const WarpOptions &by) {
    if (options.denoised.empty() && options.noisy.empty()) return;
    std::vector<DenoisedPicture> denoised;
    if (options.noisy.empty())
        denoised = open_denoised(tool, options, views.size());
    else
        for (PackedView &view : views) denoised.push_back(part_denoised(view, options.noisy));
    take_denoised(views, denoised, by.focal_px, perceptive_scale(by.radius, by.focal_px));
}

} // namespace sparselens
