#include "io/exr/exr_deep.h"
#include "support/ldi_samples.h"
#include "support/mattes.h"
#include "support/scratch_folder.h"
#include "viewing/frame_cache.h"
#include "viewing/page_request.h"
#include "viewing/sequence.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>

namespace sparselens {
namespace {

Words lens_words(const std::string &path) {
    return {path, "--focal-length", "50", "--sensor-width", "36", "--fstop", "2", "--focus-distance", "3"};
}

GatherCommand draft_of(const std::string &path) {
    Words words = lens_words(path);
    words.insert(words.end(), {"--proxy", "2", "--holdout", path});
    return command_of(words);
}

LoadedFrame frame_of(Ldi ldi, ObjectNames names = {}) {
    OpenedLdi in;
    in.ldi = std::move(ldi);
    LoadedFrame frame = pack(std::move(in));
    frame.depths = {2, 8};
    frame.names = std::move(names);
    return frame;
}

TEST(Sequence, FramesThatTheCacheLetsGoAreHeldByNobody) {
    const ScratchFolder folder;
    std::vector<GatherCommand> drafts;
    for (const char *name : {"a.exr", "b.exr", "c.exr"}) {
        write_ldi(folder.file(name), ldi_of(std::vector<TestPixel>(64, {{2}})), Imf::Header());
        drafts.push_back(draft_of(folder.file(name)));
    }
    ToolContext tool;
    tool.progress = std::make_unique<Progress>();
    tool.max_memory = 100; // for frames besides the one shown
    Sequence shot(drafts, tool);
    std::vector<std::weak_ptr<const LoadedFrame>> frames;
    for (const GatherCommand &draft : drafts) {
        shot.taken(draft, tool, *tool.progress);
        frames.push_back(shot.frame(draft));
    }
    EXPECT_TRUE(frames[0].expired());
    EXPECT_TRUE(frames[1].expired());
    EXPECT_FALSE(frames[2].expired());
}

// A lamp at the border with a cut-off disc.
TEST(Sequence, WarnsOfMissingOverscan) {
    const ScratchFolder folder;
    const std::string path = folder.file("a.exr");
    write_ldi(path,
              make_ldi(windows_of_size(40, 30), rgba_channels(),
                       [](int x, int y) {
                           const float light = x == 0 && y == 7 ? 50.0f : 0.5f;
                           return std::vector<Sample>{{12.886, {light, light, light, 1}}};
                       }),
              Imf::Header());
    ToolContext tool;
    tool.progress = std::make_unique<Progress>();
    const GatherCommand command =
        command_of({path, "--focal-length", "640", "--sensor-width", "40", "--lens-radius", "0.06",
                    "--focus-distance", "5", "--quality", "draft"});
    Sequence shot({command}, tool);
    const SequencePicture picture = shot.taken(command, tool, *tool.progress);
    ASSERT_EQ(picture.warnings.size(), 1u);
    EXPECT_TRUE(picture.warnings[0].ends_with("render more overscan")) << picture.warnings[0];
}

TEST(Sequence, AFileIsReadAnewWhereAnotherFocalLengthMakesItsRaysPlanar) {
    const ScratchFolder folder;
    const std::string path = folder.file("a.exr");
    write_ldi(path, ldi_of(std::vector<TestPixel>(64, {{2}})), Imf::Header());
    std::vector<GatherCommand> frames;
    for (const char *focal_length : {"10", "20"}) {
        Words words = lens_words(path);
        words[2] = focal_length;
        words.insert(words.end(), {"--depth", "distance"});
        frames.push_back(command_of(words));
    }
    ToolContext tool;
    tool.progress = std::make_unique<Progress>();
    Sequence shot(frames, tool);
    EXPECT_LT(shot.frame(frames[0])->depths.nearest, 0.95 * shot.frame(frames[1])->depths.nearest);
    EXPECT_EQ(shot.frame(frames[0]), shot.frame(frames[0]));
}

TEST(ObjectMap, NumbersDoNotComeRoundAgain) {
    constexpr int width = 65600;
    ObjectNames names;
    for (int i = 0; i < width; ++i)
        names[std::bit_cast<std::uint32_t>(hashed(std::uint32_t(i)))] = fmt::format("{:06}", i);
    const ObjectMap map = object_map(frame_of(
        make_ldi(windows_of_size(width, 1), channels_with_matte(),
                 [](int x, int) {
                     return std::vector<Sample>{{2, {1, 1, 1, 1, hashed(std::uint32_t(x)), 1, 0, 0}}};
                 }),
        names));
    const auto number = [&](int x) {
        return map.numbers[std::size_t(2 * x)] + 256 * map.numbers[std::size_t(2 * x + 1)];
    };
    EXPECT_EQ(map.said["objects"].size(), 65535u);
    EXPECT_EQ(number(0), 1);
    EXPECT_EQ(number(65534), 65535);
    EXPECT_EQ(number(65535), 0);
    EXPECT_EQ(number(65536), 0);
}

TEST(SampleFacts, AreEmptyHoweverFarAwayThePixelIs) {
    LoadedFrame frame = frame_of(ldi_of(std::vector<TestPixel>(64, {{2}})));
    frame.across = 16;
    const ThinLens lens{.radius = 0.1, .focal_px = 100, .focus = 3, .pixel_aspect = 1};
    EXPECT_EQ(sample_facts(frame, lens, {1, 0}).size(), 0u); // its middle is outside the only row
    for (const int x : {1 << 28, 1 << 30, -(1 << 28)})
        EXPECT_EQ(sample_facts(frame, lens, {x, 0}).size(), 0u) << x;
    frame.across = 1;
    EXPECT_EQ(sample_facts(frame, lens, {1, 0}).size(), 1u);
}

TEST(LensGuess, IsOfWhatIsUnknownAlone) {
    const LoadedFrame frame = frame_of(ldi_of({{{2}}, {{4}}, {{8}}}));
    EXPECT_EQ(lens_guess(frame, {}), (Words{"--focal-length", "50", "--sensor-width", "36", "--fstop", "2.8",
                                            "--focus-distance", "4"}));
    Camera camera;
    camera.focal_length_mm = 35;
    camera.fstop = 2;
    camera.focus_distance = 7;
    EXPECT_EQ(lens_guess(frame, camera), (Words{"--sensor-width", "36"}));
    camera.sensor_width_mm = 24;
    EXPECT_EQ(lens_guess(frame, camera), Words());
    Camera pinhole;
    pinhole.lens_radius = 0;
    EXPECT_EQ(lens_guess(frame, pinhole), Words());
    Camera field; // 36 mm and 50 mm do not give its field
    field.field = 1;
    field.focus_distance = 7;
    EXPECT_EQ(lens_guess(frame, field), (Words{"--focal-length", "50", "--fstop", "2.8"}));
    EXPECT_EQ(lens_guess(frame_of(ldi_of({{}, {}})), camera), Words());
    EXPECT_NE(guess_in_words({"--fstop", "2.8"}).find("a guess to begin with: --fstop 2.8"),
              std::string::npos);
    EXPECT_EQ(guess_in_words({}), "");
}

} // namespace
} // namespace sparselens
