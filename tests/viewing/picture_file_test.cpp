#include "base/error.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"
#include "viewing/pipe_request.h"
#include "viewing/pipe_service.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {
namespace {

using Json = nlohmann::json;

TEST(PictureFile, SettingsOfAllKindsAreText) {
    const auto settings =
        settings_in(Json::parse(R"({"focus": 2.5, "lens": "petzval", "cat-eye-darkening": true,
        "tilt": [-3, 4], "fstop": {"1": 1.4, "24": 2}, "focus-pixel": {"1": [10, 20], "2": [30, 40]}})"),
                    "here");
    EXPECT_EQ(settings, (std::map<std::string, std::string>{{"focus-distance", "2.5"},
                                                            {"lens", "petzval"},
                                                            {"cat-eye-darkening", "true"},
                                                            {"tilt", "-3,4"},
                                                            {"fstop", "1:1.4,24:2"},
                                                            {"focus-pixel", "1:10,20;2:30,40"}}));
    for (const char *wrong : {"[]", R"({"a": null})", R"({"a": []})", R"({"a": [1]})", R"({"a": {"1": "x"}})",
                              R"({"a": ""})", R"({"focus": 1, "focus-distance": 2})"})
        EXPECT_THROW(settings_in(Json::parse(wrong), "here"), UsageError) << wrong;
}

class PictureFileWords : public ::testing::Test {
protected:
    void write(const std::string &name, const std::string &text) { put_contents(path(name), text); }
    std::string path(const std::string &name) const { return folder_.file(name); }
    Words words(const std::string &name, const std::string &query = {}, std::optional<int> frame = {}) const {
        return words_of({path(name), {}, query, frame}, {{"petzval", "/lenses/petzval.json"}});
    }

private:
    ScratchFolder folder_;
};

TEST_F(PictureFileWords, AQueryReplacesWhatSaysTheSame) {
    write("a.dof", R"({"ldi": "a.exr", "focus-pixel": [3, 4], "fstop": 2, "cat-eye-darkening": true})");
    EXPECT_EQ(words("a.dof"),
              (Words{path("a.exr"), "--cat-eye-darkening", "--focus-pixel", "3,4", "--fstop", "2"}));
    EXPECT_EQ(words("a.dof", "focus=5&lens-radius=0&cat-eye-darkening=false&d=half"),
              (Words{path("a.exr"), "-d", "half", "--focus-distance", "5", "--lens-radius", "0"}));
    for (const char *query : {"focus", "=1", "focus=1&focus=2", "output=x", "o=x", "ldi=x", "frame=x",
                              "threads=1", "fstop=--focus-distance", "cat-eye-darkening=2", "no-such=1"})
        EXPECT_THROW(words("a.dof", query), UsageError) << query;
}

TEST_F(PictureFileWords, FilesAreRelativeToTheFile) {
    write("a.dof",
          R"({"ldi": "shots/../a.exr", "lens": "petzval", "holdout": "b.exr", "fstop": "@keys.txt"})");
    write("keys.txt", "1:2,3:4\n");
    EXPECT_EQ(words("a.dof", "frame=2"), (Words{path("a.exr"), "--fstop", "3", "--holdout", path("b.exr"),
                                                "--lens", "/lenses/petzval.json"}));
    EXPECT_EQ(files_in(words("a.dof", "frame=2")),
              (std::vector<std::string>{path("a.exr"), path("b.exr"), "/lenses/petzval.json"}));
}

// The picture is made again if one of these files changes.
TEST_F(PictureFileWords, FilesThatFilesNameAreFound) {
    for (const char *name : {"m_0.exr", "m_1.exr", "round.exr"}) write(name, "");
    write("mine.json", R"({"aperture": "round.exr"})");
    write("a.dof", R"({"ldi": "m_%s.exr", "lens": "mine.json"})");
    EXPECT_EQ(files_in(words("a.dof")), (std::vector<std::string>{path("m_0.exr"), path("m_1.exr"),
                                                                  path("mine.json"), path("round.exr")}));
}

