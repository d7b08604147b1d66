#include "base/error.h"
#include "io/exr/exr_flat.h"
#include "io/lens_file.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparselens {
namespace {

class LensFiles : public testing::Test {
protected:
    ScratchFolder folder;

    LensFile read(const std::string &text, std::optional<double> fstop = {}) {
        put_contents(folder.file("lens.json"), text);
        return read_lens_file(folder.file("lens.json"), fstop);
    }
    std::string error_of(const std::string &text, std::optional<double> fstop = 2) {
        return what_of<Error>([&] { read(text, fstop); });
    }
    void put_picture(const std::string &name) {
        Image image(windows_of_size(3, 2), {{"Y"}});
        std::ranges::fill(image.plane(0), 0.5f);
        write_flat_exr(folder.file(name), image, {});
    }
};

TEST_F(LensFiles, HoldEveryLook) {
    const LensFile file =
        read(R"({"name": "Test", "blades": 7, "blade-curvature": 0.25, "blade-rotation": -10, "squeeze": 1.5,
        "spherical": -0.5, "cat-eye": 2, "cat-eye-darkening": true, "axial-chromatic": 0.1,
        "axial-chromatic-type": "green-magenta", "field-curvature": 0.3, "astigmatism": 0.2, "tilt": [10, -20], "breathing": 0.5,
        "highlight-gain": 4, "highlight-threshold": 2, "highlight-knee": 3})");
    EXPECT_EQ(file.name, "Test");
    const LookValues &v = file.values;
    EXPECT_EQ(v.blades, 7);
    EXPECT_EQ(v.curvature, 0.25);
    EXPECT_EQ(v.rotation, -10);
    EXPECT_EQ(v.squeeze, 1.5);
    EXPECT_EQ(v.spherical, -0.5);
    EXPECT_EQ(v.cat_eye, 2);
    EXPECT_EQ(v.cat_eye_darkening, true);
    EXPECT_EQ(v.axial_chromatic, 0.1);
    EXPECT_EQ(v.chromatic_type, ChromaticType::green_magenta);
    EXPECT_EQ(v.field_curvature, 0.3);
    EXPECT_EQ(v.astigmatism, 0.2);
    EXPECT_EQ(v.tilt_x, 10);
    EXPECT_EQ(v.tilt_y, -20);
    EXPECT_EQ(v.breathing, 0.5);
    EXPECT_EQ(v.highlight_gain, 4);
    EXPECT_EQ(v.highlight_threshold, 2);
    EXPECT_EQ(v.highlight_knee, 3);
    EXPECT_EQ(v.picture, nullptr);
    EXPECT_FALSE(read("{}").values.blades);
}

TEST_F(LensFiles, AreLinearInStopsBetweenFNumbers) {
    const auto cat_eye = [&](double fstop) {
        return *read(R"({"cat-eye": {"1": 3, "2": 1, "8": 0}})", fstop).values.cat_eye;
    };
    EXPECT_EQ(cat_eye(0.5), 3);
    EXPECT_EQ(cat_eye(1), 3);
    EXPECT_NEAR(cat_eye(std::sqrt(2.0)), 2, 1e-12);
    EXPECT_EQ(cat_eye(2), 1);
    EXPECT_NEAR(cat_eye(4), 0.5, 1e-12);
    EXPECT_EQ(cat_eye(INFINITY), 0);
    // Between none and six blades there is no one or two: uses the number at the smaller f-number.
    EXPECT_EQ(read(R"({"blades": {"1": 0, "4": 6}})", 1.2).values.blades, 0);
}

TEST_F(LensFiles, AskForTheFNumberOnlyWhereAValueDependsOnIt) {
    EXPECT_EQ(read(R"({"squeeze": 2})").values.squeeze, 2);
    const auto message = what_of<UsageError>([&] { read(R"({"squeeze": {"2": 2}})"); });
    EXPECT_NE(message.find("lens.json: 'squeeze'"), std::string::npos) << message;
    EXPECT_NE(message.find("`fstop`"), std::string::npos) << message;
}

TEST_F(LensFiles, ThatAreWrongAreNamedWithTheKey) {
    for (const auto &[text, expected] : std::initializer_list<std::pair<const char *, const char *>>{
             {"[]", "not a JSON object"},
             {"{", "not JSON"},
             {R"({"no-look": 1})", "'no-look' is no look"},
             {R"({"name": 1})", "'name'"},
             {R"({"blades": 2})", "'blades' is 2, not 0 or a whole number"},
             {R"({"squeeze": "wide"})", "'squeeze'"},
             {R"({"cat-eye": {"wide": 1}})", "'cat-eye' for 'wide'"},
             {R"({"cat-eye": {}})", "'cat-eye'"},
             {R"({"cat-eye": {"2": -1}})", "'cat-eye' is -1"},
             {R"({"cat-eye": {"2": {"2": 1}}})", "'cat-eye' is {\"2\":1}, not a number"},
             {R"({"cat-eye-darkening": 1})", "'cat-eye-darkening'"},
             {R"({"axial-chromatic-type": "pink"})", "'axial-chromatic-type' is \"pink\""},
             {R"({"axial-chromatic-type": 1})", "'axial-chromatic-type'"},
             {R"({"tilt": 3})", "'tilt'"},
             {R"({"tilt": [90, 0]})", "'tilt'"},
             {R"({"aperture": 3})", "'aperture'"},
             {R"({"aperture": "-"})", "'aperture' is \"-\", not the name of a file"},
             {R"({"aperture": "none.exr"})", "none.exr"}}) {
        const std::string message = error_of(text);
        EXPECT_NE(message.find(expected), std::string::npos) << text << ": " << message;
        EXPECT_NE(message.find(folder.file("")), std::string::npos) << message;
    }
}

