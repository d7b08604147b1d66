#include "io/open_ldi.h"

#include "base/error.h"
#include "deep/channel_alpha.h"
#include "deep/checks/picture_checks.h"
#include "deep/mixed_pixels.h"
#include "deep/tidy.h"
#include "io/display/shown_picture.h"
#include "io/files/file_stream.h"
#include "io/photograph.h"
#include "view/depth.h"
#include "view/flat_pixels.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <mutex>
#include <optional>

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

bool has_coverage_by_colour(const Ldi &ldi) { return by_coverage(ldi).size() > 1; }

// Returns everything about the file except its packed samples.
OpenedLdi with_camera(LdiFile &&file, const std::string &path, const OpenOptions &options) {
    OpenedLdi opened;
    opened.name = display_name(path);
    opened.ldi = std::move(file.ldi);
    opened.header = std::move(file.header);
    opened.notes = std::move(file.notes);
    opened.warnings = std::move(file.warnings);
    const bool photographed = options.depth.meaning == DepthMeaning::disparity;
    opened.camera =
        camera_with_options(options.lens, photographed ? photograph_camera()
                                                       : opened_camera(opened.header, opened.name,
                                                                       options.camera, opened.ldi.windows));
    return opened;
}

} // namespace

OpenedLdi open_ldi(const std::string &path, const OpenOptions &options) {
    const PictureChoice &choice = options.depth.picture;
    if (!is_photograph(path, choice)) return prepare_ldi(read_ldi(path, choice), path, options);
    OpenOptions of_photograph = options;
    const bool own = choice.depth_file.empty(), unsaid = options.depth.meaning == DepthMeaning::planar;
    if (own && !unsaid && options.depth.meaning != DepthMeaning::disparity)
        throw UsageError("`depth`: is for a `depth_file`; the depth in a photograph says itself what it is");
    if (unsaid && (own || has_shown_ending(choice.depth_file)))
        of_photograph.depth.meaning = DepthMeaning::disparity; // such a file has no depths in scene units
    return prepare_ldi(read_photograph(path, choice), path, of_photograph);
}

namespace {

// Reads a picture a few rows at a time, from several threads.
class RowsReader {
public:
    RowsReader(const std::string &path, const OpenOptions &options, const ChooseSamples &choose)
        : name_(display_name(path)), options_(options), choose_(choose) {}

    // Returns nothing if all rows are needed at once.
    std::optional<Ldi> operator()(const Imf::Header &header, Ldi rows) {
        const std::array<float, 2> depths = depths_of(rows);
        const Camera camera =
            camera_with_options(options_.lens, opened_camera(header, name_, options_.camera, rows.windows));
        make_planar(rows, options_.depth.meaning, depth_range(options_.depth, header), camera);
        if (!all_valid(rows)) return none();
        const std::size_t in_file = rows.samples();
        rows = tidy(std::move(rows));
        std::call_once(chosen_, [&] { reduce_ = choose_(header, camera, rows); });
        if (!reduce_) return none();
        count(in_file, rows, depths);
        return reduce_(std::move(rows));
    }
    bool needs_all() const { return needs_all_; }

    // The picture of the rows read, which are ready, with notes about all samples. Returns nothing if no row was read.
    std::optional<OpenedLdi> opened(LdiFile &&file, const std::string &path) const {
        if (in_file_ == 0) return {};
        OpenedLdi opened = with_camera(std::move(file), path, options_);
        opened.held = FewerSamples{};
        if (file.packed) opened.held = std::move(*file.packed);
        opened.samples_read = read_;
        opened.invisible = in_file_ - std::min(in_file_, read_);
        opened.coverage_by_colour = coverage_by_colour_;
        if (const auto warning = normalized_warning(options_.depth, depths_))
            opened.warnings.push_back(*warning);
        return opened;
    }

private:
    std::optional<Ldi> none() {
        needs_all_ = true;
        return {};
    }
    // The smallest and the largest depth.
    static std::array<float, 2> depths_of(const Ldi &rows) {
        const auto [least, most] = std::ranges::minmax_element(rows.z);
        if (least == rows.z.end()) return {std::numeric_limits<float>::infinity(), 0};
        return {*least, *most};
    }
    void count(std::size_t in_file, const Ldi &ready, const std::array<float, 2> &depths) {
        const bool by_colour = has_coverage_by_colour(ready);
        const std::lock_guard lock(counting_);
        in_file_ += in_file;
        read_ += ready.samples();
        coverage_by_colour_ = coverage_by_colour_ || by_colour;
        depths_ = {std::min(depths_[0], depths[0]), std::max(depths_[1], depths[1])};
    }
    bool all_valid(Ldi &rows) const {
        try {
            return !sanitize(rows, name_).any();
        } catch (const Error &) {
            return false; // rows only: the whole picture, read next, may be valid, or fails too
        }
    }

