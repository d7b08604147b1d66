#include "base/error.h"
#include "base/light.h"
#include "measure/image_error.h"
#include "measure/ssim_reference.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace sparselens {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Image constant(int width, int height, std::array<float, 4> rgba) {
    Image image(windows_of_size(width, height), rgba_channels());
    for (std::size_t c = 0; c < 4; ++c) std::ranges::fill(image.plane(c), rgba[c]);
    return image;
}

Image noise(int width, int height, unsigned seed, float low = -0.1f, float high = 3) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(low, high);
    Image image = constant(width, height, {0, 0, 0, 1});
    for (std::size_t i = 0; i < 3 * image.windows.pixels(); ++i) image.values[i] = uniform(generator);
    return image;
}

Image mixed(const Image &a, const Image &b, float share) {
    Image image = a;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        image.values[i] = (1 - share) * a.values[i] + share * b.values[i];
    return image;
}

ErrorFigures whole(const Image &image, const Image &reference) {
    return image_error(image, reference).front();
}

// The figures' formulas, one after the other over a list of (a, b).
struct Plain {
    std::vector<std::pair<double, double>> values;

    template <typename Term>
    double mean(const Term &term) const {
        double sum = 0;
        for (const auto &[a, b] : values) sum += term(a, b);
        return sum / double(values.size());
    }
    static double tone(double v) { return v <= 0 ? 0 : std::pow(v / (1 + v), 1 / 2.2); }
    double psnr() const {
        return 10 * std::log10(1 / mean([](double a, double b) { return std::pow(a - b, 2); }));
    }
    double psnr_tonemapped() const {
        return 10 * std::log10(1 / mean([](double a, double b) { return std::pow(tone(a) - tone(b), 2); }));
    }
    double relmse() const {
        return mean([](double a, double b) { return std::pow(a - b, 2) / (b * b + 0.01); });
    }
    double smape() const {
        return mean([](double a, double b) { return std::abs(a - b) / (std::abs(a) + std::abs(b) + 0.01); });
    }
    double percentile(double share) const { // smallest error that `share` of the values do not exceed
        std::vector<double> errors;
        for (const auto &[a, b] : values) errors.push_back(std::abs(a - b));
        std::sort(errors.begin(), errors.end());
        for (std::size_t i = 0; i < errors.size(); ++i)
            if (double(i + 1) >= share * double(errors.size())) return errors[i];
        return errors.back();
    }
};

template <typename Chosen>
Plain plain_of(const Image &a, const Image &b, const Chosen &chosen) {
    Plain plain;
    const std::size_t pixels = a.windows.pixels();
    for (std::size_t i = 0; i < pixels; ++i)
        if (chosen(i))
            for (std::size_t c = 0; c < 3; ++c) plain.values.emplace_back(a.plane(c)[i], b.plane(c)[i]);
    return plain;
}

void expect_figures(const ErrorFigures &figures, const Plain &plain) {
    EXPECT_EQ(3 * figures.pixels, plain.values.size());
    EXPECT_NEAR(figures.psnr, plain.psnr(), 1e-9);
    EXPECT_NEAR(figures.psnr_tonemapped, plain.psnr_tonemapped(), 1e-9);
    EXPECT_NEAR(figures.relmse, plain.relmse(), 1e-12 * plain.relmse());
    EXPECT_NEAR(figures.smape, plain.smape(), 1e-12);
    EXPECT_NEAR(figures.p99, plain.percentile(0.99), 1e-6);
    EXPECT_NEAR(figures.max, plain.percentile(1), 0);
}

TEST(ImageError, EqualPicturesHaveNone) {
    const Image image = noise(20, 15, 1);
    const ErrorFigures figures = whole(image, image);
    EXPECT_EQ(figures.psnr, infinity);
    EXPECT_EQ(figures.psnr_tonemapped, infinity);
    EXPECT_EQ(figures.relmse, 0);
    EXPECT_EQ(figures.smape, 0);
    EXPECT_DOUBLE_EQ(figures.ssim, 1);
    EXPECT_EQ(figures.p99, 0);
    EXPECT_EQ(figures.max, 0);
    EXPECT_EQ(figures.max_alpha, 0);
    EXPECT_EQ(figures.pixels, 300u);
}

