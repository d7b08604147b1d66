// Whole pictures: layers, alpha, parts kept as gathered, different windows, non-finite values.
#include "base/error.h"
#include "finish/finish_picture.h"
#include "finish/synthetic.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
const ArrayGrid grid(64, 48);
const Windows windows = windows_of_size(64, 48);
const Colours truth = synthetic_truth(grid);

Image picture_of(const Colours &colours, const std::vector<Channel> &channels = rgba_channels()) {
    Image image(windows, channels);
    for (std::size_t c = 0; c < channels.size(); ++c)
        for (std::size_t i = 0; i < grid.size(); ++i) image.plane(c)[i] = colours[c % colours.size()][i];
    if (channels == rgba_channels()) std::ranges::fill(image.plane(3), 1.0f);
    return image;
}

Render render(std::uint32_t seed, double samples = 16, const std::string &name = "rays.exr") {
    return {name, picture_of(rays_of(truth, samples, seed)), samples};
}

FinishedPicture finished(Image gathered, const std::vector<Render> &renders) {
    TwoHalves halves(gathered);
    for (const Render &r : renders) halves.add(r);
    Progress silent;
    return finish_picture({std::move(gathered), std::move(halves)}, silent);
}

TEST(TwoHalves, ThreeRendersAreSharedOutEvenly) {
    TwoHalves halves(picture_of(truth));
    EXPECT_FALSE(halves.complete());
    halves.add(render(1, 32));
    EXPECT_FALSE(halves.complete());
    halves.add(render(2, 8));
    halves.add(render(3, 24));
    EXPECT_TRUE(halves.complete());
    EXPECT_EQ(halves.samples().mean, (std::array<double, 2>{32, 32}));
    const auto [first, second] = halves.take(1);
    const Image one = render(1, 32).image, two = render(2, 8).image, three = render(3, 24).image;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        ASSERT_EQ(first[i], one.plane(1)[i]);
        ASSERT_NEAR(second[i], 0.25f * two.plane(1)[i] + 0.75f * three.plane(1)[i],
                    1e-5f * (1 + std::abs(second[i])));
    }
}

TEST(TwoHalves, EqualRendersTakeTurns) {
    TwoHalves halves(picture_of(truth));
    for (std::uint32_t seed = 1; seed <= 4; ++seed) halves.add(render(seed));
    EXPECT_EQ(halves.samples().mean, (std::array<double, 2>{32, 32}));
}

// Renders of a part go where it has fewer samples, and count there alone.
TEST(TwoHalves, RendersOfAPartAddTheirSamplesThere) {
    TwoHalves halves(picture_of(truth));
    halves.add(render(1, 10));
    halves.add(render(2, 10));
    const Imath::Box2i left({0, 0}, {31, 47}), right({32, 0}, {63, 47});
    const auto add_part = [&](std::uint32_t seed, double samples, const Imath::Box2i &box) {
        Render part = render(seed, samples);
        part.image = crop(part.image, box);
        halves.add(part);
        return part.image;
    };
    const Image more = add_part(3, 30, left);
    add_part(4, 20, right);
    add_part(5, 30, left);
    EXPECT_EQ(halves.missing(), 0u);
    const RayCounts samples = halves.samples();
    EXPECT_EQ(samples.mean, (std::array<double, 2>{35, 25}));
    EXPECT_EQ(samples.at(grid.index(Position(31, 5))), (std::array<float, 2>{40, 40}));
    EXPECT_EQ(samples.at(grid.index(Position(32, 5))), (std::array<float, 2>{30, 10}));
    const Image one = render(1, 10).image;
    const auto first = halves.take(1)[0];
    EXPECT_NEAR(first[grid.index(Position(20, 9))], 0.25f * one.at(1, 20, 9) + 0.75f * more.at(1, 20, 9),
                1e-5f);
}

