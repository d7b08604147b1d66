#include "lab/tests/support/traced.h"
#include "plan/plan.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using namespace lab;

// The pixels that the plan asks for suffice: views that are empty elsewhere uncover as much as whole views.
TEST(Plan, WhatItAsksForIsWhatIsHidden) {
    const SceneCamera scene("fence", 160, 90);
    const View centre = scene.view({0, 0}, 4, 0);
    Progress silent;
    const Plan plan = make_plan(centre, scene.settings.lens, {}, silent);
    std::vector<View> whole{centre}, asked{centre};
    for (const PlannedView &planned : plan.views) {
        whole.push_back(scene.view(planned.u, 4, 1));
        asked.push_back(whole.back());
        for (std::size_t i = 0; i < planned.mask.set.size(); ++i)
            if (!planned.mask.set[i])
                for (std::size_t k = 0; k < 4; ++k) asked.back().image.plane(k)[i] = 0;
    }
    const WarpOptions options{
        .focal_px = scene.settings.lens.focal_px, .radius = scene.settings.lens.radius, .merge = Merge::keep};
    const auto hidden = [&](const std::vector<View> &views) {
        const Ldi ldi = warp(views, options, silent);
        return double(ldi.samples() - ldi.windows.pixels());
    };
    EXPECT_GT(hidden(whole), 500);
    EXPECT_GT(hidden(asked), 0.93 * hidden(whole));
}

} // namespace
} // namespace sparselens
