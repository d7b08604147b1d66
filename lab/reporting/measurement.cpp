#include "lab/reporting/measurement.h"

#include "base/light.h"
#include "base/parallel.h"
#include "chain/regions.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "lab/report/numbers.h"
#include "lab/report/verdict.h"
#include "lab/reporting/files.h"
#include "measure/flip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

namespace sparselens::lab {

namespace {

namespace fs = std::filesystem;

Image tone_mapped_picture(Image image) {
    for (float &value : image.values) value = float(tone_mapped(value));
    return image;
}

// The difference of tone-mapped pictures.
Image difference_picture(Image a, const Image &b) {
    constexpr float gain = 8;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        a.values[i] = gain * std::abs(a.values[i] - b.values[i]);
    return a;
}

// Writes the first three channels, over the data window, as PNG: 0 becomes 0, 1 becomes 255, NaN becomes 0.
void write_png(const std::string &path, const Image &image) {
    Image rgb(windows_of_size(image.windows.width(), image.windows.height()), {{"R"}, {"G"}, {"B"}});
    for (std::size_t c = 0; c < rgb.channels.size(); ++c)
        std::ranges::copy(image.plane(c), rgb.plane(c).begin());
    make_folder(fs::path(path).parent_path().string());
    write_shown_picture(path, rgb);
}

// 32 x 32 pixels of each picture around an 8 x 8 block, side by side with a white gap.
Image worst_place_picture(const Image &picture, const Image &reference, const Imath::V2i &block) {
    constexpr int side = 32, gap = 2;
    const int width = picture.windows.width(), height = picture.windows.height();
    const auto start = [](int at, int length) {
        return std::clamp(at + 4 - side / 2, 0, std::max(0, length - side));
    };
    const int left = start(block.x, width), top = start(block.y, height);
    Image pair(windows_of_size(2 * side + gap, side), {{"R"}, {"G"}, {"B"}});
    for (std::size_t c = 0; c < 3; ++c) {
        std::ranges::fill(pair.plane(c), 1.f);
        for (int y = 0; y < std::min(side, height - top); ++y)
            for (int x = 0; x < std::min(side, width - left); ++x) {
                const std::size_t from = std::size_t(top + y) * std::size_t(width) + std::size_t(left + x);
                const std::size_t to = std::size_t(y) * (2 * side + gap) + std::size_t(x);
                pair.plane(c)[to] = picture.plane(c)[from];
                pair.plane(c)[to + side + gap] = reference.plane(c)[from];
            }
    }
    return pair;
}

class SceneMeasurement {
public:
    SceneMeasurement(const ScenePlan &plan, std::span<const StepTimes> times, std::string folder,
                     const ToolContext &tool)
        : times_(times), folder_(std::move(folder)), windows_(read(plan.reference.picture).windows),
          reference_(over_reference(plan.reference.picture)),
          mapped_reference_(tone_mapped_picture(reference_)),
          bits_(regions_over(windows_, path(plan.centre.picture), {.lens = plan.lens}, tool.tell())) {
        write_png(path(png_name(plan.reference.folder, "picture")), mapped_reference_);
    }

    ReportRow measured(const PlannedRow &planned) const {
        ReportRow row = planned.row;
        row.size = fmt::format("{}x{}", windows_.width(), windows_.height());
        add_times(planned, row);
        if (!planned.partial_views.empty()) add_partial_views(planned, row);
        const Image picture = over_reference(planned.picture);
        std::ranges::copy(image_error(picture, reference_, bits_, region_names.size()), row.errors.begin());
        const std::vector<double> flip =
            flip_means(flip_map(picture, reference_, FlipRange::hdr), bits_, region_names.size());
        for (std::size_t r = 0; r < flip.size(); ++r) row.errors[r].flip = flip[r];
        if (!planned.many_points.empty()) {
            const Image many = over_reference(planned.many_points);
            row.causes = {image_error(picture, many).front().psnr_tonemapped,
                          image_error(many, reference_).front().psnr_tonemapped};
        }
        if (!planned.pull.empty()) row.pull = steadiness(planned.pull);
        const Image mapped = tone_mapped_picture(picture);
        row.picture = pictures_of(planned) + ".png";
        row.difference = pictures_of(planned) + "-difference.png";
        write_png(path(row.picture), mapped);
        row.worst = pictures_of(planned) + "-worst.png";
        write_png(path(row.worst),
                  worst_place_picture(mapped, mapped_reference_, row.errors.front().worst_block));
        write_png(path(row.difference), difference_picture(mapped, mapped_reference_));
        return row;
    }