// A channel of counts: whole numbers, or Cycles' part of the samples.
TEST(TwoHalves, PixelsHaveAsManySamplesAsTheRenderTells) {
    for (const auto &[name, one] : {std::pair("samples", 0.25f),
                                    {"sampleCount", 0.25f},
                                    {"ViewLayer.Debug Sample Count.X", 1.0f / 64}}) {
        std::vector<Channel> channels = rgba_channels();
        channels.push_back({name, PixelType::float32});
        Render counted{"rays.exr", Image(windows, channels), 16};
        for (std::size_t c = 0; c < 3; ++c) std::ranges::copy(truth[c], counted.image.plane(c).begin());
        for (std::size_t i = 0; i < grid.size(); ++i) counted.image.plane(4)[i] = one * float(i % 3);
        TwoHalves halves(picture_of(truth));
        halves.add(counted);
        halves.add(render(2));
        EXPECT_EQ(halves.missing(), grid.size() / 3) << name;
        EXPECT_EQ(halves.samples().at(1), (std::array<float, 2>{0.25f, 16})) << name;
        EXPECT_EQ(halves.samples().at(2), (std::array<float, 2>{0.5f, 16})) << name;
        EXPECT_EQ(halves.samples().at(0), (std::array<float, 2>{0.375f, 16}))
            << "the mean, where it has none";
    }
}

TEST(TwoHalves, PartsAreComparedWhereTheyMeet) {
    TwoHalves halves(picture_of(truth));
    const auto add_part = [&](std::uint32_t seed, const Imath::Box2i &box) {
        Render part = render(seed);
        part.image = crop(part.image, box);
        halves.add_noisy(part);
    };
    add_part(1, {{0, 0}, {31, 47}});
    add_part(1, {{32, 0}, {63, 47}});
    EXPECT_THROW(add_part(1, {{8, 4}, {63, 47}}), Error);
    add_part(2, {{8, 4}, {63, 47}});
}

// A rectangle of the background alone: its rim says nothing.
TEST(TwoHalves, PartsWithoutNoiseCannotTell) {
    TwoHalves halves(picture_of(truth));
    Render part{"rays.exr", picture_of(Colours(3, Values(grid.size(), 0.02f)))};
    part.image = crop(part.image, {{8, 4}, {55, 11}});
    halves.add_noisy(part);
    halves.add_noisy(part);
}

// Blender's render of a border has zeros around it, or a display window of its own.
TEST(TwoHalves, BordersAreParts) {
    const Imath::Box2i border({10, 6}, {40, 30});
    const Image gathered = picture_of(truth);
    const auto added = [&](std::uint32_t first, const auto &change) {
        TwoHalves halves(gathered);
        for (std::uint32_t seed = 1; seed <= 4; ++seed) {
            Render noisy = render(seed);
            if (seed >= first) change(noisy.image);
            halves.add_noisy(noisy);
        }
        return halves;
    };
    const auto cropped = [&](Image &image) { image = crop(image, border); };
    const auto blackened = [&](Image &image) {
        for (std::size_t i = 0; i < grid.size(); ++i)
            if (!border.intersects(image.windows.pixel(i)))
                for (std::size_t c = 0; c < 4; ++c) image.plane(c)[i] = 0;
    };
    const auto apart = [&](Image &image) {
        image = crop(image, border);
        image.windows.display = border;
    };
    for (const std::uint32_t first : {1u, 3u}) {
        TwoHalves expected = added(first, cropped);
        const std::array<Values, 2> planes = expected.take(1);
        for (TwoHalves halves : {added(first, blackened), added(first, apart)}) {
            EXPECT_EQ(halves.missing(), first == 1 ? grid.size() - Grid(border).size() : 0);
            EXPECT_EQ(halves.samples().by_pixel, expected.samples().by_pixel);
            const auto same = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
            const auto found = halves.take(1);
            for (std::size_t k = 0; k < 2; ++k) EXPECT_TRUE(std::ranges::equal(found[k], planes[k], same));
        }
    }
}

// Zeros around an element, where the gathered picture has nothing, are rendered; a black picture is.
TEST(TwoHalves, NothingAroundAnElementIsRendered) {
    const Imath::Box2i element({10, 6}, {40, 30});
    for (const bool black : {false, true}) {
        Image gathered = picture_of(truth);
        Render first = render(1), second = render(2);
        for (Image *image : {&gathered, &first.image, &second.image})
            for (std::size_t i = 0; i < grid.size(); ++i)
                if (black || !element.intersects(image->windows.pixel(i)))
                    for (std::size_t c = 0; c < 4; ++c) image->plane(c)[i] = 0;
        TwoHalves halves(gathered);
        halves.add_noisy(first);
        halves.add_noisy(second);
        EXPECT_EQ(halves.missing(), 0u);
    }
}

