#include "io/open_ldi.h"

#include "deep/tidy.h"
#include "io/camera/camera_read.h"
#include "io/depth_range.h"
#include "io/exr/exr_deep.h"
#include "io/files/file_stream.h"
#include "view/depth_reader.h"
#include "warp/edge_depths.h"

#include <algorithm>

namespace sparselens {

namespace {

void make_planar(Ldi &ldi, DepthMeaning meaning, const DepthRange &range, const Camera &camera) {
    const DepthReader read(ldi.windows, meaning, range, camera);
    for (std::size_t pixel = 0; pixel + 1 < ldi.begin.size(); ++pixel)
        for (const std::uint64_t i : ldi.pixel(pixel)) {
            ldi.z[i] = read.planar(ldi.z[i], pixel);
            if (!ldi.z_back.empty()) ldi.z_back[i] = read.planar(ldi.z_back[i], pixel);
        }
}

} // namespace

OpenedLdi open_ldi(const std::string &path, const OpenOptions &options) {
    return ready_ldi(read_ldi(path, options.depth.channel, options.depth.view), path, options);
}

OpenedLdi ready_ldi(LdiFile file, const std::string &path, const OpenOptions &options) {
    OpenedLdi opened{.name = display_name(path),
                     .ldi = std::move(file.ldi),
                     .header = std::move(file.header),
                     .camera = {},
                     .bad = {},
                     .notes = std::move(file.notes),
                     .warnings = std::move(file.warnings)};
    opened.camera = camera_with_options(options.lens, read_camera(opened.header));
    if (const auto warning = normalized_warning(options.depth, opened.ldi.z))
        opened.warnings.push_back(*warning);
    make_planar(opened.ldi, options.depth.meaning, depth_range(options.depth, opened.header), opened.camera);
    opened.bad = sanitize(opened.ldi, opened.name);
    if (const std::size_t settled = file.deep ? 0 : settle_edge_depths(opened.ldi))
        opened.notes.push_back(edge_note(settled));
    const std::size_t in_file = opened.ldi.samples();
    opened.ldi = tidy(std::move(opened.ldi));
    opened.invisible = in_file - std::min(in_file, opened.ldi.samples());
    return opened;
}

} // namespace sparselens
