#include "base/error.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_flat.h"
#include "io/photograph.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace sparselens {
namespace {

// The disparity of a pixel of the frame, counted from its corner: no two pixels near each other have the same.
float disparity(int x, int y) { return float(16 * y + x) / 255; }

constexpr int width = 16, height = 12;

class Photograph : public testing::Test {
protected:
    ScratchFolder folder;

    std::string shown(const char *name, const Windows &windows = windows_of_size(width, height)) {
        return write(name, windows,
                     [](const std::string &path, const Image &image) { write_shown_picture(path, image); });
    }
    std::string exr(const char *name, const Windows &windows) {
        return write(name, windows, [](const std::string &path, const Image &image) {
            write_flat_exr(path, image, Imf::Header(image.windows.display, image.windows.data));
        });
    }
    // The depth in the pixels of the picture.
    static std::vector<float> depths(const std::string &picture, const std::string &depth) {
        return read_photograph(picture, {.depth_file = depth}).ldi.z;
    }
    // The same, if every pixel of the frame has its own depth, and others have that of the nearest pixel of the frame.
    static std::vector<float> expected(const Windows &windows) {
        std::vector<float> all;
        const Imath::V2i &corner = windows.display.min;
        for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
            for (int x = windows.data.min.x; x <= windows.data.max.x; ++x)
                all.push_back(disparity(std::clamp(x - corner.x, 0, width - 1),
                                        std::clamp(y - corner.y, 0, height - 1)));
        return all;
    }
    static void expect_near(const std::vector<float> &found, const std::vector<float> &wanted) {
        ASSERT_EQ(found.size(), wanted.size());
        for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], wanted[i], 1e-6) << i;
    }

private:
    template <typename Write>
    std::string write(const char *name, const Windows &windows, const Write &write_to) {
        Image image(windows,
                    {{"R", PixelType::float32}, {"G", PixelType::float32}, {"B", PixelType::float32}});
        const Imath::V2i &corner = windows.display.min;
        for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
            for (int x = windows.data.min.x; x <= windows.data.max.x; ++x)
                for (std::size_t k = 0; k < 3; ++k)
                    image.at(k, x, y) = std::clamp(disparity(x - corner.x, y - corner.y), 0.0f, 1.0f);
        const std::string path = folder.file(name);
        write_to(path, image);
        return path;
    }
};

// The frame with a data window that is larger, smaller, beside its corner, or all of that.
const std::vector<Windows> &windows_of_exr() {
    const auto at = [](Imath::V2i corner, Imath::Box2i data) {
        return Windows{{corner, corner + Imath::V2i(width - 1, height - 1)}, data, 1};
    };
    static const std::vector<Windows> all{
        at({0, 0}, {{0, 0}, {width - 1, height - 1}}), at({0, 0}, {{-4, -3}, {width + 5, height + 1}}),
        at({0, 0}, {{3, 2}, {width - 2, height - 4}}), at({100, -50}, {{100, -50}, {115, -39}}),
        at({100, -50}, {{90, -48}, {110, -30}}),       at({0, 0}, {{0, 0}, {width + 40, height + 90}})};
    return all;
}

TEST_F(Photograph, DepthBelongsToTheFrameOfTheColours) {
    const std::string depth = shown("depth.png");
    for (const Windows &windows : windows_of_exr()) {
        SCOPED_TRACE(size_text(windows.data));
        expect_near(depths(exr("picture.exr", windows), depth), expected(windows));
    }
}

TEST_F(Photograph, DepthInAnExrMayHaveAnyWindow) {
    const std::string picture = shown("picture.png");
    for (const Windows &windows : windows_of_exr()) {
        SCOPED_TRACE(size_text(windows.data));
        std::vector<float> wanted = expected(windows_of_size(width, height));
        const Imath::V2i &corner = windows.display.min;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (!windows.data.intersects(corner + Imath::V2i(x, y)))
                    wanted[std::size_t(y * width + x)] = 0;
        expect_near(depths(picture, exr("depth.exr", windows)), wanted);
    }
}

TEST_F(Photograph, DepthOfAnotherSizeIsRefused) {
    const std::string picture = shown("picture.png"), small = shown("small.png", windows_of_size(8, 6));
    EXPECT_NE(what_of<Error>([&] { depths(picture, small); }).find("small.png: is 8x6 pixels large"),
              std::string::npos);
}

} // namespace
} // namespace sparselens
