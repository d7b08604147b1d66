#include "base/error.h"
#include "harness/commands/each_picture.h"
#include "harness/commands/frames.h"
#include "harness/progress_lines.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string_view>

namespace sparselens {
namespace {

using Words = std::vector<std::string>;

TEST(FrameNumbers, AreThoseOfTheRange) {
    EXPECT_EQ(frame_numbers("7"), (std::vector{7}));
    EXPECT_EQ(frame_numbers("1-7x3"), (std::vector{1, 4, 7}));
    EXPECT_EQ(frame_numbers("3-1"), (std::vector{3, 2, 1}));
    EXPECT_EQ(frame_numbers("1,5-6"), (std::vector{1, 5, 6}));
    EXPECT_EQ(frame_numbers("1-5y2"), (std::vector{2, 4}));
    for (const char *wrong : {"", "abc", "1-", "1-5x", "1;2", "1-99999999999", "1-9999999", "1 2", "1,,2"})
        EXPECT_THROW(frame_numbers(wrong), UsageError) << wrong;
    EXPECT_EQ(frame_numbers("5-1x-2,7,7"), (std::vector{5, 3, 1, 7, 7}));
    for (const char *wrong : {"1,", ",1", "1-2,", "--1", "1-2x3x4"})
        EXPECT_THROW(frame_numbers(wrong), UsageError) << wrong;
}

// Open Job Description: 1-20:2, and blanks; Slurm: the same; Nuke, Tractor, Deadline, OpenCue: 1-20x2. (In OpenCue,
// 1-20:4 means all frames in another order; it gives a process its first and last frame, docs/farm.md.)
TEST(FrameNumbers, AreSpelledAsEveryEngineSpellsThem) {
    const std::vector odd{1, 3, 5, 7};
    for (const char *range : {"1-7:2", "1-7x2", "1-8:2", "1,3,5,7", "1-3:2,5-7:2", " 1 - 7:2 ", "1,3, 5,\t7"})
        EXPECT_EQ(frame_numbers(range), odd) << range;
    EXPECT_EQ(frame_numbers("1,3,5-9"), (std::vector{1, 3, 5, 6, 7, 8, 9}));
    EXPECT_EQ(frame_numbers("5-1:-2"), (std::vector{5, 3, 1}));
    for (const char *wrong : {"1-7:", "1-7::2", "1:7", "1 3", "1-7 2", "1-7:x", "- 5", "1-7 :2"})
        EXPECT_THROW(frame_numbers(wrong), UsageError) << wrong;
    EXPECT_THROW(frame_numbers("1-9999999:9"), UsageError);
    EXPECT_EQ(frame_numbers("1-9999999:10").size(), 1'000'000u);
}

TEST(FrameNumbers, MayBeNegative) {
    EXPECT_EQ(frame_numbers("-2-2"), (std::vector{-2, -1, 0, 1, 2}));
    EXPECT_EQ(frame_numbers("-3--1"), (std::vector{-3, -2, -1}));
    EXPECT_EQ(frame_numbers("1--1"), (std::vector{1, 0, -1}));
    EXPECT_EQ(frame_numbers("-7"), (std::vector{-7}));
    EXPECT_EQ(frame_numbers("-6--1:2,-1,4"), (std::vector{-6, -4, -2, -1, 4}));
}

TEST(FrameNumbers, AreAMillionAtMost) {
    EXPECT_EQ(frame_numbers("1-9999999x10").size(), 1'000'000u);
    for (const std::string wrong :
         {"1-1000001", "1-600000,1-600000", "-600000-600000", "1-9999999x9", "1-9999999y2"})
        EXPECT_EQ(what_of<UsageError>([&] { frame_numbers(wrong); }),
                  "--frames: '" + wrong + "' has more than a million frames");
}

TEST(FileAt, PutsTheNumberInEveryPlace) {
    EXPECT_EQ(file_at("a.#.exr", 12), "a.0012.exr");
    EXPECT_EQ(file_at("a.####.exr", 12), "a.0012.exr");
    EXPECT_EQ(file_at("a.##.exr", 123), "a.123.exr");
    EXPECT_EQ(file_at("a.%06d.exr", 12), "a.000012.exr");
    EXPECT_EQ(file_at("a.%d.exr", 12), "a.12.exr");
    EXPECT_EQ(file_at("%03d/a_v02.%04d.exr", 12), "012/a_v02.0012.exr");
    EXPECT_EQ(file_at("a.1-9x2##.exr", 3), "a.03.exr");
    EXPECT_EQ(file_at("100%_%s%n.exr", 3), "100%_%s%n.exr");
    EXPECT_EQ(file_at("a.####.exr", -5), "a.-005.exr"); // as with printf
    EXPECT_EQ(file_at("a.%d.exr", -5), "a.-5.exr");
    EXPECT_EQ(file_at("1-9:2#/a.-5-5##.1,3,5-9%d.exr", 3), "0003/a.03.3.exr");
    EXPECT_EQ(file_at("take2#.exr", 3), "take20003.exr");
    EXPECT_EQ(file_at("a.@@@@.exr", 12), "a.0012.exr"); // as in RV
    EXPECT_EQ(file_at("a.@@.exr", -5), "a.-5.exr");
    EXPECT_EQ(file_at("shot@2x.@me.exr", 12), "shot@2x.@me.exr"); // an ordinary name
    EXPECT_EQ(file_at("$F/a.$F4.exr", 12), "12/a.0012.exr");      // as in Houdini
    EXPECT_EQ(file_at("a.1-9$F2.exr", 3), "a.03.exr");
    for (const char *name : {"$FF.exr", "$F4x.exr", "$F0.exr", "$F12.exr", "$f4.exr", "F4.exr"})
        EXPECT_EQ(file_at(name, 12), name);
}

// The value of a list of numbers at a frame.
std::optional<double> keyed_value(const std::string &text, int frame) {
    const std::optional<Keys> keys = parse_keys(text, KeyKind::number);
    if (!keys) return {};
    return std::stod(word_at_frame(*keys, frame));
}

TEST(KeyedValue, IsLinearBetweenKeysAndHeldOutside) {
    EXPECT_EQ(keyed_value("1:5,24:2", 0), 5);
    EXPECT_EQ(keyed_value("1:5,24:2", 1), 5);
    EXPECT_EQ(keyed_value("1:5,24:2", 24), 2);
    EXPECT_EQ(keyed_value("1:5,24:2", 25), 2);
    EXPECT_DOUBLE_EQ(keyed_value("2:1,4:2,8:-6e0", 3).value(), 1.5);
    EXPECT_DOUBLE_EQ(keyed_value("8:-6,2:1,4:2", 6).value(), -2);
    EXPECT_EQ(keyed_value("-3:7", 100), 7);
}

TEST(KeyedValue, AnInfiniteKeyIsReachedAtItsFrame) {
    EXPECT_EQ(keyed_value("1:5,3:inf", 1), 5);
    EXPECT_EQ(keyed_value("1:5,3:inf", 2), INFINITY);
    EXPECT_EQ(keyed_value("1:inf,3:5", 2), INFINITY);
    EXPECT_EQ(keyed_value("1:inf,3:5", 3), 5);
}

TEST(KeyedValue, OtherWordsAreNone) {
    for (const char *text :
         {"", "5", "1:", "1:x", "1:5,", "1:5,2", "a:5", "C:\\a.exr", "peel:4", "1:5;2:6", "1.5:2"})
        EXPECT_FALSE(keyed_value(text, 1)) << text;
    EXPECT_THROW(keyed_value("1:5,1:6", 1), UsageError);
}

TEST(KeyedValue, IsAShareIfAllKeysAre) {
    EXPECT_EQ(word_at_frame(parse_keys("1:2%,3:4%", KeyKind::number).value(), 2), "3%");
    for (const char *text : {"1:2%,3:4", "1:2,3:4%", "1:%"})
        EXPECT_FALSE(parse_keys(text, KeyKind::number)) << text;
    EXPECT_FALSE(parse_keys("1:2,3%", KeyKind::pixel));
}

TEST(KeyedValue, MayHaveThousandsOfKeys) {
    std::string text = "0:0";
    for (int frame = 1; frame < 20'000; ++frame)
        text += "," + std::to_string(frame) + ":" + std::to_string(2 * frame);
    EXPECT_EQ(keyed_value(text, 12'345), 24'690);
}

TEST(KeyedPixel, IsRoundedToWholePixels) {
    const auto at = [](const std::string &text, int frame) {
        const std::optional<Keys> keys = parse_keys(text, KeyKind::pixel);
        return keys ? word_at_frame(*keys, frame) : "";
    };
    EXPECT_EQ(at("1:10,20;3:30,-41", 1), "10,20");
    EXPECT_EQ(at("1:10,20;3:30,-41", 2), "20,-10"); // -10.5 to even
    EXPECT_EQ(at("1:10,20;3:30,-41", 9), "30,-41");
    EXPECT_EQ(at("7:3,4", 1), "3,4");
    for (const char *wrong :
         {"10,20", "1:10", "1:10,20;", "1:10,20,3:30,40", "1:1.5,2", "1:inf,2", "1:1,2,3"})
        EXPECT_EQ(at(wrong, 1), "") << wrong;
}

TEST(KeysOfAFile, AreOneALineOrMore) {
    const ScratchFolder folder;
    const std::string file = folder.file("focus.txt");
    put_contents(file, "# frame:distance\n1:5.0\r\n\n 11:4,21:3 \n");
    EXPECT_EQ(word_at_frame(read_keys(file, KeyKind::number), 16), "3.5");
    put_contents(file, "1:10,20\n3:30,40;5:1,2");
    EXPECT_EQ(word_at_frame(read_keys(file, KeyKind::pixel), 2), "20,30");
    const auto message = [&](const char *contents) {
        put_contents(file, contents);
        return what_of<UsageError>([&] { read_keys(file, KeyKind::number); });
    };
    EXPECT_EQ(message("1:5\nhello\n"), file + ": line 2 is 'hello', not FRAME:VALUE (e.g. 1:5.0)");
    EXPECT_EQ(message("1:5\n1:6\n"), "frame 1 has two keys, the second is '1:6'");
    EXPECT_EQ(message("# none\n"), file + ": holds no keys, such as 1:5.0");
}

TEST(FrameCommands, KeysComeFromAFileToo) {
    const ScratchFolder folder;
    put_contents(folder.file("focus.txt"), "1:5\n3:3\n");
    const std::string at = "@" + folder.file("focus.txt");
    const Words words{"in.exr", "-o", "out.#.exr", "--frames", "1-3", "--focus-distance", at};
    EXPECT_EQ(FrameCommands(words).words(1)[6], "4");
    EXPECT_EQ(FrameCommands({"--frames", "2", "--focus-distance=" + at}).words(0)[2], "--focus-distance=4");
    EXPECT_EQ(FrameCommands({"--frames", "1", "-o", "@x.exr"}).words(0)[3], "@x.exr");
    EXPECT_EQ(FrameCommands({"--frames", "1", "--", "--focus-distance", "@x"}).words(0)[4], "@x");
    EXPECT_THROW(FrameCommands({"in.exr", "-o", "out.exr", "--focus-distance", at}), UsageError);
    EXPECT_EQ(FrameCommands({"--frames", "2", "--focus-pixel", "1:0,0;3:10,6"}).words(0)[3], "5,3");
}

TEST(FrameCommands, WithoutSequencesTheWordsAreTheCommand) {
    const Words words{"in.exr", "-o", "out.exr", "--focus-distance", "5"};
    const FrameCommands commands(words);
    EXPECT_FALSE(commands.is_range());
    ASSERT_EQ(commands.size(), 1u);
    EXPECT_EQ(commands.words(0), words);
}

TEST(FrameCommands, KeysNeedFrames) {
    for (const Words &words :
         {Words{"in.exr", "--focus-distance", "1:5,24:2"}, Words{"in.exr", "--focus-distance=1:5,24:2"}})
        EXPECT_EQ(what_of<UsageError>([&] { FrameCommands commands(words); }),
                  "--focus-distance 1:5,24:2 is keyed by frame, and keys need --frames");
}

TEST(FrameCommands, NamesAndValuesGoByTheFrame) {
    const FrameCommands commands(
        {"ldi.exr", "--frames", "1-3", "-o", "out.##.exr", "--focus-distance=1:5,3:2", "7"});
    ASSERT_EQ(commands.size(), 3u);
    EXPECT_EQ(commands.number(1), 2);
    EXPECT_EQ(commands.words(1),
              (Words{"ldi.exr", "--frames", "1-3", "-o", "out.02.exr", "--focus-distance=3.5", "7"}));
    EXPECT_EQ(commands.words(2)[5], "--focus-distance=2");
}

TEST(FrameCommands, RangesOfTheirOwnGoTogether) {
    const FrameCommands commands({"in.11-13#.exr", "-o", "out.1-3#.exr"});
    ASSERT_EQ(commands.size(), 3u);
    EXPECT_EQ(commands.words(2), (Words{"in.0013.exr", "-o", "out.0003.exr"}));
    const auto lengths = [] { FrameCommands({"in.11-13#.exr", "-o", "out.1-4#.exr"}); };
    EXPECT_EQ(what_of<UsageError>(lengths), "out.1-4#.exr has 4 frames, not 3");
}

TEST(FrameCommands, RangesInNamesAreSpelledAsElsewhere) {
    const auto names = [](const std::string &name) {
        const FrameCommands commands({name});
        std::string all;
        for (std::size_t i = 0; i < commands.size(); ++i) all += (i > 0 ? " " : "") + commands.words(i)[0];
        return all;
    };
    EXPECT_EQ(names("a.1-7:2%d"), "a.1 a.3 a.5 a.7");
    EXPECT_EQ(names("a.1-7x3%d"), "a.1 a.4 a.7");
    EXPECT_EQ(names("a.1,3,5-6%d"), "a.1 a.3 a.5 a.6");
    EXPECT_EQ(names("a.-2--1%d"), "a.-2 a.-1");
    EXPECT_EQ(names("-1-1#"), "-001 0000 0001");
    EXPECT_EQ(names("shots/-1-1%d"), "shots/-1 shots/0 shots/1");
    EXPECT_EQ(names("shot-1-3%d"), "shot-1 shot-2 shot-3"); // the first minus belongs to the name
    EXPECT_EQ(names("shot--1-0%d"), "shot--1 shot-0");
}

TEST(FrameCommands, NegativeNumbersAreFoundOnDisk) {
    const ScratchFolder folder;
    for (const char *name : {"in.-002.exr", "in.0001.exr", "in.-0001.exr"})
        put_contents(folder.file(name), "x");
    const FrameCommands commands({folder.file("in.####.exr"), "-o", "out.%d.exr"});
    ASSERT_EQ(commands.size(), 3u);
    EXPECT_EQ(commands.words(0)[2], "out.-2.exr");
    EXPECT_EQ(commands.words(1)[2], "out.-1.exr");
    EXPECT_EQ(commands.words(2)[2], "out.1.exr");
    EXPECT_EQ(FrameCommands({"--frames=-5--4", "-o", "#"}).words(0)[2], "-005");
    EXPECT_EQ(FrameCommands({"--frames", "-5-5", "-o", "#"}).size(), 11u);
}

TEST(FrameCommands, WithoutNumbersTheFilesOnDiskGiveThem) {
    const ScratchFolder folder;
    for (const char *name : {"in.0002.exr", "in.0005.exr", "in.x.exr", "out.0001.exr"})
        put_contents(folder.file(name), "x");
    const FrameCommands commands({"-o", folder.file("out.####.exr"), folder.file("in.####.exr")});
    ASSERT_EQ(commands.size(), 2u);
    EXPECT_EQ(commands.words(0)[2], folder.file("in.0002.exr"));
    EXPECT_EQ(commands.words(1)[1], folder.file("out.0005.exr"));
    EXPECT_THROW(FrameCommands({folder.file("no.####.exr"), "-o", "x.exr"}), UsageError);
    EXPECT_THROW(FrameCommands({folder.file("in.x.exr"), "-o", "x.####.exr"}), UsageError);
}

// As a regular expression in OpenImageIO, the first matches nothing and the second takes years.
TEST(FrameCommands, WhatElseStandsInAFilesNameStandsForItself) {
    const std::string stars = "t" + std::string(40, '*') + "-o.";
    for (const std::string &name : Words{"shot [v2]+(final).", stars, "-", ".", ""}) {
        const ScratchFolder folder;
        for (const char *number : {"0007", "0012", "00x7"})
            put_contents(folder.file(name + number + ".exr"), "x");
        const FrameCommands commands({folder.file(name + "####.exr"), "-o", folder.file("to/####.exr")});
        ASSERT_EQ(commands.size(), 2u) << name;
        EXPECT_EQ(commands.words(1)[0], folder.file(name + "0012.exr"));
        EXPECT_EQ(commands.words(1)[2], folder.file("to/0012.exr"));
        EXPECT_THROW(FrameCommands({folder.file("t**********************************.#e"), "-o", "#"}),
                     UsageError);
    }
}

TEST(FrameCommands, TheNumberMayStandInAFoldersName) {
    const ScratchFolder folder;
    for (const char *name : {"f0003", "f0001", "f0002", "g0004"}) {
        std::filesystem::create_directory(folder.file(name));
        if (std::string_view(name) != "f0002") put_contents(folder.file(name) + "/in.exr", "x");
    }
    const FrameCommands commands({folder.file("f####/in.exr"), "-o", "out.####.exr"});
    ASSERT_EQ(commands.size(), 2u);
    EXPECT_EQ(commands.words(0)[0], folder.file("f0001/in.exr"));
    EXPECT_EQ(commands.words(1)[2], "out.0003.exr");
}

// Signs in the name of a folder that exists belong to its name; behind it they stand for the number.
TEST(FrameCommands, AFolderOfThatNameIsThatFolder) {
    const ScratchFolder folder;
    for (const char *name : {"job #12", "a##b", "x%04d", "a@@b", "p$F4", "shots 1-3#"}) {
        const std::string in = folder.file(name) + "/", out = in + "new.##/";
        std::filesystem::create_directories(in + "more #");
        for (const char *file : {"in.0007.exr", "in.0008.exr", "still.exr"}) put_contents(in + file, "x");
        EXPECT_FALSE(FrameCommands({in + "still.exr", "-o", in + "still out.exr"}).is_range()) << name;
        for (const Words &words : {Words{in + "in.####.exr", "-o", out + "o.#.exr"},
                                   Words{in + "in.#.exr", "-o" + out + "o.#.exr",
                                         "--output=" + out + "o.#.exr", "--frames", "7-8"}}) {
            const FrameCommands commands(words);
            ASSERT_EQ(commands.size(), 2u) << name;
            EXPECT_EQ(commands.words(1)[0], in + "in.0008.exr");
            EXPECT_TRUE(commands.words(1)[1].ends_with(words[1] == "-o" ? "-o" : in + "new.08/o.0008.exr"));
            EXPECT_TRUE(commands.words(1)[2].ends_with(in + "new.08/o.0008.exr"));
            EXPECT_EQ(commands.other_frame(0, in + "in.0007.exr", 2), in + "in.0009.exr");
        }
        EXPECT_EQ(file_at(in + "more #/%d.exr", 5), in + "more #/5.exr");
    }
    EXPECT_EQ(file_at(folder.file("other #/%d.exr"), 5), folder.file("other 0005/5.exr"));
}

TEST(EachPicture, FoldersThatExistKeepTheirNames) {
    const ScratchFolder folder;
    for (const char *name : {"take %s", "50%V"}) std::filesystem::create_directory(folder.file(name));
    const std::string in = folder.file("take %s/c_%s.exr"), to = folder.file("50%V/p.%V.exr");
    for (const char *moment : {"0", "1"}) put_contents(folder.file("take %s/c_") + moment + ".exr", "x");
    EXPECT_EQ(words_for_moments({in, "--output=" + in}).at(1),
              (Words{folder.file("take %s/c_1.exr"), "--output=" + folder.file("take %s/c_1.exr")}));
    EXPECT_FALSE(asks_for_each_moment({in, "-o", folder.file("take %s/out.exr")}));
    EXPECT_EQ(words_for_one(each_view(), {"a.exr", "-o", to, "--stereo-view=all"}, "left")[2],
              folder.file("50%V/p.left.exr"));
}

TEST(FrameCommands, FramesDoNotShareAnOutput) {
    for (const Words &output :
         {Words{"-o", "out.exr"}, Words{"--output=out.exr"}, Words{"--depth-out", "-"}}) {
        Words words{"in.#.exr", "--frames", "1-2"};
        words.insert(words.end(), output.begin(), output.end());
        EXPECT_THROW(FrameCommands{words}, UsageError) << output[0];
        words[2] = "2";
        EXPECT_EQ(FrameCommands(words).size(), 1u);
    }
}

// A file with the name of a sequence is that file, unless --frames is given.
TEST(FrameCommands, AFileOfThatNameIsThatFile) {
    const ScratchFolder folder;
    put_contents(folder.file("take#2.exr"), "x");
    EXPECT_FALSE(FrameCommands({folder.file("take#2.exr"), "-o", "x.exr"}).is_range());
    EXPECT_TRUE(FrameCommands({folder.file("take#2.exr"), "--frames=1-2"}).is_range());
    const auto word = [](const Words &words, std::size_t i) { return FrameCommands(words).words(0).at(i); };
    const std::string name = folder.file("take#2.exr"), first = folder.file("take00012.exr");
    EXPECT_EQ(word({name, "-o", "x.#.exr", "--frames", "1-2"}, 0), name); // one LDI for all frames
    EXPECT_EQ(word({"in.exr", "-o", name}, 2), name);
    EXPECT_EQ(word({"in.exr", "-o", name, "--frames", "1-2"}, 2), first); // several need several outputs
    put_contents(folder.file("in.0001.exr"), "x");
    EXPECT_EQ(word({folder.file("in.#.exr"), "-o", name}, 2), first);
    put_contents(first, "x");
    EXPECT_EQ(word({name, "--frames", "1-2"}, 0), first); // that is what --frames asks for
}

TEST(FrameCommands, NegativeNumbersAreReadInBothSpellings) {
    const ScratchFolder folder;
    for (const char *name : {"in.-0003.exr", "in.-002.exr", "in.-0001.exr", "in.-001.exr", "in.0000.exr",
                             "m.-0002_0.exr", "m.-0002_1.exr"})
        put_contents(folder.file(name), "x");
    const std::string in = folder.file("in.####.exr"), moments = folder.file("m.%04d_%s.exr");
    const FrameCommands commands({in, "-o", in});
    ASSERT_EQ(commands.size(), 4u);
    EXPECT_EQ(commands.words(0), (Words{folder.file("in.-0003.exr"), "-o", folder.file("in.-003.exr")}));
    EXPECT_EQ(commands.words(1)[0], folder.file("in.-002.exr"));
    EXPECT_EQ(commands.words(2)[0], folder.file("in.-001.exr")); // as printf writes it
    EXPECT_EQ(commands.words(3)[0], folder.file("in.0000.exr"));
    EXPECT_EQ(commands.other_frame(1, folder.file("in.-002.exr"), -1), folder.file("in.-0003.exr"));
    EXPECT_TRUE(commands.warnings().empty());
    for (const char *name : {"shot-0001.exr", "shot0002.exr"}) put_contents(folder.file(name), "x");
    EXPECT_EQ(FrameCommands({folder.file("shot#.exr")}).size(), 1u); // there it is a hyphen
    EXPECT_EQ(FrameCommands({moments, "-o", "o.#.exr"}).words(0)[0], folder.file("m.-0002_%s.exr"));
}

TEST(FrameCommands, TellWhichFilesTheyLeaveOut) {
    const ScratchFolder folder;
    const auto told = [&](const std::string &name) { // the first warning
        const std::vector<std::string> warnings = FrameCommands({folder.file(name)}).warnings();
        return warnings.empty() ? "" : warnings.at(0);
    };
    const auto leaves = [&](const std::string &name, const char *how_many, const std::string &other,
                            const char *file) {
        return folder.file(name) + " leaves out " + how_many +
               " files by their number of digits: " + folder.file(other) + " takes " + folder.file(file);
    };
    for (const char *name : {"u.1.exr", "u.99.exr", "u.100.exr", "u.1000.exr", "z.01.exr", "z.0001.exr",
                             "z.002.exr", "m.1_0.exr", "m.0002_0.exr"})
        put_contents(folder.file(name), "x");
    EXPECT_EQ(told("u.#.exr"), leaves("u.#.exr", "3 of 4", "u.%d.exr", "u.1.exr"));
    EXPECT_EQ(told("u.%d.exr"), "");
    EXPECT_EQ(told("z.#.exr"), leaves("z.#.exr", "1 of 2", "z.%03d.exr", "z.002.exr"));
    EXPECT_EQ(told("m.#_%s.exr"), leaves("m.#_%s.exr", "1 of 2", "m.%d_%s.exr", "m.1_%s.exr"));
    EXPECT_EQ(what_of<UsageError>([&] { told("u.######.exr"); }),
              leaves("u.######.exr", "4 of 4", "u.%d.exr", "u.1.exr"));
    EXPECT_EQ(what_of<UsageError>([&] { told("m.##_%s.exr"); }),
              leaves("m.##_%s.exr", "2 of 2", "m.%d_%s.exr", "m.1_%s.exr"));
    EXPECT_TRUE(FrameCommands({folder.file("u.#.exr"), "--frames", "1000"}).warnings().empty());
}

TEST(FrameCommands, TellOfKeysThatNoFrameReaches) {
    const auto told = [](const char *frames, const char *keys) {
        const FrameCommands commands({"--frames", frames, "--focus-distance", keys, "--fstop=2:4"});
        return commands.warnings().size() < 2 ? "" : commands.warnings().at(0);
    };
    EXPECT_EQ(told("1001-1003", "1:2.2,3:8"),
              "--focus-distance is 8 for all frames: they are 1001 to 1003, and its keys 1 to 3");
    EXPECT_EQ(told("-3--1", "1:2.5,3:8"),
              "--focus-distance is 2.5 for all frames: they are -3 to -1, and its keys 1 to 3");
    EXPECT_TRUE(FrameCommands({"--frames", "2", "--fstop", "1:4,3:8"}).warnings().empty());
    EXPECT_TRUE(FrameCommands({"--frames", "3-9", "--fstop", "1:4,3:8"}).warnings().empty());
}

TEST(ProgressLines, AreTheFarms) {
    EXPECT_EQ(progress_line(ProgressFormat::plain, "tool", 7), "tool: 7%");
    EXPECT_EQ(progress_line(ProgressFormat::alf, "tool", 7), "ALF_PROGRESS 7%");
    EXPECT_EQ(progress_line(ProgressFormat::openjd, "tool", 100), "openjd_progress: 100");
    EXPECT_EQ(status_line("tool", {}, "warping"), "openjd_status: tool: warping");
    EXPECT_EQ(status_line("tool", {1, 24, 12}, "warping"),
              "openjd_status: tool: frame 12 (2 of 24): warping");
    EXPECT_EQ(error_prefix(ProgressFormat::openjd, "tool"), "openjd_fail: tool: ");
    EXPECT_EQ(error_prefix(ProgressFormat::alf, "tool"), "tool: ");
}

TEST(ProgressLines, CountAllFrames) {
    EXPECT_EQ(overall_percent({0, 1}, 42), 42);
    EXPECT_EQ(overall_percent({1, 4}, 0), 25);
    EXPECT_EQ(overall_percent({1, 4}, 50), 37);
    EXPECT_EQ(overall_percent({3, 4}, 100), 100);
}

} // namespace
} // namespace sparselens
