// Growth with each look: the picture of an element is the same whether its data window is tight or large.
#include "deep/pad.h"
#include "dof/gather_picture.h"
#include "io/gather_windows.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.1, .focal_px = 400, .focus = 5}; // CoC up to 8 px behind focus
const Imath::Box2i display({0, 0}, {191, 127});

// A square at that CoC, off the axis.
OpenedLdi element(double coc) {
    Windows windows;
    windows.display = display;
    windows.data = {{140, 30}, {151, 41}};
    OpenedLdi opened;
    opened.ldi = make_ldi(windows, {{"Y"}, {"A"}}, [&](int, int) {
        return std::vector<Sample>{{depth_of(lens, coc), {0.8f, 1}}};
    });
    opened.header = Imf::Header(windows.display, windows.data);
    return opened;
}

Image gathered(const OpenedLdi &in, const LensLooks &looks) {
    ThinLens by = lens;
    GatherWindows frame = gather_windows({}, in, by);
    choose_windows(frame, {}, in, by, looks);
    PictureOptions options;
    options.gather.lens = {.lens_samples = 256, .looks = looks};
    Progress silent;
    return gather_picture(frame.ldi(in), by, frame.gathered, frame.written, options, silent);
}

TEST(GatherWindows, GrowAsFarAsTheLooksSpreadLight) {
    const LensLooks squeezed{.aperture = {.squeeze = 0.4}}, curved{.field_curvature = 2},
        tilted{.tilt = {0.9, -0.3}}, chromatic{.chromatic_coc = {3, 0, -3}}, breathing{.magnification = 1.2};
    for (const double coc : {-6.0, 5.0})
        for (const LensLooks &looks : {LensLooks{}, squeezed, curved, tilted, chromatic, breathing}) {
            OpenedLdi in = element(coc);
            for (Channel &channel : in.ldi.channels)
                if (channel.name == "Y") channel.name = "R"; // which chromatic aberration spreads
            const Image tight = gathered(in, looks);
            in.ldi = padded(in.ldi, display);
            in.header.dataWindow() = display;
            const Image whole = gathered(in, looks);
            EXPECT_EQ(whole.windows.data, display);
            EXPECT_LT(tight.windows.pixels(), whole.windows.pixels() / 4);
            double light = 0, lost = 0;
            for (int y = 0; y <= display.max.y; ++y)
                for (int x = 0; x <= display.max.x; ++x) {
                    const double all = double(whole.at(0, x, y));
                    const bool in_tight = tight.windows.data.intersects(Imath::V2i(x, y));
                    light += all;
                    lost += all - (in_tight ? double(tight.at(0, x, y)) : 0);
                    if (in_tight) continue;
                    ASSERT_EQ(all, 0) << x << "," << y;
                }
            EXPECT_NEAR(lost / light, 0, 2e-3)
                << coc << " squeeze " << looks.aperture.squeeze << " curvature " << looks.field_curvature
                << " tilt " << looks.tilt << " chromatic " << looks.chromatic_coc[0] << " magnification "
                << looks.magnification;
        }
}

} // namespace
} // namespace sparselens
