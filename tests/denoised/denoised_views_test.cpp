// Views take the colours of denoised pictures: layer by layer, by name, with any order of channels.
#include "base/error.h"
#include "denoised/denoised_views.h"
#include "support/views.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {
namespace {

constexpr double focal_px = 100, radius = 0.06;
const Windows windows = windows_of_size(40, 30);

// Two planes; each pixel is brighter or darker by up to a fifth.
TwoPlanes scene(float noise) {
    TwoPlanes planes;
    planes.front_covers = [](double x, double) { return x < 12; };
    planes.noise = noise;
    return planes;
}

// Adds a layer of light and one of data beside the beauty.
std::vector<View> with_layers(std::vector<View> views) {
    for (View &view : views) {
        Image image(windows, view.image.channels);
        for (const char *name : {"diffuse.R", "N.X"}) image.channels.push_back({.name = name});
        find_kinds(image.channels);
        image = Image(windows, image.channels);
        for (std::size_t c = 0; c < 4; ++c) std::ranges::copy(view.image.plane(c), image.plane(c).begin());
        for (std::size_t c = 4; c < 6; ++c) std::ranges::copy(view.image.plane(0), image.plane(c).begin());
        view.image = std::move(image);
    }
    return views;
}

std::vector<DenoisedPicture> denoised_of(const std::vector<View> &clean) {
    std::vector<DenoisedPicture> pictures;
    for (const View &view : clean) pictures.push_back({"denoised.exr", view.image});
    return pictures;
}

double squared_distance(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += double(a[i] - b[i]) * double(a[i] - b[i]);
    return sum;
}

std::vector<View> taken(const std::vector<View> &noisy, const std::vector<DenoisedPicture> &denoised) {
    std::vector<PackedView> views = referring_to(noisy);
    take_denoised(views, denoised, focal_px, focal_px * radius);
    std::vector<View> made;
    for (const PackedView &view : views) made.push_back(unpacked(view));
    return made;
}

TEST(DenoisedViews, LoseTheirNoise) {
    const auto noisy = five_views(scene(0.2f), windows, radius),
               clean = five_views(scene(0), windows, radius);
    const std::vector<View> made = taken(noisy, denoised_of(clean));
    for (std::size_t v = 0; v < made.size(); ++v) {
        for (const std::size_t c : {0u, 1u}) {
            const double before = squared_distance(noisy[v].image.plane(c), clean[v].image.plane(c));
            EXPECT_LT(squared_distance(made[v].image.plane(c), clean[v].image.plane(c)), 0.1 * before)
                << v << c;
        }
        EXPECT_EQ(made[v].z, noisy[v].z);
        EXPECT_EQ(made[v].position, noisy[v].position);
        EXPECT_EQ(squared_distance(made[v].image.plane(3), noisy[v].image.plane(3)), 0); // coverage
    }
}

// Cameras with overscan have windows that begin below 0, cropped renders above. Only rounding differs.
TEST(DenoisedViews, AreTheSameWhereverTheirWindowsBegin) {
    const auto noisy = five_views(scene(0.2f), windows, radius),
               clean = five_views(scene(0), windows, radius);
    const std::vector<View> expected = taken(noisy, denoised_of(clean));
    for (const Imath::V2i &step : {Imath::V2i(-9, -7), Imath::V2i(300, 200)}) {
        const auto moved = [&](std::vector<View> views) {
            for (View &view : views)
                for (Imath::Box2i *box : {&view.image.windows.display, &view.image.windows.data})
                    *box = {box->min + step, box->max + step};
            return views;
        };
        const std::vector<View> made = taken(moved(noisy), denoised_of(moved(clean)));
        for (std::size_t v = 0; v < made.size(); ++v)
            EXPECT_LT(squared_distance(made[v].image.values, expected[v].image.values),
                      1e-8 * squared_distance(noisy[v].image.values, expected[v].image.values))
                << v << ' ' << step;
    }
}

TEST(DenoisedViews, KeepWhatTheDenoiserDidNotSee) {
    const auto noisy = with_layers(five_views(scene(0.2f), windows, radius));
    const auto clean = with_layers(five_views(scene(0), windows, radius));
    std::vector<DenoisedPicture> denoised = denoised_of(clean);
    for (DenoisedPicture &picture : denoised) picture.image.channels[4].name = "specular.R";
    const std::vector<View> made = taken(noisy, denoised);
    EXPECT_EQ(squared_distance(made[0].image.plane(4), noisy[0].image.plane(4)), 0); // light of another layer
    EXPECT_EQ(squared_distance(made[0].image.plane(5), noisy[0].image.plane(5)), 0); // data
    EXPECT_GT(squared_distance(made[0].image.plane(0), noisy[0].image.plane(0)), 0);
    EXPECT_GT(squared_distance(taken(noisy, denoised_of(clean))[0].image.plane(4), noisy[0].image.plane(4)),
              0);
}

TEST(DenoisedViews, AreTheViewsThemselvesWhereNothingWasDenoised) {
    const auto noisy = five_views(scene(0.2f), windows, radius);
    const std::vector<View> made = taken(noisy, denoised_of(noisy));
    for (std::size_t v = 0; v < made.size(); ++v)
        EXPECT_TRUE(std::ranges::equal(made[v].image.values, noisy[v].image.values));
}

TEST(DenoisedViews, APictureOfBothIsParted) {
    const View noisy = five_views(scene(0.2f), windows, radius)[0],
               clean = five_views(scene(0), windows, radius)[0];
    View both = clean;
    for (const char *name : {"L.Noisy Image.R", "L.Noisy Image.G", "L.Noisy Image.B", "L.Noisy Image.A"})
        both.image.channels.push_back({.name = name});
    const auto of_noisy = std::span(noisy.image.values);
    both.image.values.insert(both.image.values.end(), of_noisy.begin(), of_noisy.end());
    both.image.channels.push_back({.name = "L.Denoising Depth.Z"}); // a guide of Cycles' denoiser
    both.image.values.resize(both.image.values.size() + windows.grid().size());
    PackedView view{View(both)};
    const DenoisedPicture denoised = part_denoised(view, "L.Noisy Image");
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_TRUE(std::ranges::equal(denoised.image.plane(c), clean.image.plane(c))) << c;
    const View parted = unpacked(view);
    EXPECT_EQ(parted.image.channels, clean.image.channels);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_TRUE(std::ranges::equal(parted.image.plane(c), noisy.image.plane(c))) << c;
    EXPECT_THROW(part_denoised(view, "L.Noisy Image"), Error); // it was removed
}

void expect_error(const std::vector<View> &views, const std::vector<DenoisedPicture> &denoised,
                  const std::string &text) {
    try {
        taken(views, denoised);
        FAIL() << "no error: " << text;
    } catch (const Error &error) {
        EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
}

TEST(DenoisedViews, PicturesThatDoNotFitAreNamed) {
    const auto views = five_views(scene(0.2f), windows, radius);
    std::vector<DenoisedPicture> pictures = denoised_of(views);
    pictures[2] = {"small.exr", Image(windows_of_size(20, 15), rgba_channels())};
    expect_error(views, pictures, "small.exr: its windows are not those of");
    for (const float noise : {0.0f, 0.1f, 0.4f}) {
        const auto rendered = five_views(scene(noise), windows, radius);
        pictures = denoised_of(five_views(scene(0), windows, radius));
        pictures[2].name = "second.exr";
        std::swap(pictures[2].image, pictures[3].image);
        expect_error(rendered, pictures, "second.exr: shows what ");
        pictures[3].image = pictures[2].image; // one twice
        expect_error(rendered, pictures, ": give `denoised` in the order of the views");
    }
    pictures = denoised_of(views);
    pictures[2].image.channels[0].name = "other.R";
    expect_error(views, pictures, "no colours");
}

} // namespace
} // namespace sparselens