TEST(ImageError, ConstantPicturesHaveClosedForms) {
    const Image a = constant(16, 12, {0.75f, 0.75f, 0.75f, 0.5f}),
                b = constant(16, 12, {0.5f, 0.5f, 0.5f, 1});
    const double tone_a = std::pow(0.75 / 1.75, 1 / 2.2), tone_b = std::pow(0.5 / 1.5, 1 / 2.2);
    const ErrorFigures figures = whole(a, b);
    EXPECT_NEAR(figures.psnr, 20 * std::log10(4), 1e-12);
    EXPECT_NEAR(figures.psnr_tonemapped, -20 * std::log10(tone_a - tone_b), 1e-10);
    EXPECT_NEAR(figures.relmse, 0.0625 / 0.26, 1e-15);
    EXPECT_NEAR(figures.smape, 0.25 / 1.26, 1e-15);
    EXPECT_NEAR(figures.ssim, (2 * tone_a * tone_b + 1e-4) / (tone_a * tone_a + tone_b * tone_b + 1e-4),
                1e-6);
    EXPECT_EQ(figures.p99, 0.25);
    EXPECT_EQ(figures.max, 0.25);
    EXPECT_EQ(figures.max_alpha, 0.5);
}

// 0.04 is on the curve of sRGB, 0.002 on its line; what is brighter than white is white.
TEST(ImageError, CodeValuesOfSrgbHaveClosedForms) {
    const ErrorFigures figures =
        whole(constant(16, 12, {0.04f, 0.002f, 3, 1}), constant(16, 12, {0, 0, 1, 1}));
    const double red = 1.055 * std::pow(0.04, 1 / 2.4) - 0.055, green = 12.92 * 0.002,
                 luma = 0.2126 * red + 0.7152 * green, white = 0.0722;
    EXPECT_NEAR(figures.psnr_srgb, -10 * std::log10((red * red + green * green) / 3), 1e-6);
    EXPECT_NEAR(figures.ssim_srgb,
                (2 * (luma + white) * white + 1e-4) / (std::pow(luma + white, 2) + white * white + 1e-4),
                1e-6);
}

TEST(ImageError, LumaWeighsGreenMost) {
    const Image black = constant(11, 11, {0, 0, 0, 1});
    const auto ssim_of = [&](std::size_t channel) {
        Image image = black;
        std::ranges::fill(image.plane(channel), 1.0f);
        const double luma = std::array{0.2126, 0.7152, 0.0722}[channel] * std::pow(0.5, 1 / 2.2);
        EXPECT_NEAR(whole(image, black).ssim, 1e-4 / (luma * luma + 1e-4), 1e-8);
    };
    for (const std::size_t channel : {0u, 1u, 2u}) ssim_of(channel);
}

TEST(ImageError, AgreesWithThePlainFormulas) {
    const Image b = noise(37, 29, 2), a = mixed(b, noise(37, 29, 3), 0.1f);
    expect_figures(whole(a, b), plain_of(a, b, [](std::size_t) { return true; }));
}

TEST(ImageError, PsnrAndMaxAgreeWithOpenImageIO) {
    const Image b = noise(64, 48, 4, 0, 1), a = mixed(b, noise(64, 48, 5, 0, 1), 0.2f);
    const auto buffer = [](const Image &image) {
        OIIO::ImageBuf buf(OIIO::ImageSpec(64, 48, 3, OIIO::TypeFloat));
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x) {
                const float rgb[3] = {image.at(0, x, y), image.at(1, x, y), image.at(2, x, y)};
                buf.setpixel(x, y, rgb);
            }
        return buf;
    };
    const auto theirs = OIIO::ImageBufAlgo::compare(buffer(a), buffer(b), 0, 0);
    const ErrorFigures figures = whole(a, b);
    EXPECT_NEAR(figures.psnr, -20 * std::log10(theirs.rms_error), 1e-4);
    EXPECT_NEAR(figures.max, theirs.maxerror, 1e-7);
}

TEST(ImageError, RegionsCountTheirOwnPixels) {
    const Image b = noise(30, 20, 6), a = mixed(b, noise(30, 20, 7), 0.3f);
    std::vector<std::uint8_t> bits(600);
    for (std::size_t i = 0; i < bits.size(); ++i)
        bits[i] =
            std::uint8_t((i % 30 < 15 ? 1 : 0) | (i % 7 == 0 ? 2 : 0)); // overlapping; the third is empty
    const auto figures = image_error(a, b, bits, 3);
    ASSERT_EQ(figures.size(), 4u);
    expect_figures(figures[0], plain_of(a, b, [](std::size_t) { return true; }));
    expect_figures(figures[1], plain_of(a, b, [](std::size_t i) { return i % 30 < 15; }));
    expect_figures(figures[2], plain_of(a, b, [](std::size_t i) { return i % 7 == 0; }));
    EXPECT_EQ(figures[3].pixels, 0u);
    for (const Figure &figure : figure_table)
        EXPECT_TRUE(std::isnan(figures[3].*figure.value)) << figure.name;
}