TEST(TwoHalves, AnotherPictureIsAnErrorThatNamesTheFile) {
    TwoHalves halves(picture_of(truth));
    const auto refused = [&](const std::string &named, const auto &change) {
        Render other = render(1);
        change(other.image.windows);
        try {
            halves.add(other);
            FAIL() << "taken";
        } catch (const Error &error) {
            EXPECT_EQ(std::string(error.what()).find("rays.exr: its p" + named), 0u) << error.what();
        }
    };
    refused("icture is 65x48, the gathered one 64x48", [](Windows &w) { w.display.max.x += 1; });
    refused("icture is 64x48 at 4,-2, the gathered one 64x48", [](Windows &w) {
        w.display = {w.display.min + Imath::V2i(4, -2), w.display.max + Imath::V2i(4, -2)};
    });
    refused("ixel aspect ratio is 2, that of the gathered picture 1", [](Windows &w) { w.pixel_aspect = 2; });
}

TEST(TwoHalves, TheSameNoiseTwiceIsAnErrorThatNamesBoth) {
    TwoHalves halves(picture_of(truth));
    Render first = render(1), second = render(2), again = first;
    second.name = "two.exr", again.name = "again.exr";
    halves.add_noisy(first);
    halves.add_noisy(second);
    for (int x = 0; x < grid.width(); ++x) again.image.at(1, x, 3) *= 1.5f; // of 48 rows
    try {
        halves.add_noisy(again);
        FAIL() << "taken";
    } catch (const Error &error) {
        EXPECT_EQ(std::string(error.what()),
                  "again.exr: has the same noise as rays.exr: render each with a seed of its own");
    }
    EXPECT_EQ(halves.samples().mean, (std::array<double, 2>{16, 16}));
    Render constant{"constant.exr", picture_of(Colours(3, Values(grid.size(), 0.5f)))}; // it cannot tell
    halves.add_noisy(constant);
    halves.add_noisy(constant);
}

TEST(TwoHalves, RendersWithoutTheirNoiseAreDoubted) {
    const Image gathered = picture_of(blurred(truth, grid, 1));
    const auto doubts = [&](const Render &first, const Render &second) {
        TwoHalves halves(gathered);
        halves.add_noisy(first);
        halves.add_noisy(second);
        Progress silent;
        return finish_picture({gathered, std::move(halves)}, silent).warnings;
    };
    const auto denoised = [](std::uint32_t seed) {
        return Render{"smooth.exr", picture_of(blurred(rays_of(truth, 16, seed), grid, 2)), 16};
    };
    EXPECT_EQ(doubts(render(1), render(2, 4)), std::vector<std::string>());
    ASSERT_EQ(doubts(denoised(1), denoised(2)).size(), 1u);
    EXPECT_EQ(doubts(denoised(1), denoised(2))[0].find("smooth.exr and smooth.exr do not differ by noise"),
              0u);
    for (const auto &given :
         {doubts(render(1), denoised(1)), doubts({"smooth.exr", gathered, 16}, render(2))}) {
        ASSERT_EQ(given.size(), 1u);
        EXPECT_EQ(given[0].find("smooth.exr has less noise than its samples tell"), 0u);
    }
}

// Overscan, and windows anywhere.
TEST(FinishPicture, PixelsAreTheSameWhereverTheWindowsBegin) {
    const auto at = [](const Imath::V2i &corner, const Imath::V2i &frame) {
        const auto placed = [&](Image image) {
            image.windows.data = {corner, corner + Imath::V2i(grid.width() - 1, grid.height() - 1)};
            image.windows.display = {frame, frame + Imath::V2i(grid.width() - 17, grid.height() - 17)};
            return image;
        };
        Image gathered = placed(picture_of(blurred(truth, grid, 1)));
        TwoHalves halves(gathered);
        for (const std::uint32_t seed : {1u, 2u}) {
            Render noisy = render(seed);
            noisy.image = placed(std::move(noisy.image));
            halves.add_noisy(noisy);
        }
        Progress silent;
        return finish_picture({std::move(gathered), std::move(halves)}, silent);
    };
    const FinishedPicture expected = at({0, 0}, {0, 0});
    EXPECT_EQ(expected.warnings, std::vector<std::string>());
    for (const Imath::V2i &corner : {Imath::V2i(-8, -8), {-37, -1001}, {200, 300}})
        for (const Imath::V2i &frame : {corner, corner + Imath::V2i(8)}) {
            const FinishedPicture found = at(corner, frame);
            EXPECT_EQ(found.warnings, expected.warnings) << corner;
            EXPECT_TRUE(found.image.values == expected.image.values) << corner;
            EXPECT_EQ(found.error.map, expected.error.map) << corner;
        }
}