    static std::string png_name(const std::string &folder, const std::string &name) {
        return "pictures/" + folder + '/' + name + ".png";
    }

private:
    std::string path(const std::string &file) const { return (fs::path(folder_) / file).string(); }
    Image read(const std::string &file) const { return read_flat_exr(path(file)).image; }
    Image over_reference(const std::string &file) const {
        return rgba_over(read(file), windows_, path(file));
    }

    Steadiness steadiness(const std::vector<std::string> &frames) const {
        TemporalError error;
        for (const std::string &frame : frames) error.add(over_reference(frame));
        return error.figures().image;
    }

    // A folder of its own, because the EXR files may be ready-made and elsewhere.
    static std::string pictures_of(const PlannedRow &planned) {
        const std::string name =
            planned.row.scene + '/' + method_name(planned.row) + ' ' + planned.row.budget;
        std::string plain;
        for (const char c : name) plain += c == ' ' ? '-' : c == '+' ? 'p' : c;
        std::erase(plain, ',');
        return "pictures/" + plain;
    }

    // Counts rays of the rendered pixels only: a pixel with alpha 0 was not rendered.
    void add_partial_views(const PlannedRow &planned, ReportRow &row) const {
        for (const std::string &file : matching_files(path(planned.partial_views))) {
            const Image view = read_flat_exr(file).image;
            const auto alpha = view.plane(find_channel(view.channels, "A"));
            const auto rendered = std::ranges::count_if(alpha, [](float a) { return a != 0; });
            row.rays += double(planned.partial_samples) * double(rendered) / double(windows_.pixels());
            ++row.views;
        }
    }

    void add_times(const PlannedRow &planned, ReportRow &row) const {
        for (const std::size_t step : planned.steps) {
            const StepTimes &times = times_[step];
            for (std::size_t s = 0; s < row.seconds.size(); ++s) row.seconds[s] += times.seconds[s];
            row.peak_mb = std::max(row.peak_mb, times.peak_mb);
            row.runs = row.runs == 0 ? times.runs : std::min(row.runs, times.runs);
        }
    }

    std::span<const StepTimes> times_;
    std::string folder_;
    Windows windows_;
    Image reference_, mapped_reference_;
    std::vector<std::uint8_t> bits_;
};

} // namespace

std::vector<ReportRow> measure_rows(const ScenePlan &plan, std::span<const StepTimes> times,
                                    const std::string &folder, const ToolContext &tool) {
    const SceneMeasurement scene(plan, times, folder, tool);
    std::vector<ReportRow> rows(plan.rows.size());
    tool.progress->start(plan.name + ": measuring", rows.size());
    parallel_for(rows.size(), [&](std::size_t i) {
        rows[i] = scene.measured(plan.rows[i]);
        tool.progress->advance();
    });
    return rows;
}

std::vector<PagePicture> page_pictures(const ScenePlan &plan, std::span<const ReportRow> rows,
                                       const std::string &folder) {
    const auto bytes = [&](const std::string &file) {
        return read_bytes((fs::path(folder) / file).string());
    };
    std::vector<PagePicture> pictures{
        {"reference", bytes(SceneMeasurement::png_name(plan.reference.folder, "picture"))}};
    std::set<std::string> shown;
    const auto show = [&](const ReportRow &row) {
        if (!shown.insert(row.picture).second) return;
        pictures.push_back({fmt::format("{}, {}: {} dB, {} s", method_name(row), row.budget,
                                        fixed(quality(row), 2), significant(total_seconds(row), 3)),
                            bytes(row.picture)});
    };
    if (const auto best = scene_verdict(rows).best) show(rows[*best]);
    std::map<std::string, std::vector<const ReportRow *>> methods;
    for (const ReportRow &row : rows) methods[method_name(row)].push_back(&row);
    for (const auto &[name, of_method] : methods) {
        show(**std::ranges::min_element(of_method, {},
                                        [](const ReportRow *row) { return total_seconds(*row); }));
        show(**std::ranges::max_element(of_method, {}, [](const ReportRow *row) { return quality(*row); }));
    }
    return pictures;
}

std::vector<PagePicture> worst_places(std::span<const ReportRow> rows, const std::string &folder) {
    std::vector<PagePicture> places;
    for (const ReportRow &row : rows)
        places.push_back({fmt::format("{}, {}: {} dB", method_name(row), row.budget,
                                      fixed(row.errors.front().psnr_worst, 1)),
                          read_bytes((fs::path(folder) / row.worst).string())});
    return places;
}

} // namespace sparselens::lab
