#include "chain/denoised.h"

#include "base/error.h"
#include "chain/flat_light.h"
#include "lens/perceptive_depth.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

namespace sparselens {

namespace {

void check_count(std::size_t denoised, std::size_t views) {
    if (denoised != views)
        throw UsageError(fmt::format(
            "`denoised`: there are {} of them for {} views; give one for each, in the order of the views",
            denoised, views));
}

// The pictures from files, then those in memory, whose colours are linear.
std::vector<DenoisedPicture> pictures_of(const LdiFromViews &request, const Tell &tell) {
    const ColourOptions *colour = request.colour ? &*request.colour : nullptr;
    std::vector<DenoisedPicture> pictures;
    for (const std::string &path : request.denoised) {
        FlatLight light = open_light(path, request.depth.picture, colour, tell);
        pictures.push_back({path, std::move(light.image)});
    }
    for (const DenoisedPicture &picture : request.denoised_pictures) {
        FlatFile file;
        file.image = picture.image;
        pictures.push_back({picture.name, light_of(std::move(file), picture.name, nullptr, tell).image});
    }
    return pictures;
}

} // namespace

void take_denoised(const LdiFromViews &request, const WarpOptions &by, std::vector<PackedView> &views,
                   const Tell &tell) {
    std::vector<DenoisedPicture> denoised = pictures_of(request, tell);
    if (!denoised.empty()) check_count(denoised.size(), views.size());
    if (!request.noisy.empty())
        for (PackedView &view : views) denoised.push_back(part_denoised(view, request.noisy));
    if (!denoised.empty())
        take_denoised(views, denoised, by.focal_px, perceptive_scale(by.radius, by.focal_px));
}

} // namespace sparselens
