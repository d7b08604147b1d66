#include "base/error.h"
#include "viewing/page_request.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(ViewWords, OfDofViewAloneAreLeftOut) {
    EXPECT_EQ(
        picture_words({"a.exr", "--port", "80", "--fstop", "2", "--save=d", "--open", "-v",
                       "--cat-eye-darkening", "--reference", "r.exr", "--threads", "2", "--tilt", "-3,4"}),
        (Words{"a.exr", "--fstop", "2", "--cat-eye-darkening", "--tilt", "-3,4"}));
}

TEST(ViewWords, SettingsTakeThePlaceOfWhatSaysTheSame) {
    const Words given{"a.exr",      "--fstop=2", "--focus-pixel", "3,4", "--cat-eye-darkening",
                      "--aperture", "x.exr"};
    EXPECT_EQ(words_with(given, {}), given);
    EXPECT_EQ(words_with(given, {{"fstop", ""}}), given);
    EXPECT_EQ(
        words_with(given, {{"focus-distance", "5"}}),
        (Words{"a.exr", "--fstop=2", "--cat-eye-darkening", "--aperture", "x.exr", "--focus-distance", "5"}));
    EXPECT_EQ(words_with(given, {{"lens-radius", "0"}, {"blades", "5"}, {"cat-eye-darkening", "on"}}),
              (Words{"a.exr", "--focus-pixel", "3,4", "--blades", "5", "--cat-eye-darkening", "--lens-radius",
                     "0"}));
}

TEST(ViewWords, FilesAndWhatIsNotThePictureCannotBeSet) {
    for (const char *option :
         {"lens", "aperture", "holdout", "output", "colorconfig", "threads", "device", "o", ""})
        EXPECT_THROW(words_with({"a.exr"}, {{option, "x"}}), UsageError) << option;
}

TEST(ViewWords, ALensIsSetByItsNameAlone) {
    const Presets presets{{"petzval", "/lenses/petzval.json"}};
    EXPECT_EQ(words_with({"a.exr", "--lens", "x.json"}, {{"lens", "petzval"}}, presets),
              (Words{"a.exr", "--lens", "/lenses/petzval.json"}));
    EXPECT_EQ(words_with({"a.exr"}, {{"lens", ""}}, presets), Words{"a.exr"});
    EXPECT_THROW(words_with({"a.exr"}, {{"lens", "/lenses/petzval.json"}}, presets), UsageError);
}

TEST(ViewWords, AreReadAsACommandLineIs) {
    const GatherCommand command = command_of(
        {"a.exr", "--fstop", "2.5", "--quality", "final", "--tilt", "-3,4", "--focus-distance", "inf"});
    EXPECT_EQ(command.input, "a.exr");
    EXPECT_EQ(command.lens.fstop, 2.5);
    EXPECT_EQ(command.picture.gather.lens.quality, Quality::final);
    EXPECT_EQ(command.looks.values.tilt_x, -3);
    for (const Words &words : {Words{"a.exr", "--fstop", "0"}, Words{"a.exr", "--no-such"}, Words{}})
        EXPECT_THROW(command_of(words), UsageError);
}

TEST(ViewWords, AFileOfExrHasNoDisplay) {
    const Words words{"a.exr", "--display", "P3", "--fstop", "2", "--view-transform=Raw"};
    EXPECT_EQ(words_for(words, "b.png", "normal"), words);
    EXPECT_EQ(words_for(words, "b.exr", "normal"), (Words{"a.exr", "--fstop", "2"}));
}

TEST(ViewWords, ACommandLeavesOutTheUsualQuality) {
    for (const char *usual : {"normal", "final"})
        EXPECT_EQ(words_for({"a.exr", "--quality", usual, "--fstop", "2"}, "b.png", usual),
                  (Words{"a.exr", "--fstop", "2"}));
    for (const Words &words : {Words{"a.exr", "--quality", "final"}, Words{"normal", "--quality"}})
        EXPECT_EQ(words_for(words, "b.png", "normal"), words);
}

TEST(ViewWords, AreCommandsElsewhere) {
    const Words words{"it's.exr",
                      "--fstop",
                      "2",
                      "--tilt",
                      "-3,4",
                      "--focus-distance",
                      "inf",
                      "--far",
                      "100",
                      "--display",
                      "P3",
                      "--quality=final",
                      "--cat-eye-darkening"};
    EXPECT_EQ(
        shell_command(words, "a b.png"),
        R"(dof-gather 'it'\''s.exr' --fstop 2 --tilt -3,4 --focus-distance inf --far 100 --display P3 --quality=final --cat-eye-darkening -o 'a b.png')");
    EXPECT_EQ(python_script(words, "it's.exr", "a.png"),
              "import sparselens\n"
              "ldi = sparselens.open_ldi('it\\'s.exr', far=100)\n"
              "picture = sparselens.gather(ldi, fstop=2, tilt=(-3,4), focus_distance=float('inf'), "
              "quality='final', "
              "cat_eye_darkening=True)\n"
              "sparselens.write('a.png', picture, display='P3')\n");
}

} // namespace
} // namespace sparselens