// Renders with different data windows: where one has no data, the picture stays as gathered.
TEST(FinishPicture, WhereARenderSaysNothingItStaysAsGathered) {
    Render first = render(1), second = render(2);
    first.image = crop(first.image, {{0, 0}, {39, 47}});
    second.image.at(0, 5, 6) = nan;
    second.image.at(1, 7, 8) = inf;
    second.image.at(2, 9, 10) = 1e30f; // its square overflows
    const Image gathered = picture_of(blurred(truth, grid, 1));
    const FinishedPicture result = finished(gathered, {first, second});
    for (std::size_t c = 0; c < 3; ++c) {
        for (const Imath::V2i &at : {Imath::V2i(40, 10), {63, 47}, {5, 6}, {7, 8}, {9, 10}})
            EXPECT_NEAR(result.image.at(c, at.x, at.y), gathered.at(c, at.x, at.y), 0.1f);
        for (const float v : result.image.plane(c)) ASSERT_TRUE(std::isfinite(v));
    }
}

// The sun's disc is brighter than fits into the sums.
TEST(FinishPicture, WhatIsTooBrightToFinishStaysAsGathered) {
    Render first = render(1), second = render(2);
    Image gathered = picture_of(blurred(truth, grid, 1));
    for (Image *image : {&gathered, &first.image, &second.image})
        for (std::size_t c = 0; c < 3; ++c) image->at(c, 20, 20) = 2e9f;
    const FinishedPicture result = finished(gathered, {first, second});
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(result.image.at(c, 20, 20), 2e9f);
    for (std::size_t c = 0; c < 3; ++c)
        for (const float v : result.image.plane(c)) ASSERT_TRUE(std::isfinite(v));
}

TEST(FinishPicture, CountsThePixelsThatAreMissing) {
    TwoHalves halves(picture_of(truth));
    Render cut = render(1);
    cut.image = crop(cut.image, {{0, 0}, {31, 47}});
    halves.add(cut);
    halves.add(render(2));
    EXPECT_EQ(halves.missing(), 32u * 48u);
}

// A gathered picture may have overscan that the renders lack: nothing of the picture is missing there.
TEST(FinishPicture, OverscanIsNotMissing) {
    Windows wider = windows;
    wider.data = {{-3, -2}, {66, 49}};
    const Image within = picture_of(truth);
    Image gathered(wider, rgba_channels());
    for (std::size_t c = 0; c < 4; ++c)
        for (int y = 0; y < grid.height(); ++y)
            for (int x = 0; x < grid.width(); ++x) gathered.at(c, x, y) = within.at(c, x, y);
    TwoHalves halves(gathered);
    for (const std::uint32_t seed : {1u, 2u}) halves.add(render(seed));
    EXPECT_EQ(halves.missing(), 0u);
}

TEST(FinishPicture, OneRenderIsAnError) {
    EXPECT_THROW(finished(picture_of(truth), {render(1)}), Error);
    EXPECT_THROW(finished(picture_of(truth), {}), Error);
}

