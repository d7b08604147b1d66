#include "loading/pictures.h"

#include "base/error.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/proxy.h"
#include "deep/tidy.h"
#include "io/camera/camera_read.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"

#include <algorithm>
#include <limits>

namespace sparselens {

namespace {

// Turns what a file's depth channel holds into planar depth.
class DepthReader {
public:
    DepthReader(const Windows &windows, const DepthOptions &depth, const Camera &camera)
        : windows_(windows), meaning_(depth.meaning), far_(depth.far),
          focal_px_(meaning_ == DepthMeaning::distance ? resolve_focal_px(camera, windows) : 1),
          principal_point_(camera.principal_point.value_or(Imath::V2d(0, 0))) {}

    // Of the i-th pixel of the data window; what is no depth stays none (see bad_values.h).
    float planar(float value, std::size_t i) const {
        if (is_sky(meaning_, double(value), far_)) return std::numeric_limits<float>::infinity();
        if (meaning_ == DepthMeaning::planar) return value;
        const Imath::V2i p = pixel(i);
        return float(planar_depth(meaning_, double(value), p.x, p.y, windows_, focal_px_, principal_point_));
    }

private:
    Imath::V2i pixel(std::size_t i) const {
        const std::size_t width = std::size_t(windows_.width());
        return windows_.data.min + Imath::V2i(int(i % width), int(i / width));
    }

    const Windows &windows_;
    DepthMeaning meaning_;
    double far_;
    double focal_px_;
    Imath::V2d principal_point_;
};

// `camera`, with the frustum of another one where it knows nothing of its own.
Camera with_frustum_of(const Camera &other, Camera camera) {
    if (!camera.focal_length_mm && !camera.sensor_width_mm && !camera.field) {
        camera.focal_length_mm = other.focal_length_mm;
        camera.sensor_width_mm = other.sensor_width_mm;
        camera.field = other.field;
    }
    if (!camera.principal_point) camera.principal_point = other.principal_point;
    return camera;
}

} // namespace

LoadedLdi load_ldi(const std::string &path, const LensOptions &lens, const DepthOptions &depth) {
    LdiFile file = read_ldi(path, depth.channel, depth.view);
    Ldi &ldi = file.ldi;
    const Camera camera = camera_with_options(lens, read_camera(file.header));
    const DepthReader read(ldi.windows, depth, camera);
    for (std::size_t pixel = 0; pixel + 1 < ldi.begin.size(); ++pixel)
        for (std::uint64_t i = ldi.begin[pixel]; i < ldi.begin[pixel + 1]; ++i) {
            ldi.z[i] = read.planar(ldi.z[i], pixel);
            if (!ldi.z_back.empty()) ldi.z_back[i] = read.planar(ldi.z_back[i], pixel);
        }
    const InvalidValues bad = sanitize(ldi, display_name(path));
    const std::size_t in_file = ldi.samples();
    ldi = tidy(std::move(ldi));
    const std::size_t invisible = in_file - std::min(in_file, ldi.samples());
    return {std::move(ldi), std::move(file.header), camera, bad, invisible, std::move(file.notes)};
}

std::optional<Holdout> load_holdout(const std::string &path, const Windows &windows, int proxy_factor,
                                    const LensOptions &lens, const DepthOptions &depth) {
    if (path.empty()) return {};
    LoadedLdi loaded = load_ldi(path, lens, depth);
    if (loaded.ldi.windows.display != windows.display)
        throw Error(display_name(path) + ": its display window is not that of the picture it holds out");
    return Holdout(proxy_factor == 1 ? std::move(loaded.ldi) : proxy(loaded.ldi, proxy_factor));
}

LoadedView load_view(const std::string &path, const LensOptions &lens, const DepthOptions &depth,
                     const Camera &otherwise) {
    FlatFile file = read_flat_exr(path, depth.view);
    LoadedView loaded{{display_name(path), std::move(file.image), {}}, std::move(file.header), {}, {}};
    View &view = loaded.view;
    view.z = take_depth(view.image, depth.channel, path);
    loaded.camera = read_camera(loaded.header);
    const Camera camera = camera_with_options(lens, with_frustum_of(otherwise, loaded.camera));
    const DepthReader read(view.image.windows, depth, camera);
    for (std::size_t i = 0; i < view.z.size(); ++i) view.z[i] = read.planar(view.z[i], i);
    loaded.bad = sanitize(view);
    return loaded;
}

void say_samples(const ToolContext &tool, const std::string &path, const LoadedLdi &loaded) {
    for (const std::string &note : loaded.notes) tool.say(display_name(path) + ": " + note);
    if (tool.verbose && by_coverage(loaded.ldi).size() > 1)
        tool.say(display_name(path) + ": coverage is coloured (AR, AG, AB): each colour has its own");
}

void say_camera(const ToolContext &tool, const std::string &path, const Camera &camera) {
    for (const std::string &found : camera.found) tool.say(display_name(path) + ": " + found);
    for (const auto &[option, reason] : camera.unsure)
        tool.say(display_name(path) + ": " + reason + "; " + option + " settles it");
}

void warn_of_clamped(const ToolContext &tool, const std::string &path, std::size_t clamped) {
    if (clamped > 0)
        warn(tool, display_name(path) + ": " + std::to_string(clamped) +
                       " values beyond the range of half are clamped to 65504");
}

void warn_of_invalid_values(const ToolContext &tool, const std::string &path, const InvalidValues &bad) {
    if (bad.any()) warn(tool, display_name(path) + ": " + bad.text());
}

} // namespace sparselens
