#include "io/open_ldi.h"

#include "base/error.h"
#include "base/text.h"
#include "deep/tidy.h"
#include "io/camera/camera_read.h"
#include "io/depth_range.h"
#include "io/exr/exr_deep.h"
#include "io/files/file_stream.h"
#include "view/depth_reader.h"
#include "warp/edge_depths.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>

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

namespace {

// What is read of a picture a few rows at a time.
class RowsReader {
public:
    RowsReader(const std::string &path, const OpenOptions &options, const ReduceSamples &reduce)
        : name_(display_name(path)), options_(options), reduce_(reduce) {}

    Ldi operator()(const Imf::Header &header, Ldi rows) {
        if (const auto [least, most] = std::ranges::minmax_element(rows.z); least != rows.z.end())
            depths_ = {std::min(depths_[0], *least), std::max(depths_[1], *most)};
        const Camera camera = camera_with_options(options_.lens, read_camera(header));
        make_planar(rows, options_.depth.meaning, depth_range(options_.depth, header), camera);
        if (!all_valid(rows)) throw NeedsAllSamples();
        in_file_ += rows.samples();
        rows = tidy(std::move(rows));
        read_ += rows.samples();
        return reduce_(header, camera, std::move(rows));
    }

    // Says of the picture what its samples would have said.
    void tell(OpenedLdi &opened) const {
        if (in_file_ == 0) return;
        opened.reduced = true;
        opened.samples_read = read_;
        opened.invisible = in_file_ - std::min(in_file_, read_);
        if (const auto warning = normalized_warning(options_.depth, depths_))
            if (!is_among(opened.warnings, *warning)) opened.warnings.push_back(*warning);
    }

private:
    bool all_valid(Ldi &rows) const {
        try {
            return !sanitize(rows, name_).any();
        } catch (const Error &) {
            return false;
        }
    }

    std::string name_;
    const OpenOptions &options_;
    const ReduceSamples &reduce_;
    std::size_t in_file_ = 0, read_ = 0;
    std::array<float, 2> depths_{std::numeric_limits<float>::infinity(), 0}; // the least and the most
};

} // namespace

OpenedLdi open_ldi(const std::string &path, const OpenOptions &options, const ReduceSamples &reduce) {
    if (!reduce || options.depth.meaning != DepthMeaning::planar || is_standard_stream(path))
        return open_ldi(path, options);
    RowsReader reader(path, options, reduce);
    try {
        OpenedLdi opened = ready_ldi(
            read_ldi(path, options.depth.channel, options.depth.view, std::ref(reader)), path, options);
        reader.tell(opened);
        return opened;
    } catch (const NeedsAllSamples &) {
        return open_ldi(path, options);
    }
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
    opened.samples_read = opened.ldi.samples();
    opened.invisible = in_file - std::min(in_file, opened.samples_read);
    return opened;
}

} // namespace sparselens