TEST(FinishPicture, LayersAreFinishedAndDataAndIdsStay) {
    std::vector<Channel> channels{{"R"}, {"G"}, {"B"}, {"A"}, {"key.R"}, {"key.G"}, {"key.B"}};
    channels.push_back({"Z", PixelType::float32, ChannelKind::data});
    channels.push_back({"objectid", PixelType::uint32, ChannelKind::light});
    Image gathered = picture_of(blurred(truth, grid, 2), channels);
    std::ranges::fill(gathered.plane(3), 1.0f);
    for (float &id : gathered.plane(8)) id = std::bit_cast<float>(77u);
    const auto rays = [&](std::uint32_t seed) {
        Render r{"rays.exr", picture_of(rays_of(truth, 256, seed), channels), 256};
        std::ranges::fill(r.image.plane(3), 1.0f);
        for (std::size_t i = 0; i < grid.size(); ++i) // channels in another order than when gathered
            for (std::size_t c = 4; c < 7; ++c)
                r.image.plane(c)[i] = rays_of({{truth[c - 4][i]}}, 256, seed + std::uint32_t(i))[0][0];
        return r;
    };
    const FinishedPicture result = finished(gathered, {rays(1), rays(50000)});
    EXPECT_NE(Values(result.image.plane(4).begin(), result.image.plane(4).end()),
              Values(gathered.plane(4).begin(), gathered.plane(4).end()));
    for (const std::size_t c : {3u, 7u})
        for (std::size_t i = 0; i < grid.size(); ++i)
            ASSERT_EQ(result.image.plane(c)[i], gathered.plane(c)[i]) << c;
    for (const float id : result.image.plane(8)) ASSERT_EQ(std::bit_cast<std::uint32_t>(id), 77u);
}

// Layers that add up to the beauty still do, and what is black in one of them stays black; others are left alone.
TEST(FinishPicture, LightGroupsAddUp) {
    const auto layered = [](const Colours &colours, float fill) {
        std::vector<Channel> channels = rgba_channels();
        for (const std::string layer : {"Combined_key.", "Combined_fill.", "gloss."})
            for (const char *colour : {"B", "G", "R"}) channels.push_back({layer + colour});
        Image image = picture_of(colours);
        Image all(windows, channels);
        for (std::size_t c = 0; c < 4; ++c) std::ranges::copy(image.plane(c), all.plane(c).begin());
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < grid.size(); ++i) {
                const float v = all.plane(2 - c)[i], part = grid.position(i).column < 24 ? 0 : fill;
                all.plane(4 + c)[i] = (1 - part) * v;
                all.plane(7 + c)[i] = part * v;
                all.plane(10 + c)[i] = 0.5f * v;
            }
        return all;
    };
    const auto rays = [&](std::uint32_t seed) {
        return Render{"rays.exr", layered(rays_of(truth, 16, seed), seed == 1 ? 0.3f : 0.5f), 16};
    };
    const auto most_apart = [&](const FinishedPicture &picture) {
        float apart = 0;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < grid.size(); ++i) {
                const float key = picture.image.plane(4 + c)[i], fill = picture.image.plane(7 + c)[i],
                            sum = picture.image.plane(2 - c)[i];
                apart = std::max(apart, std::abs(key + fill - sum) / (1 + std::abs(sum)));
            }
        return apart;
    };
    const Colours gathered = blurred(truth, grid, 2);
    const FinishedPicture together = finished(layered(gathered, 0.4f), {rays(1), rays(2)});
    EXPECT_LT(most_apart(together), 1e-5f);
    for (std::size_t i = 0; i < grid.size(); ++i)
        if (grid.position(i).column < 8) {
            ASSERT_NEAR(together.image.plane(7)[i], 0, 1e-6f);
        }
    // Some of the blue light is in no group.
    Image less = layered(gathered, 0.4f);
    for (float &v : less.plane(7)) v *= 0.97f;
    for (float &v : less.plane(4)) v *= 0.97f;
    const FinishedPicture alone = finished(less, {rays(1), rays(2)});
    EXPECT_GT(most_apart(alone), 1e-3f);
    for (std::size_t c = 10; c < 13; ++c)
        EXPECT_TRUE(std::ranges::equal(together.image.plane(c), alone.image.plane(c)));
}

TEST(FinishPicture, NamesTheLayersThatTheRendersLack) {
    const std::vector<Channel> channels{{"R"}, {"G"}, {"B"}, {"A"}, {"key.R"}, {"key.G"}, {"key.B"}};
    const Image gathered = picture_of(truth, channels);
    const FinishedPicture result = finished(gathered, {render(1), render(2)});
    EXPECT_EQ(result.as_gathered, (std::vector<std::string>{"key.R", "key.G", "key.B"}));
    for (std::size_t i = 0; i < grid.size(); ++i) ASSERT_EQ(result.image.plane(4)[i], gathered.plane(4)[i]);
}

TEST(FinishPicture, WithoutColoursInCommonIsAnError) {
    Render grey = render(1);
    grey.image = picture_of({truth[0]}, {{"Y"}});
    EXPECT_THROW(finished(picture_of(truth), {grey, grey}), Error);
}

