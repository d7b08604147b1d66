#include "base/error.h"
#include "io/files/text_file.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <thread>

namespace sparselens {
namespace {

TEST(TextFile, AnyBytesComeBack) {
    const ScratchFolder scratch;
    const std::string path = scratch.file("file");
    for (const std::string &text :
         {std::string("two\nlines\r\n"), std::string("a\0b\xff", 4), std::string()}) {
        write_text_file(path, text);
        EXPECT_EQ(contents_of(path), text);
        EXPECT_EQ(read_text_file(path), text);
    }
}

TEST(TextFile, MayComeThroughAPipe) {
    const ScratchFolder scratch;
    const std::string pipe = scratch.file("pipe"), text(200'000, 'x');
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto before = std::signal(SIGPIPE, SIG_IGN); // for a reader that leaves early
    {
        const std::jthread writer([&] { std::ofstream(pipe) << text; });
        EXPECT_EQ(read_text_file(pipe), text);
    }
    std::signal(SIGPIPE, before);
    EXPECT_EQ(what_of<Error>([] { read_text_file("/dev/zero"); }),
              "/dev/zero: has more than 64 MB of text: it is not the file that is needed here");
}

// A sparse file, which is made at once but would take all memory to read.
TEST(TextFile, MayNotBeOfAnySize) {
    const ScratchFolder scratch;
    const std::string path = scratch.file("long.json");
    write_text_file(path, "{}");
    constexpr std::uintmax_t most = std::uintmax_t(64) << 20;
    std::filesystem::resize_file(path, most);
    EXPECT_EQ(read_text_file(path).size(), most);
    std::filesystem::resize_file(path, most + 1);
    EXPECT_EQ(what_of<Error>([&] { read_text_file(path); }),
              path + ": has more than 64 MB of text: it is not the file that is needed here");
}

TEST(TextFile, ErrorsNameTheFile) {
    const ScratchFolder scratch;
    const std::string lost = scratch.file("none/file");
    const std::string read = what_of<Error>([&] { read_text_file(lost); });
    EXPECT_TRUE(read.starts_with(lost + ": cannot open: ")) << read;
    const std::string file = scratch.file("file"), under = file + "/under";
    write_text_file(file, "text");
    const std::string written = what_of<Error>([&] { write_text_file(under, "text"); });
    EXPECT_TRUE(written.starts_with(file + ": ")) << written;
}

} // namespace
} // namespace sparselens
