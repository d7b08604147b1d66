#include "chain/colours.h"
#include "io/display/shown_picture.h"
#include "io/photograph.h"
#include "support/profiles.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace sparselens {
namespace {

// A configuration that knows no sRGB, and darkens what it shows.
constexpr const char *film = R"(ocio_profile_version: 2
roles: {scene_linear: plain, default: plain}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: film, colorspace: film}
colorspaces:
  - !<ColorSpace> {name: plain}
  - !<ColorSpace>
    name: film
    from_scene_reference: !<MatrixTransform> {matrix: [0.6, 0, 0, 0, 0, 0.6, 0, 0, 0, 0, 0.6, 0, 0, 0, 0, 1]}
)";

// Without a lens a photograph comes back as it was, with what its file holds beside its colours.
class PhotographColours : public testing::Test {
protected:
    ScratchFolder folder;
    std::vector<std::string> warnings;
    Image picture{windows_of_size(64, 5), rgba_channels()};

    PhotographColours() {
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 64; ++x) {
                picture.at(3, x, y) = 1;
                for (int k = 0; k < 3; ++k)
                    picture.at(std::size_t(k), x, y) = float((64 * y + (1 + k) * x) % 320) / 319;
            }
    }
    ~PhotographColours() override { ::unsetenv("OCIO"); }

    ShownFile there_and_back(const std::string &from, const std::string &to, const ShownExtras &extras,
                             const ColourOptions &options = {}) {
        const Notify notify = [this](const Notice &notice) {
            if (level_of(notice) != NoticeLevel::note) warnings.push_back(words_of(notice));
        };
        const std::string file = folder.file(from);
        write_shown_picture(file, picture, extras);
        LdiFile read = read_photograph(file, {.depth_file = file});
        const Imf::Header header = to_linear(notify, options, file, read.header, read.ldi);
        Image image(picture.windows, read.ldi.channels);
        for (std::size_t k = 0; k < image.channels.size(); ++k)
            std::ranges::copy(read.ldi.values[k], image.plane(k).begin());
        write_picture(notify, options, folder.file(to), image, header);
        return read_shown_picture(folder.file(to));
    }
    void expect_same(const Image &found, double by) const {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < picture.windows.pixels(); ++i)
                ASSERT_NEAR(found.plane(k)[i], picture.plane(k)[i], by) << k << ' ' << i;
    }
    void grey() {
        for (const std::size_t k : {1u, 2u}) std::ranges::copy(picture.plane(0), picture.plane(k).begin());
    }
};

const ShownExtras camera{8, profile_of(p3, srgb_curve),
                         std::string("II*\0\x08\0\0\0\1\0\x0f\1\2\0\4\0\0\0Me\0\0\0\0\0\0", 26)};

TEST_F(PhotographColours, ComeBackWhateverTheConfiguration) {
    grey();
    put_contents(folder.file("film.ocio"), film);
    for (const std::string &config :
         {std::string(), folder.file("film.ocio"), folder.file("none"), std::string("ocio://x")}) {
        SCOPED_TRACE(config);
        config.empty() ? ::unsetenv("OCIO") : ::setenv("OCIO", config.c_str(), 1);
        expect_same(there_and_back("a.png", "out.png", {}).image, 0.003);
        expect_same(there_and_back("a.png", "out.png", camera).image, 0.003);
        EXPECT_TRUE(warnings.empty()) << warnings.front();
    }
}

TEST_F(PhotographColours, KeepProfileAndExif) {
    grey();
    for (const char *from : {"a.png", "a.jpg", "a.tif"})
        for (const char *to : {"b.png", "b.jpg", "b.tif"}) {
            SCOPED_TRACE(std::string(from) + to);
            const ShownFile back = there_and_back(from, to, camera);
            expect_same(back.image, 0.06); // JPEG
            EXPECT_EQ(back.extras.profile, camera.profile);
            EXPECT_NE(back.extras.exif.find("Me"), std::string::npos);
            EXPECT_EQ(back.orientation, 1);
        }
}

TEST_F(PhotographColours, KeepSixteenBits) {
    grey();
    for (const char *to : {"b.png", "b.tif"}) {
        const ShownFile back = there_and_back("a.png", to, {16, camera.profile, camera.exif});
        EXPECT_EQ(back.extras.bits, 16) << to;
        expect_same(back.image, 1e-4);
    }
    EXPECT_EQ(there_and_back("a.png", "b.png", {}).extras.bits, 8);
}

TEST_F(PhotographColours, AreThoseThatAreAskedFor) {
    grey();
    put_contents(folder.file("film.ocio"), film);
    ::setenv("OCIO", folder.file("film.ocio").c_str(), 1);
    const ShownFile shown = there_and_back("a.png", "b.png", camera, {.view = "film"});
    EXPECT_TRUE(shown.extras.profile.empty());
    EXPECT_NEAR(shown.image.at(0, 63, 4), 0.6 * std::pow((picture.at(0, 63, 4) + 0.055) / 1.055, 2.4), 0.004);
}

TEST_F(PhotographColours, AlphaIsKeptOrMissed) {
    grey();
    for (int x = 0; x < 64; ++x) {
        picture.at(3, x, 2) = 0.5f;
        for (std::size_t k = 0; k < 3; ++k) picture.at(k, x, 2) *= 0.5f;
    }
    for (const char *to : {"b.png", "b.tif"}) {
        const Image back = there_and_back("a.png", to, {}).image;
        ASSERT_EQ(back.channels.size(), 4u) << to;
        EXPECT_NEAR(back.at(3, 7, 2), 0.5, 0.003);
        expect_same(back, 0.003);
        EXPECT_TRUE(warnings.empty());
    }
    there_and_back("a.png", "b.jpg", {});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("b.jpg: the format has no alpha"), std::string::npos);
}

} // namespace
} // namespace sparselens