// An element over nothing: its colours and its coverage are both 0 outside.
TEST(FinishPicture, AnElementOverNothingKeepsNothingAroundIt) {
    Image gathered = picture_of(truth);
    std::vector<Render> renders{render(1), render(2)};
    const auto cut_out = [](Image &image) {
        for (std::size_t c = 0; c < 4; ++c)
            for (std::size_t i = 0; i < grid.size(); ++i)
                if (grid.position(i).column >= 32) image.plane(c)[i] = 0;
    };
    cut_out(gathered);
    for (Render &r : renders) cut_out(r.image);
    const FinishedPicture result = finished(gathered, renders);
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t i = 0; i < grid.size(); ++i)
            if (grid.position(i).column >= 32) {
                ASSERT_EQ(result.image.plane(c)[i], 0) << c << ' ' << i;
            }
    for (std::size_t i = 0; i < grid.size(); ++i) {
        ASSERT_GE(result.image.plane(3)[i], 0);
        ASSERT_LE(result.image.plane(3)[i], 1);
    }
}

// Filters with negative lobes give renders an alpha above 1.
TEST(FinishPicture, AlphaIsAtMostOne) {
    Image gathered = picture_of(truth);
    std::vector<Render> renders{render(1), render(2)};
    std::ranges::fill(gathered.plane(3), 0.8f);
    for (Render &r : renders) std::ranges::fill(r.image.plane(3), 1.05f);
    const FinishedPicture result = finished(gathered, renders);
    for (const float alpha : result.image.plane(3)) ASSERT_EQ(alpha, 1);
}

TEST(FinishPicture, EmptyRowsAndColumnsAroundChangeNothing) {
    const Imath::Box2i box({5, 9}, {50, 40});
    const auto of = [&](const Imath::Box2i &window) {
        const auto element = [&](const Image &image) {
            Image cut = crop(image, box), all(windows, image.channels);
            for (std::size_t c = 0; c < 4; ++c)
                for (int y = box.min.y; y <= box.max.y; ++y)
                    for (int x = box.min.x; x <= box.max.x; ++x) all.at(c, x, y) = cut.at(c, x, y);
            return crop(all, window);
        };
        std::vector<Render> renders{render(1), render(2)};
        for (Render &r : renders) r.image = element(r.image);
        return finished(element(picture_of(blurred(truth, grid, 1))), renders);
    };
    const FinishedPicture expected = of(box), found = of(windows.data);
    EXPECT_TRUE(crop(found.image, box).values == expected.image.values);
    EXPECT_EQ(found.error.mean, expected.error.mean);
    EXPECT_EQ(found.part, box);
    EXPECT_EQ(expected.part, box);
    for (std::size_t i = 0; i < grid.size(); ++i)
        if (!box.intersects(windows.pixel(i))) {
            ASSERT_EQ(found.error.map[i], 0) << i;
        }
}

Colours colours_of(const Image &image) {
    Colours colours;
    for (std::size_t c = 0; c < 3; ++c) colours.emplace_back(image.plane(c).begin(), image.plane(c).end());
    return colours;
}

// Four frames of a still whose gathered pictures are all wrong: the picture gets better, and its estimate says so.
TEST(FinishPicture, FramesAroundOfAStillAreMoreRays) {
    const Colours gathered = rays_of(truth, 1, 100);
    const auto with = [&](std::uint32_t frames) {
        PictureToFinish picture{picture_of(gathered), TwoHalves(picture_of(gathered))};
        picture.rays.add(render(1));
        picture.rays.add(render(2));
        for (std::uint32_t k = 0; k < frames; ++k) {
            TwoHalves halves(picture_of(gathered));
            for (std::uint32_t half = 0; half < 2; ++half) halves.add(render(10 + 2 * k + half));
            picture.around.push_back({picture_of(gathered), std::move(halves)});
        }
        Progress silent;
        return finish_picture(std::move(picture), silent);
    };
    const FinishedPicture result = with(4);
    const double is = decibels_of(colours_of(result.image), truth);
    EXPECT_GT(is, decibels_of(colours_of(with(0).image), truth) + 2);
    const auto estimated = decibels(result.error);
    ASSERT_TRUE(estimated);
    EXPECT_NEAR(*estimated, is, 1);
}

} // namespace
} // namespace sparselens
