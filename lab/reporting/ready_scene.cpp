#include "lab/reporting/ready_scene.h"

#include "base/error.h"
#include "lab/report/numbers.h"
#include "lab/reporting/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace sparselens::lab {

namespace {

namespace fs = std::filesystem;

// Keeps letters, digits and dots, because the name becomes part of file names, gnuplot strings and the page.
std::string plain_name(const std::string &name) {
    std::string result;
    for (const char c : name) result += std::isalnum(static_cast<unsigned char>(c)) || c == '.' ? c : '-';
    return result;
}

// "-denoised" for "denoised.exr".
std::string kind_of(const std::string &ending) {
    return ending == "exr" ? "" : '-' + ending.substr(0, ending.find('.'));
}

// N of drt_N.exr, or of drt_N with another ending.
std::optional<int> rays_of(const std::string &file, const std::string &ending) {
    int rays = 0;
    const char *begin = file.data() + 4, *end = file.data() + file.size();
    if (!file.starts_with("drt_")) return {};
    const auto [rest, error] = std::from_chars(begin, end, rays);
    if (error != std::errc() || std::string(rest, end) != '.' + ending) return {};
    return rays;
}

// The frames of a focus pull: NAME.pull.0001.exr and so on, beside the picture NAME.exr.
std::vector<std::string> pull_of(const fs::path &folder, const std::string &file) {
    return matching_files(folder / (fs::path(file).replace_extension().string() + ".pull.*.exr"));
}

} // namespace

ReadyScene::ReadyScene(const fs::path &folder)
    : folder_(fs::absolute(folder).lexically_normal()), camera_(read_camera_summary(folder)) {
    if (!folder_.has_filename()) folder_ = folder_.parent_path();
    name_ = plain_name(folder_.filename().string());
    if (!fs::exists(folder_ / "reference.exr"))
        throw Error((folder_ / "reference.exr").string() + ": no such file");
    views_.push_back({folder_, camera_});
    for (const fs::directory_entry &entry : fs::directory_iterator(folder_)) {
        if (!entry.is_directory() || !fs::exists(entry.path() / "camera.json")) continue;
        const CameraSummary camera = read_camera_summary(entry.path());
        (camera.supersample > 1 ? fine_ : views_).push_back({entry.path(), camera});
    }
    for (ViewFolders *folders : {&views_, &fine_}) {
        const auto samples = [](const ViewFolder &v) { return v.camera.view_samples; };
        std::ranges::sort(*folders, {}, [&](const ViewFolder &v) { return std::pair(samples(v), v.path); });
        const auto same = [&](const ViewFolder &a, const ViewFolder &b) { return samples(a) == samples(b); };
        folders->erase(std::unique(folders->begin(), folders->end(), same), folders->end());
    }
}

LensValues ReadyScene::lens() const {
    return {.focal_length_mm = camera_.focal_mm,
            .sensor_width_mm = camera_.sensor_width_mm,
            .fstop = {},
            .lens_radius = camera_.lens_radius,
            .focus_distance = camera_.focus_distance,
            .scene_unit = {}};
}

std::vector<int> ReadyScene::samples() const {
    std::vector<int> counts;
    for (const ViewFolder &folder : views_) counts.push_back(folder.camera.view_samples);
    return counts;
}

std::vector<int> ReadyScene::fine_samples() const {
    std::vector<int> counts;
    for (const ViewFolder &folder : fine_) counts.push_back(folder.camera.view_samples);
    return counts;
}

std::vector<int> ReadyScene::rays(const std::string &ending) const {
    std::vector<int> counts;
    for (const auto &[file, seconds] : camera_.seconds)
        if (const auto rays = rays_of(file, ending); rays && fs::exists(folder_ / file))
            counts.push_back(*rays);
    std::ranges::sort(counts);
    return counts;
}

Rendered ReadyScene::reference(StepList &) const {
    return {.folder = name_ + "/reference", .picture = (folder_ / "reference.exr").string()};
}

// Takes every (N / rim)-th of N views that are evenly spaced on the rim.
std::optional<Rendered> ReadyScene::views(const ViewFolders &folders, int rim, int samples,
                                          const std::string &ending) const {
    const auto found =
        std::ranges::find_if(folders, [&](const ViewFolder &v) { return v.camera.view_samples == samples; });
    const std::vector<Imath::V2d> &points = found->camera.views;
    const auto wanted = std::size_t(rim);
    const auto view_name = [&](std::size_t k) { return fmt::format("view_{}.{}", k, ending); };
    const std::string centre = "center." + ending;
    if (wanted > points.size() || (wanted > 0 && points.size() % wanted != 0)) return {};
    if (!found->camera.seconds.contains(centre)) return {};
    Rendered views{.folder =
                       fmt::format("{}/{}{}-{}x{}", name_, found->camera.supersample == 1 ? "views" : "fine",
                                   kind_of(ending), 1 + rim, samples),
                   .picture = (found->path / centre).string(),
                   .ready_seconds = found->camera.seconds.at(centre),
                   .views = 1 + rim,
                   .rays = double((1 + rim) * samples),
                   .supersample = found->camera.supersample};
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t k = i * (points.size() / wanted);
        const Imath::V2d position = found->camera.lens_radius * points[k];
        views.rim.push_back(
            {(found->path / view_name(k)).string(), shortest(position.x) + ',' + shortest(position.y)});
        views.ready_seconds += found->camera.seconds.at(view_name(k));
    }
    return views;
}

Rendered ReadyScene::distributed(int rays, const std::string &ending) const {
    const std::string file = fmt::format("drt_{}.{}", rays, ending);
    return Rendered{.folder = fmt::format("{}/traced{}-{}", name_, kind_of(ending), rays),
                    .picture = (folder_ / file).string(),
                    .ready_seconds = camera_.seconds.at(file),
                    .rays = double(rays),
                    .pull = pull_of(folder_, file)};
}

std::vector<Finished> ReadyScene::finished() const {
    std::vector<Finished> pictures;
    for (const OtherPicture &other : camera_.others) {
        const auto seconds = camera_.seconds.find(other.file);
        if (seconds == camera_.seconds.end())
            throw Error((folder_ / "camera.json").string() + ": no seconds of " + other.file);
        pictures.push_back({other.renderer,
                            other.processor,
                            other.budget,
                            {.folder = name_ + '/' + plain_name(other.file),
                             .picture = (folder_ / other.file).string(),
                             .ready_seconds = seconds->second,
                             .rays = other.rays,
                             .pull = pull_of(folder_, other.file)}});
    }
    return pictures;
}

} // namespace sparselens::lab
