#include "base/error.h"
#include "base/parallel.h"
#include "io/display/oiio_module.h"
#include "io/display/shown_picture.h"
#include "support/png.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <string_view>

namespace sparselens {
namespace {

Image noise(int width, int height) {
    Image image(windows_of_size(width, height), {{"R"}, {"G"}, {"B"}});
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> uniform(-0.2f, 1.2f);
    for (float &value : image.values) value = uniform(generator);
    return image;
}

void expect_reads_back(const std::string &file, const Image &image) {
    const Png read = read_png(file);
    ASSERT_EQ(read.width, image.windows.width());
    ASSERT_EQ(read.height, image.windows.height());
    for (int y = 0; y < image.windows.height(); ++y)
        for (int x = 0; x < image.windows.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                const float value = image.plane(std::size_t(c))[std::size_t(y * image.windows.width() + x)];
                const float shown = std::isnan(value) ? 0 : std::clamp(value, 0.0f, 1.0f);
                ASSERT_EQ(read.at(x, y, c), std::lround(255 * shown)) << x << ',' << y;
            }
}

void expect_reads_back(const Image &image) {
    const ScratchFolder scratch;
    write_shown_picture(scratch.file("a.png"), image);
    expect_reads_back(scratch.file("a.png"), image);
}

TEST(ShownPicture, OthersReadWhatWasWritten) {
    expect_reads_back(noise(1, 1));
    expect_reads_back(noise(37, 23));
    expect_reads_back(noise(300, 2));
}

TEST(ShownPicture, CutsOffWhatIsOutsideOfTheRange) {
    Image image = noise(5, 4);
    image.values[0] = std::numeric_limits<float>::quiet_NaN();
    image.values[1] = std::numeric_limits<float>::infinity();
    image.values[2] = -std::numeric_limits<float>::infinity();
    expect_reads_back(image);
}

TEST(ShownPicture, PixelsAreThoseOfTheFile) {
    const ScratchFolder scratch;
    Image image = noise(300, 70);
    for (std::size_t i = 0; i < 10'000; ++i)
        image.values[i] = (float(i % 256) + 0.5f) / 255; // on rounding boundaries
    image.values[0] = std::numeric_limits<float>::quiet_NaN();
    image.windows.display.max.x += 3; // black beside the data window
    write_shown_picture(scratch.file("a.png"), image);
    const ShownPixels pixels = shown_pixels("a", image);
    const Png read = read_png(scratch.file("a.png"));
    EXPECT_EQ(pixels.width, read.width);
    EXPECT_EQ(pixels.height, read.height);
    EXPECT_EQ(pixels.channels, 3);
    EXPECT_EQ(pixels.values, read.rgb);
}

TEST(ShownPicture, PixelsHaveAlphaWhereSomethingShowsThrough) {
    Image image(windows_of_size(2, 1), {{"R"}, {"G"}, {"B"}, {"A"}});
    image.values = {0.25f, 1, 0, 1, 0.125f, 1, 0.5f, 1};
    const ShownPixels pixels = shown_pixels("a", image);
    EXPECT_EQ(pixels.channels, 4);
    EXPECT_EQ(pixels.values, (std::vector<std::uint8_t>{128, 0, 64, 128, 255, 255, 255, 255}));
    image.values[6] = 1;
    EXPECT_EQ(shown_pixels("a", image).channels, 3);
}

// Others can read and overwrite files with predictable names.
TEST(ShownPicture, NoOtherFileIsWritten) {
    const ScratchFolder scratch;
    const char *before = std::getenv("TMPDIR");
    const std::string kept = before ? before : "";
    ::setenv("TMPDIR", scratch.file("none").c_str(), 1);
    for (const char *format : {"png", "jpg", "tif", "bmp"})
        EXPECT_NO_THROW(write_shown_picture(scratch.file("a.") + format, noise(20, 10))) << format;
    before ? ::setenv("TMPDIR", kept.c_str(), 1) : ::unsetenv("TMPDIR");
    EXPECT_EQ(scratch.entries(), 4u);
    expect_reads_back(scratch.file("a.png"), noise(20, 10));
}

// A farm limits the size of files (ulimit -f): libpng's file is cut off then, and libjpeg ends the process.
TEST(ShownPicture, WhatDoesNotFitReplacesNothing) {
    const ScratchFolder scratch;
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN); // as tools do
    for (const char *format : {"png", "jpg", "tif", "dpx", "bmp", "tga", "hdr", "webp", "sgi"}) {
        const std::string path = scratch.file("a.") + format;
        put_contents(path, "good");
        const rlimit small{2048, before.rlim_max};
        ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
        const std::string what = what_of<Error>([&] { write_shown_picture(path, noise(120, 90)); });
        ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
        EXPECT_TRUE(what.starts_with(path + ": cannot write: ")) << format << ": " << what;
        EXPECT_TRUE(contents_of(path) == "good") << format;
    }
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(scratch.entries(), 9u);
}

TEST(ShownPicture, IsReadFromAFile) {
    const ScratchFolder scratch;
    const std::string pipe = scratch.file("a.png");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const std::string &path : {pipe, scratch.file("")})
        EXPECT_EQ(what_of<Error>([&] { read_shown_picture(path); }),
                  path + ": cannot read: not a regular file: store the picture in one");
}

TEST(ShownPicture, MayBeTooLargeForItsFormat) {
    const ScratchFolder scratch;
    for (const char *name : {"a.jpg", "a.webp"}) {
        const std::string path = scratch.file(name),
                          what = what_of<Error>([&] { write_shown_picture(path, noise(70'000, 1)); });
        EXPECT_TRUE(what.starts_with(path + ": cannot write: ")) << what;
    }
    EXPECT_EQ(scratch.entries(), 0u);
}

TEST(ShownPicture, AsksForNoMoreMemoryThanItsPixelsExplain) {
    const ScratchFolder scratch;
    Image image = noise(20, 10);
    image.windows.display = {{0, 0}, {5'999, 5'999}};
    EXPECT_NE(
        what_of<Error>([&] { write_shown_picture(scratch.file("a.png"), image); }).find("a.png: asks for"),
        std::string::npos);
    EXPECT_EQ(scratch.entries(), 0u);
}

TEST(ShownPicture, ThreadsMayWriteAtTheSameTime) {
    const ScratchFolder scratch;
    const auto file = [&](std::size_t i) { return scratch.file("a" + std::to_string(i) + ".png"); };
    const auto image = [](std::size_t i) { return noise(20 + int(i), 10); };
    parallel_for(24, [&](std::size_t i) { write_shown_picture(file(i), image(i)); });
    for (std::size_t i = 0; i < 24; ++i) expect_reads_back(file(i), image(i));
}

// The first row of a stored picture is, from orientation 1 on, at the top, the top, the bottom, the bottom, the left, the
// right, the right and the left; the first column at the left, right, right, left, top, top, bottom and bottom (Exif).
TEST(Upright, FollowsTheTableOfExif) {
    constexpr std::array<std::string_view, 8> turned{"abcdef", "cbafed", "fedcba", "defabc",
                                                     "adbecf", "daebfc", "fcebda", "cfbead"};
    for (int orientation = 1; orientation <= 8; ++orientation) {
        std::string found(6, ' ');
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x) found[upright(x, y, 3, 2, orientation)] = char('a' + 3 * y + x);
        EXPECT_EQ(found, turned[std::size_t(orientation - 1)]) << orientation;
    }
}

} // namespace
} // namespace sparselens