TEST_F(PictureFileWords, TheFrameIsOfTheRequestTheQueryOrTheName) {
    for (const char *name : {"a.dof", "a.0012.dof", "a_0012.dof", "a12.dof"})
        write(name, R"({"ldi": "s.####.exr", "fstop": {"0": 0.5, "64": 64.5}})");
    write("s.0007.exr", "");
    EXPECT_EQ(words("a.0012.dof"), (Words{path("s.0012.exr"), "--fstop", "12.5"}));
    EXPECT_EQ(words("a_0012.dof"), (Words{path("s.0012.exr"), "--fstop", "12.5"}));
    EXPECT_EQ(words("a12.dof"), (Words{path("s.0007.exr"), "--fstop", "7.5"})); // the first of the sequence
    EXPECT_EQ(words("a.0012.dof", "frame=3"), (Words{path("s.0003.exr"), "--fstop", "3.5"}));
    EXPECT_EQ(words("a.dof", "frame=3", 5), (Words{path("s.0005.exr"), "--fstop", "5.5"}));
}

TEST_F(PictureFileWords, OnlyRegularFilesAreRead) {
    write("device.dof", R"({"ldi": "/dev/zero"})");
    write("folder.dof", R"({"ldi": "."})");
    EXPECT_THROW(words("device.dof"), UsageError);
    EXPECT_THROW(words("folder.dof"), UsageError);
    EXPECT_THROW(words("none.dof"), Error);
    ASSERT_EQ(::mkfifo(path("keys").c_str(), 0600), 0); // which nobody writes
    write("keys.dof", R"({"ldi": "a.exr", "focus": "@keys"})");
    write("lens.dof", R"({"ldi": "a.exr", "lens": "keys"})");
    EXPECT_THROW(words("keys.dof"), UsageError);
    EXPECT_THROW(words("lens.dof"), UsageError);
}

TEST(PipeRequest, IsParsedOrRefused) {
    const PipeRequest request = parse_pipe_request(
        R"({"ask": "tile", "file": "a.dof", "query": "fstop=2", "settings": {"focus": 3}, "frame": -2, "level": 3,
            "box": [0, -1, 2, 3], "channels": ["R"]})");
    EXPECT_EQ(request.ask, Ask::tile);
    EXPECT_EQ(request.source.frame, -2);
    EXPECT_EQ(request.source.settings.at("focus-distance"), "3");
    EXPECT_EQ(request.box, Imath::Box2i({0, -1}, {2, 3}));
    EXPECT_EQ(request.level, 3);
    for (const char *wrong :
         {"", "[]", R"({"ask": "facts"})", R"({"file": "a"})", R"({"ask": "all", "file": "a"})",
          R"({"ask": "tile", "file": "a"})", R"({"ask": "picture", "file": "a", "box": [0, 0, 1, 1]})",
          R"({"ask": "tile", "file": "a", "box": [1, 0, 0, 0]})",
          R"({"ask": "facts", "file": "a", "level": 4})", R"({"ask": "facts", "file": "a", "frame": 1.5})",
          R"({"ask": "facts", "file": "a", "frame": 18446744073709551615})", // -1 in 64 bits
          R"({"ask": "facts", "file": "a", "channels": []})", R"({"ask": "facts", "file": "a\u0000b"})",
          R"({"ask": "facts", "file": "a", "other": 1})"})
        EXPECT_THROW(parse_pipe_request(wrong), UsageError) << wrong;
}

TEST(PipeRequest, AFlatPictureTakesThePlaceOfAFile) {
    const PipeRequest request = parse_pipe_request(
        R"({"ask": "header", "shown": true, "picture": {"display": [0, 0, 9, 4], "data": [-1, 0, 9, 2],
            "channels": ["R", "Z"], "pixel_aspect": 2, "shown": true}})");
    ASSERT_TRUE(request.handed);
    EXPECT_TRUE(request.shown && request.handed->shown);
    EXPECT_EQ(request.handed->windows, (Windows{{{0, 0}, {9, 4}}, {{-1, 0}, {9, 2}}, 2}));
    EXPECT_EQ(request.handed->bytes(), 11u * 3 * 2 * 4);
    for (
        const char *wrong :
        {R"({"ask": "header", "file": "a", "picture": {"display": [0, 0, 1, 1], "data": [0, 0, 1, 1], "channels": ["R"]}})",
         R"({"ask": "header", "picture": {"display": [0, 0, 1, 1], "channels": ["R"]}})",
         R"({"ask": "header", "picture": {"display": [0, 0, 1, 1], "data": [0, 0, 1, 1]}})",
         R"({"ask": "header", "picture": {"display": [0, 0, 1, 1], "data": [0, 0, 1, 1], "channels": ["R"], "x": 1}})",
         R"({"ask": "header", "picture": {"display": [0, 0, 1, 1], "data": [0, 0, 1000000, 1], "channels": ["R"]}})",
         R"({"ask": "header", "picture": {"display": [0, 0, 1, 1], "data": [0, 0, 1, 1], "channels": ["R"], "pixel_aspect": 0}})",
         R"({"ask": "header", "picture": []})", R"({"ask": "header", "file": "a", "shown": 1})"})
        EXPECT_THROW(parse_pipe_request(wrong), UsageError) << wrong;
}

TEST(InMemoryPictures, TheSamePictureHasTheSameFile) {
    InMemoryPictures pictures;
    const HandedLayout layout{windows_of_size(2, 1), {"R", "Z"}};
    const std::array<float, 4> values{0.5f, 3, 0.25f, 4}; // pixel by pixel
    const std::string pixels(reinterpret_cast<const char *>(values.data()), sizeof values);
    const std::string path = pictures.path_of(layout, pixels);
    const Image image = read_flat_exr(path).image;
    EXPECT_EQ(image.windows, layout.windows);
    EXPECT_EQ(image.at(find_channel(image.channels, "R"), 1, 0), 0.25f);
    EXPECT_EQ(image.at(find_channel(image.channels, "Z"), 0, 0), 3);
    std::string others = pixels;
    others[0] ^= 1;
    EXPECT_NE(pictures.path_of(layout, others), path);
    EXPECT_EQ(pictures.path_of(layout, pixels), path);
    EXPECT_THROW(pictures.path_of(layout, pixels.substr(1)), UsageError);
    EXPECT_EQ(InMemoryPictures::in_words(path + ": no"), "the picture that was handed over: no");
}

TEST(PipeService, AFileThatWasWrittenAgainIsReadAgain) {
    const ScratchFolder folder;
    ToolContext tool;
    tool.progress = std::make_unique<Progress>();
    PipeService service(tool);
    PipeRequest request{Ask::picture};
    request.source = {
        folder.file("a.exr"),
        {{"focal-length", "50"}, {"sensor-width", "36"}, {"fstop", "2"}, {"focus-distance", "3"}}};
    for (const std::size_t width : {8u, 16u, 16u}) {
        write_ldi(request.source.file, ldi_of(std::vector<TestPixel>(width, {{3}})), Imf::Header());
        EXPECT_EQ(service.answer(request).pixels.size(), width * 4 * sizeof(std::uint16_t));
    }
}

} // namespace
} // namespace sparselens
