// Extra vision: a layered picture that shows surfaces no view saw. An LDI warped from views has none; a scene cut into
// strata has some, and the same measure distinguishes them.
#include "lab/tests/support/traced.h"
#include "lab/trace/deep.h"
#include "lab/trace/scenes.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparselens {
namespace {

using namespace lab;

// Whether the view shows a surface within a pixel of disparity of the sample's, within a pixel of where it would
// see the sample. `p`: the sample's position in the centre view.
bool sees(const View &view, const ThinLens &lens, const Imath::V2d &p, double z) {
    const double shift = lens.focal_px / z;
    const int x = int(std::floor(p.x - shift * view.position.x)),
              y = int(std::floor(p.y + shift * view.position.y));
    const Imath::Box2i &data = view.image.windows.data;
    for (int j = std::max(y - 1, data.min.y); j <= std::min(y + 1, data.max.y); ++j)
        for (int i = std::max(x - 1, data.min.x); i <= std::min(x + 1, data.max.x); ++i) {
            const double seen = double(view.z[std::size_t(j * view.image.windows.width() + i)]);
            if (std::abs(disparity(lens, seen) - disparity(lens, z)) <= 1) return true;
        }
    return false;
}

std::size_t samples_no_view_saw(const Ldi &ldi, const std::vector<View> &views, const ThinLens &lens) {
    std::size_t unseen = 0, pixel = 0;
    const Imath::Box2i &data = ldi.windows.data;
    for (int y = data.min.y; y <= data.max.y; ++y)
        for (int x = data.min.x; x <= data.max.x; ++x, ++pixel)
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                const Imath::V2d offset =
                    ldi.dx.empty() ? Imath::V2d(0, 0) : Imath::V2d(double(ldi.dx[i]), double(ldi.dy[i]));
                const Imath::V2d p = Imath::V2d(x + 0.5, y + 0.5) + offset;
                unseen += std::ranges::none_of(
                    views, [&](const View &view) { return sees(view, lens, p, double(ldi.z[i])); });
            }
    return unseen;
}

TEST(ExtraVision, AbsentFromWarpedViewsPresentInStrata) {
    const SceneCamera camera(build_scene("fence"), {.radius = 0.06, .focal_px = 96, .focus = 5}, 96, 54);
    const RenderSettings &settings = camera.settings;
    std::vector<View> views;
    for (const Imath::V2d &u :
         {Imath::V2d(0, 0), Imath::V2d(1, 0), Imath::V2d(0, 1), Imath::V2d(-1, 0), Imath::V2d(0, -1)})
        views.push_back(camera.view(u, 1, 0));
    Progress silent;
    for (const Merge merge : {Merge::average, Merge::keep}) {
        const Ldi ldi =
            warp(views, {.focal_px = 96, .radius = 0.06, .merge = merge, .extend_surfaces = false}, silent);
        EXPECT_EQ(samples_no_view_saw(ldi, views, settings.lens), 0u);
        EXPECT_GT(ldi.samples(), settings.windows.pixels());
    }
    const Ldi strata = render_strata(camera.tracer, settings, 4, 1, 0, silent);
    EXPECT_GT(samples_no_view_saw(strata, views, settings.lens), strata.samples() / 20);
}

} // namespace
} // namespace sparselens
