#include "harness/history.h"
#include "io/exr/exr_flat.h"
#include "support/scratch_folder.h"

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
                                 "-u",
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

NamedFiles written(const std::string &file) { return {{{"-o", file}}, {}, {}}; }

// An unreadable output is made again; claims in its header are checked before they are used.
TEST(History, OfWhatCannotBeReadIsAnError) {
    const ScratchFolder scratch;
    const std::string file = scratch.file("out.exr");
    ToolContext tool;
    tool.command_line = "dof-gather in.exr";
    Imf::Header header;
    append_history(header, tool);
    write_flat_exr(file, Image(windows_of_size(4, 4), {{"Y"}}), header);
    EXPECT_EQ(last_command(file), "dof-gather in.exr");
    EXPECT_EQ(freshness_of(written(file), tool.command_line), Freshness::fresh);

    std::string bytes = contents_of(file);
    const std::size_t size = bytes.find("string", bytes.find("Software")) + 7;
    bytes.replace(size, 4, "\xff\xff\xff\x7f");
    for (const char *name : {"lies.exr", "lies.sxr"}) {
        const std::string lies = scratch.file(name);
        put_contents(lies, bytes);
        EXPECT_NE(
            what_of<std::exception>([&] { last_command(lies); }).find("Software claims 2147483647 bytes"),
            std::string::npos);
        EXPECT_EQ(freshness_of(written(lies), tool.command_line), Freshness::stale);
    }
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
