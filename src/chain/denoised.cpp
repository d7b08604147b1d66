#include "chain/denoised.h"

#include "base/error.h"
#include "chain/file_notices.h"
#include "io/recolor_ldi.h"
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

DenoisedPicture open_denoised(const LdiFromViews &request, const std::string &path, const Tell &tell) {
    tell({NoticeKind::reading, path});
    Beauty picture = open_beauty(path, request.depth.picture);
    tell_reading(tell, path, picture.notes, picture.warnings);
    tell_invalid_values(tell, path, picture.bad);
    if (request.colour) to_linear(tell, *request.colour, path, picture.header, picture.image);
    return {path, std::move(picture.image)};
}

} // namespace

void take_denoised(const LdiFromViews &request, const WarpOptions &by, std::vector<PackedView> &views,
                   const Tell &tell) {
    std::vector<DenoisedPicture> denoised;
    if (!request.noisy.empty())
        for (PackedView &view : views) denoised.push_back(part_denoised(view, request.noisy));
    if (!request.denoised.empty()) check_count(request.denoised.size(), views.size());
    for (const std::string &path : request.denoised) denoised.push_back(open_denoised(request, path, tell));
    const std::vector<DenoisedPicture> &in_memory = request.denoised_pictures;
    if (!in_memory.empty()) check_count(in_memory.size(), views.size());
    if (denoised.empty() && in_memory.empty()) return;
    take_denoised(views, denoised.empty() ? in_memory : denoised, by.focal_px,
                  perceptive_scale(by.radius, by.focal_px));
}

} // namespace sparselens
