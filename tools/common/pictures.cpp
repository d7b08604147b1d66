#include "common/pictures.h"

#include "base/error.h"
#include "io/camera_metadata.h"
#include "io/exr_flat.h"
#include "io/file_stream.h"
#include "ldi/build.h"

#include <algorithm>
#include <limits>

namespace sparselens {

namespace {

// Turns what a file's depth channel holds into planar depth.
class DepthReader {
public:
    DepthReader(const std::string &path, const Windows &windows, const DepthOptions &depth,
                const Camera &camera)
        : path_(path), windows_(windows), meaning_(depth.meaning),
          focal_px_(meaning_ == DepthMeaning::distance ? resolve_focal_px(camera, windows) : 1) {}

    // Of the i-th pixel of the data window; not above 0 where the value is not.
    float planar(float value, std::size_t i) const {
        if (meaning_ == DepthMeaning::planar) return value;
        const Imath::V2i p = pixel(i);
        return float(planar_depth(meaning_, double(value), p.x, p.y, windows_, focal_px_));
    }

    // The same, always above 0: 0 says that nothing was hit, and where there is no coverage any value does.
    float z(float value, std::size_t i, float alpha) const {
        const float z = planar(value, i);
        if (z > 0) return z;
        if (z == 0 || alpha == 0) return std::numeric_limits<float>::infinity();
        const Imath::V2i p = pixel(i);
        throw Error(display_name(path_) + ": depth " + std::to_string(value) + " in pixel " +
                    std::to_string(p.x) + "," + std::to_string(p.y) +
                    " is no number above 0 (see --depth, --depth-channel)");
    }

private:
    Imath::V2i pixel(std::size_t i) const {
        const std::size_t width = std::size_t(windows_.width());
        return windows_.data.min + Imath::V2i(int(i % width), int(i / width));
    }

    const std::string &path_;
    const Windows &windows_;
    DepthMeaning meaning_;
    double focal_px_;
};

} // namespace

LoadedLdi load_ldi(const std::string &path, const LensOptions &lens, const DepthOptions &depth) {
    LdiFile file = read_ldi(path, depth.channel);
    Ldi &ldi = file.ldi;
    const Camera camera = camera_with_options(lens, read_camera(file.header));
    const DepthReader read(path, ldi.windows, depth, camera);
    const std::size_t alpha = ldi.alpha();
    for (std::size_t pixel = 0; pixel + 1 < ldi.begin.size(); ++pixel)
        for (std::uint64_t i = ldi.begin[pixel]; i < ldi.begin[pixel + 1]; ++i) {
            ldi.z[i] = read.z(ldi.z[i], pixel, alpha_at(ldi, alpha, i));
            if (!ldi.z_back.empty()) ldi.z_back[i] = std::max(ldi.z[i], read.planar(ldi.z_back[i], pixel));
        }
    return {tidy(std::move(ldi)), std::move(file.header), camera};
}

LoadedView load_view(const std::string &path, const LensOptions &lens, const DepthOptions &depth) {
    FlatFile file = read_flat_exr(path);
    LoadedView loaded{{path, std::move(file.image), {}}, std::move(file.header), {}};
    View &view = loaded.view;
    view.z = take_depth(view.image, depth.channel, path);
    loaded.camera = read_camera(loaded.header);
    const DepthReader read(path, view.image.windows, depth, camera_with_options(lens, loaded.camera));
    const std::size_t alpha = find_channel(view.image.channels, "A");
    for (std::size_t i = 0; i < view.z.size(); ++i)
        view.z[i] = read.z(view.z[i], i, alpha == npos ? 1 : view.image.plane(alpha)[i]);
    return loaded;
}

} // namespace sparselens
