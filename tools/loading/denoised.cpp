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

void take_denoised(const ToolContext &tool, const WarpCommand &options, std::vector<PackedView> &views,
                   const WarpOptions &by) {
    if (options.denoised.empty()) return;
    if (options.denoised.size() != views.size())
        throw UsageError(fmt::format(
            "--denoised: there are {} of them for {} views; give one for each, in the order of the views",
            options.denoised.size(), views.size()));
    std::vector<DenoisedPicture> denoised;
    for (const std::string &path : options.denoised) {
        tool.say("reading " + path);
        Beauty picture = open_beauty(path, options.depth.picture);
        say_reading(tool, path, picture.notes, picture.warnings);
        warn_of_invalid_values(tool, path, picture.bad);
        to_linear(tool, options.colour, path, picture.header, picture.image);
        denoised.push_back({path, std::move(picture.image)});
    }
    take_denoised(views, denoised, by.focal_px, perceptive_scale(by.radius, by.focal_px));
}

} // namespace sparselens
