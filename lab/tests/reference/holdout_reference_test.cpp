// A picture with a holdout: the fast gather compared with the slow one.
#include "deep/merge.h"
#include "dof/lens/lens_gather.h"
#include "lab/tests/support/reference_picture.h"
#include "lens/lens_samples.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

Image gather(const Ldi &ldi, const Holdout *holdout, int points) {
    Progress silent;
    return lens_gather(ldi, lens, ldi.windows.data, {.lens_samples = points, .holdout = holdout}, silent);
}

TEST(Holdout, FastIsAsTheReference) {
    const Windows windows = windows_of_size(70, 9);
    for (const bool opaque : {true, false}) {
        Ldi ldi = random_surfaces(windows, lens, opaque, 5);
        for (auto &values : ldi.values) // no lamps: the reference does not spread highlights
            for (float &v : values) v = std::min(v, 1.0f);
        for (Channel &channel : ldi.channels) // without names of colours nothing is sharpened
            if (channel.name != "A") channel.name = "layer." + channel.name;
        const Holdout holdout(random_surfaces(windows, lens, false, 11));
        const auto points = disc_lens_samples(64, lens.pixel_aspect);
        const Image fast = gather(ldi, &holdout, 64);
        expect_within(fast, lens_gather_reference(ldi, lens, windows.data, points, &holdout));
        EXPECT_GT(largest_difference(fast, gather(ldi, nullptr, 64)), 0.5);
    }
}

} // namespace
} // namespace sparselens
