#include "common/pictures.h"

#include "base/error.h"
#include "io/camera_metadata.h"
#include "io/exr_flat.h"

namespace sparselens {

namespace {

// visit(to_planar) for every pixel in order, where to_planar turns a depth value of that pixel into planar depth.
template <typename Visit>
void for_each_pixel(const Windows &w, const DepthOptions &depth, const Camera &camera, const Visit &visit) {
    if (depth.meaning == DepthMeaning::planar) return;
    const double focal_px = depth.meaning == DepthMeaning::distance ? resolve_focal_px(camera, w) : 1;
    for (int y = w.data.min.y; y <= w.data.max.y; ++y)
        for (int x = w.data.min.x; x <= w.data.max.x; ++x)
            visit([&](float z) { return float(planar_depth(depth.meaning, double(z), x, y, w, focal_px)); });
}

void make_planar(Ldi &ldi, const DepthOptions &depth, const Camera &camera) {
    std::size_t pixel = 0;
    for_each_pixel(ldi.windows, depth, camera, [&](const auto &planar) {
        for (std::uint64_t i = ldi.begin[pixel]; i < ldi.begin[pixel + 1]; ++i) {
            ldi.z[i] = planar(ldi.z[i]);
            if (!ldi.z_back.empty()) ldi.z_back[i] = planar(ldi.z_back[i]);
        }
        ++pixel;
    });
}

} // namespace

LoadedLdi load_ldi(const std::string &path, const LensOptions &lens, const DepthOptions &depth) {
    LdiFile file = read_ldi(path, depth.channel);
    const Camera camera = camera_with_options(lens, read_camera(file.header));
    make_planar(file.ldi, depth, camera);
    return {tidy(std::move(file.ldi)), std::move(file.header), camera};
}

LoadedView load_view(const std::string &path, const LensOptions &lens, const DepthOptions &depth) {
    FlatFile file = read_flat_exr(path);
    LoadedView loaded{{path, std::move(file.image), {}, {0, 0}}, std::move(file.header), {}};
    View &view = loaded.view;
    view.z = take_depth(view.image, depth.channel, path);
    loaded.camera = read_camera(loaded.header);
    std::size_t pixel = 0;
    for_each_pixel(view.image.windows, depth, camera_with_options(lens, loaded.camera),
                   [&](const auto &planar) {
                       view.z[pixel] = planar(view.z[pixel]);
                       ++pixel;
                   });
    return loaded;
}

} // namespace sparselens