// Tone-mapped, 0 and 1 become 0 and 1/2^(1/2.2).
TEST(ImageError, WorstBlocksAreTheMeanOfOneInAHundred) {
    const double one = std::pow(std::pow(0.5, 1 / 2.2), 2), third = one / 3; // of one channel
    const Image black = constant(168, 80, {0, 0, 0, 1}); // 210 blocks: the worst hundredth is three
    Image a = black;
    a.at(1, 20, 30) = 1;
    EXPECT_NEAR(whole(a, black).psnr_worst, -10 * std::log10(third / 64 / 3), 1e-6);
    a.at(0, 23, 31) = 1;                              // the same block
    a.at(2, 24, 31) = 1;                              // the next
    a.at(2, 167, 79) = a.at(0, 160, 72) = 1;          // the last
    for (const int x : {0, 8}) a.at(0, x, 0) = 0.01f; // below those
    EXPECT_NEAR(whole(a, black).psnr_worst, -10 * std::log10(5 * third / 64 / 3), 1e-6);

    // The rest of a block at the edge counts as a block, and so does the part of a block inside a region.
    Image narrow = constant(81, 80, {0, 0, 0, 1});
    const Image reference = narrow;
    narrow.at(0, 80, 7) = narrow.at(0, 3, 40) = 1;
    EXPECT_NEAR(whole(narrow, reference).psnr_worst, -10 * std::log10((third / 8 + third / 64) / 2), 1e-6);
    std::vector<std::uint8_t> bits(narrow.windows.pixels());
    for (int y = 0; y < 80; ++y) bits[std::size_t(y) * 81 + 3] = 1;
    const auto figures = image_error(narrow, reference, bits, 2);
    EXPECT_NEAR(figures[1].psnr_worst, -10 * std::log10(third / 8), 1e-6); // of ten blocks
    EXPECT_TRUE(std::isnan(figures[2].psnr_worst));
}

TEST(ImageError, SsimAgreesWithThePlainFormulas) {
    const int width = 33, height = 21;
    const Image b = noise(width, height, 13), a = mixed(b, noise(width, height, 14), 0.3f);
    const auto luma = [](const Image &image) {
        std::vector<float> result;
        for (std::size_t i = 0; i < image.windows.pixels(); ++i)
            result.push_back(float(0.2126 * Plain::tone(image.plane(0)[i]) +
                                   0.7152 * Plain::tone(image.plane(1)[i]) +
                                   0.0722 * Plain::tone(image.plane(2)[i])));
        return result;
    };
    double sum = 0;
    const auto windows = ssim_reference(luma(a), luma(b), width, height);
    for (const double value : windows) sum += value;
    const double ssim = whole(a, b).ssim;
    EXPECT_NEAR(ssim, sum / double(windows.size()), 1e-6);
    EXPECT_LT(ssim, 0.95); // otherwise the noise proves nothing
}

TEST(ImageError, SsimOfARegionIsThatOfItsWindowCentres) {
    // The left half is equal, the right half is not: windows centred up to 5 pixels inside the left half see it.
    Image b = noise(40, 20, 8, 0, 1), a = b;
    for (int y = 0; y < 20; ++y)
        for (int x = 20; x < 40; ++x) a.at(1, x, y) += 0.5f;
    std::vector<std::uint8_t> bits(800);
    for (std::size_t i = 0; i < bits.size(); ++i)
        bits[i] = std::uint8_t(i % 40 < 15 ? 1 : i % 40 < 20 ? 2 : 4);
    const auto figures = image_error(a, b, bits, 3);
    EXPECT_DOUBLE_EQ(figures[1].ssim, 1);
    EXPECT_LT(figures[2].ssim, 0.999);
    EXPECT_LT(figures[3].ssim, figures[2].ssim);
    EXPECT_EQ(figures[2].max, 0);
}

TEST(ImageError, NonFinitePixelsAreCountedAndLeftOut) {
    const Image b = noise(25, 25, 9), a = mixed(b, noise(25, 25, 10), 0.2f);
    Image bad_a = a, bad_b = b;
    bad_a.at(0, 3, 4) = nan;
    bad_a.at(2, 5, 20) = infinity;
    bad_a.at(3, 6, 20) = -infinity; // alpha counts too
    bad_b.at(1, 3, 4) = nan;        // bad in both
    bad_b.at(1, 24, 24) = infinity;
    const ErrorFigures figures = whole(bad_a, bad_b);
    EXPECT_EQ(figures.nonfinite_image, 3u);
    EXPECT_EQ(figures.nonfinite_reference, 2u);
    const auto is_good = [](std::size_t i) {
        return i != 4 * 25 + 3 && i != 20 * 25 + 5 && i != 20 * 25 + 6 && i != 24 * 25 + 24;
    };
    expect_figures(figures, plain_of(a, b, is_good));
    EXPECT_GT(figures.ssim, 0);
    EXPECT_LT(figures.ssim, 1);
}