    std::string name_;
    const OpenOptions &options_;
    const ChooseSamples &choose_;
    std::once_flag chosen_;
    ReduceSamples reduce_;
    std::atomic<bool> needs_all_ = false;
    std::mutex counting_; // guards the variables below
    std::size_t in_file_ = 0, read_ = 0;
    bool coverage_by_colour_ = false;
    std::array<float, 2> depths_{std::numeric_limits<float>::infinity(), 0}; // smallest and largest
};

} // namespace

OpenedLdi open_ldi(const std::string &path, const OpenOptions &options, const ChooseSamples &choose) {
    if (!choose || options.depth.meaning != DepthMeaning::planar || is_read_once(path) ||
        is_photograph(path, options.depth.picture))
        return open_ldi(path, options);
    RowsReader reader(path, options, choose);
    LdiFile file = read_ldi(path, options.depth.picture, std::ref(reader));
    if (reader.needs_all()) return open_ldi(path, options);
    if (std::optional<OpenedLdi> opened = reader.opened(std::move(file), path)) return std::move(*opened);
    return prepare_ldi(std::move(file), path, options);
}

namespace {

// Settles an LDI with one sample in each pixel.
std::size_t repair_speckles_of(Ldi &ldi) {
    const std::vector<std::span<const float>> planes(ldi.values.begin(), ldi.values.end());
    return repair_speckles(ldi.windows, ldi.channels, planes, ldi.z);
}

// The same, but called before samples that cover nothing are removed.
bool seems_unpremultiplied(const Ldi &ldi, const PictureChoice &choice) {
    if (choice.unpremultiplied) return false;
    const auto plane = [&](std::size_t k) { return std::span<const float>(ldi.values[k]); };
    return looks_unpremultiplied(fall_at_edges(flat_pixels(ldi.windows, ldi.channels, ldi.z, plane)));
}

} // namespace

OpenedLdi prepare_ldi(LdiFile file, const std::string &path, const OpenOptions &options) {
    const bool deep = file.deep;
    OpenedLdi opened = with_camera(std::move(file), path, options);
    const auto warning =
        deep ? normalized_warning(options.depth, opened.ldi.z)
             : normalized_warning(options.depth, opened.ldi.z, opened.ldi.windows.grid().array());
    if (warning) opened.warnings.push_back(*warning);
    if (!deep) opened.unpremultiplied = seems_unpremultiplied(opened.ldi, options.depth.picture);
    if (options.depth.meaning == DepthMeaning::disparity)
        repair_disparities(opened.ldi.z, opened.name, opened.warnings,
                           opened.disparities = options.disparities);
    make_planar(opened.ldi, options.depth.meaning, depth_range(options.depth, opened.header), opened.camera);
    opened.bad = sanitize(opened.ldi, opened.name);
    if (!deep) {
        opened.speckles = repair_speckles_of(opened.ldi);
        const RepairedEdges repaired = repair_edge_depths(opened.ldi);
        opened.depth_filtered = repaired.filtered;
        if (repaired.count > 0) opened.notes.push_back(edge_note(repaired.count));
    }
    opened.deep = deep;
    opened.depth = options.depth.meaning;
    const std::size_t in_file = opened.ldi.samples();
    opened.ldi = tidy(std::move(opened.ldi));
    opened.coverage_by_colour = has_coverage_by_colour(opened.ldi);
    if (opened.depth == DepthMeaning::disparity) opened.focus = usual_focus(opened.ldi);
    opened.samples_read = opened.ldi.samples();
    opened.invisible = in_file - std::min(in_file, opened.samples_read);
    return opened;
}

} // namespace sparselens