TEST_F(LensFiles, ThatAreNestedIn33LevelsAreRefused) {
    const auto nested = [](std::size_t n) {
        return R"({"blades":)" + std::string(n, '[') + "1" + std::string(n, ']') + "}";
    };
    EXPECT_NE(error_of(nested(31)).find("'blades' is [[["), std::string::npos);
    EXPECT_NE(error_of(nested(32)).find("deeper than 32 levels"), std::string::npos);
}

// Nested too deeply for a stack, in every way; and no message repeats the refused text at length.
TEST_F(LensFiles, ThatAreNestedDeeplyAreRefused) {
    const std::size_t levels = 200'000;
    const auto nested = [&](const std::string &open, const std::string &close) {
        std::string text;
        for (std::size_t i = 0; i < levels; ++i) text += open;
        text += "1";
        for (std::size_t i = 0; i < levels; ++i) text += close;
        return R"({"blades":)" + text + "}";
    };
    for (const std::string &text : {nested("[", "]"), nested(R"({"1":)", "}"), nested("[", "")})
        EXPECT_NE(error_of(text).find("lens.json: its JSON is nested deeper than 32 levels"),
                  std::string::npos);
    EXPECT_NE(error_of(R"({"blades": [[[[3]]]]})").find("'blades' is [[[[3]]]], not"), std::string::npos);
    EXPECT_LT(error_of(R"({"name": [")" + std::string(1'000'000, 'x') + "\"]}").size(), 300u);
}

TEST_F(LensFiles, NameAPictureThatLiesBesideThem) {
    put_picture("aperture.exr");
    const auto picture = read(R"({"aperture": "aperture.exr"})").values.picture;
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->width, 3);
    EXPECT_EQ(picture->height, 2);
    EXPECT_EQ(picture->rgb, std::vector<float>(18, 0.5f));
}

// A picture of an aperture takes 100 bytes of tables per pixel, so a large one is averaged.
TEST_F(LensFiles, AverageALargePicture) {
    Image image(windows_of_size(5000, 3), {{"Y"}});
    std::ranges::fill(image.plane(0), 0.5f);
    for (std::size_t y = 0; y < 3; ++y) std::fill_n(&image.plane(0)[y * 5000], 2500, 1.5f);
    write_flat_exr(folder.file("wide.exr"), image, {});
    const auto picture = read(R"({"aperture": "wide.exr"})").values.picture;
    ASSERT_EQ(picture->width, 1667); // squares of 3
    ASSERT_EQ(picture->height, 1);
    double left = 0, all = 0;
    for (int x = 0; x < 1667; ++x)
        for (std::size_t k = 0; k < 3; ++k) {
            all += 9 * double(picture->rgb[std::size_t(x) * 3 + k]);
            left += x < 833 ? 9 * double(picture->rgb[std::size_t(x) * 3 + k]) : 0;
        }
    EXPECT_NEAR(all, 3 * 3 * (2500 * 1.5 + 2500 * 0.5), 1e-2);
    EXPECT_NEAR(left, 3 * 3 * 2500 * 1.5, 3 * 3 * 1.5 * 2); // to within a square
}

TEST_F(LensFiles, AreBeatenByValues) {
    put_picture("aperture.exr");
    put_contents(folder.file("lens.json"),
                 R"({"name": "Test", "squeeze": 2, "cat-eye": 1, "aperture": "aperture.exr"})");
    GivenLooks given;
    given.values.squeeze = 3;
    given.lens_file = folder.file("lens.json");
    EXPECT_EQ(read_looks(given, {}).name, "Test");
    EXPECT_EQ(read_looks(given, {}).values.squeeze, 3);
    EXPECT_EQ(read_looks(given, {}).values.cat_eye, 1);
    EXPECT_TRUE(read_looks(given, {}).values.picture);
    given.values.blades = 5; // instead of the picture
    EXPECT_FALSE(read_looks(given, {}).values.picture);
    put_contents(folder.file("blades.json"), R"({"blades": 6})");
    GivenLooks pictured;
    pictured.lens_file = folder.file("blades.json");
    pictured.aperture_file = folder.file("aperture.exr");
    EXPECT_TRUE(read_looks(pictured, {}).values.picture);
    EXPECT_FALSE(read_looks(pictured, {}).values.blades);
}

} // namespace
} // namespace sparselens