TEST(ImageError, PictureOfNothingFiniteHasNoFigures) {
    const Image bad = constant(12, 12, {nan, nan, nan, 1}), good = constant(12, 12, {1, 1, 1, 1});
    const ErrorFigures figures = whole(bad, good);
    EXPECT_EQ(figures.nonfinite_image, 144u);
    EXPECT_EQ(figures.pixels, 0u);
    for (const Figure &figure : figure_table) EXPECT_TRUE(std::isnan(figures.*figure.value)) << figure.name;
}

TEST(ImageError, NegativesAreBlackWhenToneMapped) {
    EXPECT_EQ(tone_mapped(-3), 0);
    EXPECT_EQ(tone_mapped(0), 0);
    EXPECT_NEAR(tone_mapped(1), std::pow(0.5, 1 / 2.2), 1e-15);
    const ErrorFigures figures = whole(constant(3, 3, {-1, -1, -1, 1}), constant(3, 3, {0, 0, 0, 1}));
    EXPECT_EQ(figures.psnr_tonemapped, infinity);
    EXPECT_EQ(figures.psnr, 0);
}

TEST(ImageError, SmallDifferencesAreNotLostInRounding) {
    const float step = 0x1p-20f;
    const ErrorFigures figures =
        whole(constant(64, 64, {1 + step, 1 + step, 1 + step, 1}), constant(64, 64, {1, 1, 1, 1}));
    EXPECT_NEAR(figures.psnr, 20 * std::log10(0x1p20), 1e-9);
    // d/dv of the tone curve at v = 1: (1 / 2.2) (1/2)^(1/2.2) / 2
    EXPECT_NEAR(figures.psnr_tonemapped, -20 * std::log10(step * std::pow(0.5, 1 / 2.2) / 4.4), 1e-4);
}

TEST(ImageError, SameAtAnyThreadCount) {
    const Image b = noise(300, 200, 11), a = mixed(b, noise(300, 200, 12), 0.2f);
    std::vector<std::uint8_t> bits(60000);
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = std::uint8_t(i * 2654435761u >> 13 & 7);
    const auto run = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return image_error(a, b, bits, 3);
    };
    const auto one = run(1), four = run(4);
    for (std::size_t set = 0; set < 4; ++set)
        for (const Figure &figure : figure_table)
            EXPECT_EQ(one[set].*figure.value, four[set].*figure.value) << figure.name;
}

TEST(ImageError, SinglePixel) {
    const ErrorFigures figures = whole(constant(1, 1, {1, 1, 1, 1}), constant(1, 1, {0, 0, 0, 1}));
    EXPECT_EQ(figures.psnr, 0);
    EXPECT_EQ(figures.p99, 1);
    EXPECT_FALSE(std::isnan(figures.ssim));
}

TEST(RgbaOver, PixelsThatAreMissingAreTransparentBlack) {
    Image image = constant(8, 6, {1, 2, 3, 1});
    image.windows.data = {{2, 1}, {9, 6}}; // overscan to the right and below
    Windows target = windows_of_size(8, 6);
    const Image result = rgba_over(image, target, "a.exr");
    EXPECT_EQ(result.windows, target);
    EXPECT_EQ(result.at(0, 1, 1), 0);
    EXPECT_EQ(result.at(3, 2, 0), 0);
    EXPECT_EQ(result.at(2, 2, 1), 3);
    EXPECT_EQ(result.at(3, 7, 5), 1);
}

TEST(RgbaOver, PutsDisplayWindowsOntoEachOther) {
    Image image = constant(4, 4, {0, 0, 0, 1});
    image.windows.display = image.windows.data = {{10, 20}, {13, 23}};
    image.at(0, 11, 22) = 7;
    EXPECT_EQ(rgba_over(image, windows_of_size(4, 4), "a.exr").at(0, 1, 2), 7);
}

TEST(RgbaOver, WithoutAlphaWhatIsThereIsOpaque) {
    const Image image(windows_of_size(3, 3), {{"B"}, {"G"}, {"R"}});
    EXPECT_EQ(rgba_over(image, windows_of_size(3, 3), "a.exr").at(3, 1, 1), 1);
}

TEST(RgbaOver, RefusesWhatCannotBeComparedNamingTheFile) {
    const auto message = [](const Image &image) -> std::string {
        try {
            rgba_over(image, windows_of_size(3, 3), "some.exr");
        } catch (const Error &error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message(Image(windows_of_size(3, 3), {{"R"}, {"B"}})),
              "some.exr: has no channel G, which is compared");
    EXPECT_NE(message(constant(4, 3, {})).find("some.exr: the display window is 4x3"), std::string::npos);
}

} // namespace
} // namespace sparselens
