#include "harness/history.h"

#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(CommandLine, IsAsAShellReadsIt) {
    EXPECT_EQ(command_line("dof-gather", {"in.exr", "--fstop", "2.8", "--view", "0.1,-2"}),
              "dof-gather in.exr --fstop 2.8 --view 0.1,-2");
    EXPECT_EQ(command_line("t", {"my file.exr", "it's", "$HOME", "a;b", "*", "", "\u00e9"}),
              "t 'my file.exr' 'it'\\''s' '$HOME' 'a;b' '*' '' '\u00e9'");
    EXPECT_EQ(command_line("t", {"two\nlines", "\x1b[31m"}), "t 'two lines' ' [31m'");
}

TEST(CommandLine, LeavesOutWhatChangesNoPicture) {
    EXPECT_EQ(command_line("t", {"-o",
                                 "/tmp/x.exr",
                                 "in.exr",
                                 "-ox.exr",
                                 "--output",
                                 "y",
                                 "--output=y",
                                 "--threads",
                                 "4",
                                 "--threads=4",
                                 "-v",
                                 "--verbose",
                                 "--stats",
                                 "-",
                                 "--progress",
                                 "alf",
                                 "--skip-existing",
                                 "--frames=1-3",
                                 "--skip-bad-frames",
                                 "--max-memory",
                                 "1GB",
                                 "--depth-out",
                                 "z.exr",
                                 "--outside",
                                 "transparent",
                                 "-d",
                                 "float"}),
              "t in.exr --outside transparent -d float");
}

TEST(CommandLine, KeepsAllThatFollowsTheEndOfOptions) {
    EXPECT_EQ(command_line("t", {"-v", "--", "-v", "-o", "x.exr"}), "t -- -v -o x.exr");
}

std::string text_of(const Imf::Header &header, const char *name) {
    return header.typedAttribute<Imf::StringAttribute>(name).value();
}

TEST(History, GrowsByALine) {
    ToolContext tool;
    tool.command_line = "ldi-warp a.exr";
    Imf::Header header;
    append_history(header, tool);
    EXPECT_EQ(text_of(header, "Exif:ImageHistory"), "ldi-warp a.exr");
    tool.command_line = "dof-gather -";
    append_history(header, tool);
    EXPECT_EQ(text_of(header, "Exif:ImageHistory"), "ldi-warp a.exr\ndof-gather -");
    const std::string software = text_of(header, "Software");
    EXPECT_TRUE(software.starts_with("sparselens ") && software.ends_with(" : dof-gather -")) << software;
}

TEST(History, ReplacesWhatIsNoText) {
    ToolContext tool;
    tool.command_line = "t";
    Imf::Header header;
    header.insert("Exif:ImageHistory", Imf::IntAttribute(7));
    append_history(header, tool);
    EXPECT_EQ(text_of(header, "Exif:ImageHistory"), "t");
}

TEST(History, IsLeftAloneWhereNoneIsToBeTold) {
    Imf::Header header;
    header.insert("Software", Imf::StringAttribute("a renderer"));
    append_history(header, ToolContext(), {.none = true});
    EXPECT_EQ(text_of(header, "Software"), "a renderer");
    EXPECT_EQ(header.find("Exif:ImageHistory"), header.end());
}

} // namespace
} // namespace sparselens
