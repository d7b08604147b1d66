// The window grows with each look: the picture of an element is the same whether its data window is tight or large.
#include "base/error.h"
#include "chain/gather_windows.h"
#include "deep/flatten.h"
#include "deep/proxy.h"
#include "dof/gather_picture.h"
#include "io/files/memory_limit.h"
#include "support/lens_ldi.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.1, .focal_px = 400, .focus = 5}; // CoC up to 8 px behind focus
const Imath::Box2i display({0, 0}, {191, 127});

// A square with that CoC, off the axis.
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
    GatherWindows frame = gather_windows({}, in);
    choose_windows(frame, {}, in, by, looks);
    PictureOptions options;
    options.gather.lens = {.lens_samples = 256, .looks = looks};
    Progress silent;
    return gather_picture(frame.ldi(in), by, frame.gathered, frame.needed, options, silent);
}

TEST(GatherWindows, GrowAsFarAsTheLooksSpreadLight) {
    const LensLooks squeezed{.aperture = {.squeeze = 0.4}}, curved{.field_curvature = 2},
        tilted{.tilt = {0.9, -0.3}}, chromatic{.chromatic_coc = {3, 0, -3}}, breathing{.magnification = 1.2};
    for (const double coc : {-6.0, 5.0})
        for (const LensLooks &looks : {LensLooks{}, squeezed, curved, tilted, chromatic, breathing}) {
            OpenedLdi in = element(coc);
            for (Channel &channel : in.ldi.channels)
                if (channel.name == "Y") channel.name = "R"; // chromatic aberration spreads R
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

// Fine pixels of an element that begins and ends within blocks, with a lens of radius 0: the mean of each block, empty
// beside the element. A part of it has the same values.
TEST(GatherWindows, HaveWholeBlocksOfSubpixels) {
    OpenedLdi in = element(0);
    in.ldi.windows.data = {{141, 31}, {152, 42}};
    in.header.dataWindow() = in.ldi.windows.data;
    const auto made = [&](const WindowOptions &options) {
        ThinLens sharp = lens;
        sharp.radius = 0;
        GatherWindows frame = gather_windows(options, in);
        choose_windows(frame, options, in, sharp, {});
        PictureOptions by;
        Progress silent;
        return frame.picture_of(
            gather_picture(frame.ldi(in), sharp, frame.gathered, frame.needed, by, silent));
    };
    const Image all = made({.supersample = 2});
    EXPECT_EQ(all.windows.display, Imath::Box2i({0, 0}, {95, 63}));
    EXPECT_EQ(all.windows.data, Imath::Box2i({70, 15}, {76, 21}));
    EXPECT_FLOAT_EQ(all.at(1, 70, 15), 0.25f);
    EXPECT_FLOAT_EQ(all.at(1, 70, 17), 0.5f);
    EXPECT_FLOAT_EQ(all.at(0, 73, 17), 0.8f);
    double covered = 0;
    for (const float a : all.plane(1)) covered += double(a);
    EXPECT_NEAR(covered, 144.0 / 4, 1e-5);
    const Imath::Box2i part({71, 16}, {74, 18});
    const PixelFilter wide{PixelFilter::Shape::gaussian, 2};
    const Image filtered = made({.supersample = 2, .filter = wide}),
                some = made({.region = part, .supersample = 2, .filter = wide});
    EXPECT_EQ(some.values, crop(filtered, part).values);
    const Image joined = made({.supersample = 2, .joins_subpixels = true});
    EXPECT_EQ(joined.windows, all.windows);
    for (std::size_t k = 0; k < 2; ++k)
        for (const Imath::V2i &at : {Imath::V2i(70, 15), Imath::V2i(70, 17), Imath::V2i(73, 17)})
            EXPECT_NEAR(joined.at(k, at.x, at.y), all.at(k, at.x, at.y), 1e-6);
    in.camera.supersample = 2;
    EXPECT_EQ(made({}).values, all.values);
    EXPECT_EQ(made({.supersample = 1}).windows.data, in.ldi.windows.data);
    EXPECT_THROW(made({.supersample = 5}), UsageError);
    in.camera.supersample = 1;
    EXPECT_EQ(made({.proxy = 2, .supersample = 2}).windows, made({.proxy = 4}).windows);
}

// A lens of radius 0 spreads nothing, so a kept window shows the same as a grown one: areas that the file lacks are
// empty, including their data and depth. A wide filter carries light beyond the window.
TEST(GatherWindows, KeepTheLightOfPixelsThatAreCovered) {
    OpenedLdi in = element(0);
    in.ldi.windows.data = {{141, 31}, {152, 42}};
    in.header.dataWindow() = in.ldi.windows.data;
    for (const PixelFilter &filter : {PixelFilter{}, PixelFilter{PixelFilter::Shape::blackman_harris, 3}}) {
        const auto made = [&](OutputOverscan overscan, bool depth) {
            const WindowOptions options{.overscan = overscan, .supersample = 4, .filter = filter};
            ThinLens sharp = lens;
            sharp.radius = 0;
            GatherWindows frame = gather_windows(options, in);
            choose_windows(frame, options, in, sharp, {});
            if (depth)
                return frame.picture_of(crop(front_depth(frame.ldi(in)), frame.needed), depth_of_nothing);
            Progress silent;
            return frame.picture_of(
                gather_picture(frame.ldi(in), sharp, frame.gathered, frame.needed, {}, silent));
        };
        const Image kept = made(OutputOverscan::keep, false), grown = made(OutputOverscan::grow, false);
        const auto there = [&kept](const Image &image) { return crop(image, kept.windows.data); };
        EXPECT_LT(largest_difference(kept, there(grown)), 1e-6);
        EXPECT_EQ(made(OutputOverscan::keep, true).values, there(made(OutputOverscan::grow, true)).values);
        double covered = 0;
        for (const float a : kept.plane(1)) covered += double(a);
        EXPECT_NEAR(covered, 144.0 / 16, 1e-5);
    }
}

const std::string none = "(nothing was thrown)"; // the answer of what_of()

// Views must be warped for the picture's pixels if these are more than two sub-pixels wide.
TEST(GatherWindows, TheWarpMustHaveKnownOfSubpixels) {
    OpenedLdi in = element(0);
    in.name = "x.exr";
    in.camera.lens_points = {{0, 0}, {1, 0}};
    const auto says = [&](int across) {
        return what_of<UsageError>([&] { subpixels_of({.supersample = across}, in); });
    };
    EXPECT_EQ(says(2), none);
    EXPECT_EQ(says(4),
              "x.exr: it was warped for pixels of 1 x 1, not of 4 x 4: give `supersample` 4 where its views "
              "are warped");
    in.camera.supersample = 4;
    for (const int across : {1, 2, 4}) EXPECT_EQ(says(across), none);
    in.camera = {};
    EXPECT_EQ(says(4), none); // not made of views
}

TEST(GatherWindows, CopiesCountAsMemory) {
    struct Limit {
        explicit Limit(std::uint64_t bytes) { set_memory_limit(bytes); }
        ~Limit() { set_memory_limit({}); }
    };
    OpenedLdi in = element(0);
    in.name = "x.exr";
    in.ldi.dx = in.ldi.dy = in.ldi.weight = {};
    // 144 samples with two channels and a depth; the first sample index of each of 144 pixels, and the end of the last.
    constexpr std::uint64_t bytes = 144 * 3 * 4 + 145 * 8;
    const auto raised = [&](std::uint64_t limit) {
        GatherWindows frame;
        const Limit set(limit);
        return what_of<Error>([&] { raise_highlights(frame, in, {.gain = 2}); });
    };
    EXPECT_EQ(raised(2 * bytes), none);
    EXPECT_EQ(raised(2 * bytes - 1), "x.exr: asks for 1 MB of memory, more than `max_memory` allows");
    Ldi coarse = in.ldi;
    coarse.windows.display = {{0, 0}, {95, 63}};
    coarse.windows.data = {{70, 15}, {81, 26}};
    const auto held = [&](std::uint64_t limit) {
        const Limit set(limit);
        return what_of<Error>([&] { holdout_for(in, {.supersample = 2}, coarse, "card.exr"); });
    };
    EXPECT_EQ(held(5 * bytes), none);
    EXPECT_EQ(held(5 * bytes - 1), "card.exr: asks for 1 MB of memory, more than `max_memory` allows");
}

TEST(HoldoutFor, IsAsLargeAsTheLdiOrAsThePicture) {
    const OpenedLdi in = element(0);
    const Ldi coarse = make_ldi(windows_of_size(96, 64), {{"A"}}, [](int x, int y) {
        return std::vector<Sample>{{double(1 + x + 100 * y), {1}}};
    });
    const Ldi fine = holdout_for(in, {.supersample = 2}, coarse, "holdout");
    EXPECT_EQ(fine.windows.data, Imath::Box2i({0, 0}, {191, 127}));
    for (const Imath::V2i &at : {Imath::V2i(0, 0), Imath::V2i(191, 127), Imath::V2i(57, 100)})
        EXPECT_EQ(fine.z[fine.pixel(fine.windows.index(at)).front()], float(1 + at.x / 2 + 100 * (at.y / 2)));
    EXPECT_THROW(holdout_for(in, {}, coarse, "holdout"), Error);
    EXPECT_EQ(holdout_for(in, {.proxy = 2, .supersample = 2}, coarse, "holdout").windows.display,
              Imath::Box2i({0, 0}, {47, 31}));
}

} // namespace
} // namespace sparselens
