#include "base/error.h"
#include "io/files/file_stream.h"
#include "support/scratch_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

namespace sparselens {
namespace {

namespace fs = std::filesystem;

void put(OutputFile &file, const std::string &text) { file.stream().write(text.data(), int(text.size())); }

void write_file(const std::string &path, const std::string &text) {
    OutputFile file(path);
    put(file, text);
    file.commit();
}

class FileStream : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("out.exr");
};

TEST_F(FileStream, AppearsWithItsCommit) {
    OutputFile file(path);
    put(file, "hello");
    EXPECT_FALSE(fs::exists(path));
    file.commit();
    EXPECT_EQ(contents_of(path), "hello");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(FileStream, WithoutCommitTheOldFileStaysAndNothingIsLeft) {
    put_contents(path, "old");
    {
        OutputFile file(path);
        put(file, std::string(std::size_t(3) << 20, 'x')); // more than is held in memory
        EXPECT_EQ(contents_of(path), "old");
    }
    EXPECT_EQ(contents_of(path), "old");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(FileStream, ReplacesTheOldFileByANewOne) {
    put_contents(path, "old and longer");
    const fs::path second_name = folder.file("hard link");
    fs::create_hard_link(path, second_name);
    write_file(path, "new");
    EXPECT_EQ(contents_of(path), "new");
    EXPECT_EQ(contents_of(second_name), "old and longer"); // readers that have it open keep the old contents
}

TEST_F(FileStream, SeeksWithinWhatIsWritten) {
    OutputFile file(path);
    put(file, "0123456789");
    EXPECT_EQ(file.stream().tellp(), 10u);
    file.stream().seekp(3);
    put(file, "ABC");
    EXPECT_EQ(file.stream().tellp(), 6u);
    file.stream().seekp(10);
    put(file, std::string(std::size_t(2) << 20, 'z'));
    file.stream().seekp(0);
    put(file, "#");
    file.commit();
    EXPECT_EQ(contents_of(path), "#12ABC6789" + std::string(std::size_t(2) << 20, 'z'));
}

TEST_F(FileStream, FollowsSymbolicLinks) {
    fs::create_directory(folder.file("there"));
    const std::string target = folder.file("there/target.exr"), link = folder.file("link");
    put_contents(target, "old");
    fs::create_symlink("there/target.exr", link); // relative to the folder of the link
    fs::create_symlink(link, folder.file("link to link"));
    write_file(folder.file("link to link"), "new");
    EXPECT_EQ(contents_of(target), "new");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_TRUE(fs::is_symlink(folder.file("link to link")));
}

TEST_F(FileStream, FollowsALinkToWhatIsNotThereYet) {
    fs::create_symlink("target.exr", folder.file("link"));
    write_file(folder.file("link"), "new");
    EXPECT_TRUE(fs::is_symlink(folder.file("link")));
    EXPECT_EQ(contents_of(folder.file("target.exr")), "new");
}

TEST_F(FileStream, LinksInACircleAreAnError) {
    fs::create_symlink("b", folder.file("a"));
    fs::create_symlink("a", folder.file("b"));
    EXPECT_THROW(write_file(folder.file("a"), "new"), Error);
    EXPECT_TRUE(fs::is_symlink(folder.file("a")));
    EXPECT_EQ(folder.entries(), 2u);
}

TEST_F(FileStream, KeepsTheModeOfWhatItReplaces) {
    put_contents(path, "old");
    ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
    write_file(path, "new");
    struct stat info {};
    ASSERT_EQ(::stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0600u);
    EXPECT_EQ(contents_of(path), "new");
}

// Root may write everything, so another user tries.
TEST_F(FileStream, AReadOnlyFileIsNotReplaced) {
    put_contents(path, "published");
    ASSERT_EQ(::chmod(path.c_str(), 0444), 0);
    ASSERT_EQ(::chmod(fs::path(path).parent_path().c_str(), 0777), 0);
    const uid_t user = ::geteuid();
    if (user == 0) {
        ASSERT_EQ(::seteuid(54321), 0);
    }
    const std::string what = what_of<Error>([&] { write_file(path, "new"); });
    ASSERT_EQ(::seteuid(user), 0);
    EXPECT_EQ(what, path + ": cannot replace: Permission denied");
    EXPECT_EQ(contents_of(path), "published");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(FileStream, KeepsTheUmask) {
    const mode_t before = ::umask(027);
    write_file(path, "x");
    ::umask(before);
    struct stat info {};
    ASSERT_EQ(::stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0640u);
}

TEST_F(FileStream, WritesThroughDevices) {
    write_file("/dev/null", "gone");
    struct stat info {};
    ASSERT_EQ(::stat("/dev/null", &info), 0);
    EXPECT_TRUE(S_ISCHR(info.st_mode));
}

// Bytes reach a pipe whole and in order even if the writer seeks back.
TEST_F(FileStream, WritesAndReadsThroughNamedPipes) {
    const std::string pipe = folder.file("pipe"), start = "v/1\x01."; // EXR's magic number and a fifth byte
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] {
        OutputFile file(pipe);
        put(file, std::string(200'000, 'a') + "end");
        file.stream().seekp(0);
        put(file, start);
        file.commit();
    });
    const auto in = open_input(pipe);
    writer.join();
    std::string text(200'003, ' ');
    in->read(text.data(), int(text.size()));
    EXPECT_EQ(text, start + std::string(199'995, 'a') + "end");
    in->seekg(199'999);
    in->read(text.data(), 4);
    EXPECT_EQ(text.substr(0, 4), "aend");
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(OpenInput, SaysThatTheShellLeavesQuotedPatternsAlone) {
    for (const std::string quoted : {"hero/view_{0..3}.0001.exr", "views/*.exr", "view_?.exr", "~/a.exr"})
        EXPECT_EQ(what_of<Error>([&] { open_input(quoted); }),
                  quoted + ": there is no such file: the shell replaces {0..3}, *, ? and ~ only outside of "
                           "quotes");
    EXPECT_EQ(what_of<Error>([&] { open_input("none~.exr"); }),
              "none~.exr: cannot open: No such file or directory");
}

TEST_F(FileStream, ReadsAndSeeksInFiles) {
    put_contents(path, "0123456789");
    const auto in = open_input(path);
    std::string text(4, ' ');
    in->seekg(5);
    in->read(text.data(), 3);
    EXPECT_EQ(text.substr(0, 3), "567");
    EXPECT_EQ(in->tellg(), 8u);
    EXPECT_EQ(what_of<Error>([&] { in->read(text.data(), 3); }), path + ": the file is truncated");
}

// OpenEXR 3.3 and later read this way. Reading beyond the end gives nothing and is not an error yet.
TEST_F(FileStream, PlacesAreReadWithoutSeeking) {
    put_contents(path, "0123456789");
    const std::string pipe = folder.file("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0666), 0);
    std::thread writer([&] { std::ofstream(pipe) << "0123456789"; });
    const auto of_pipe = open_input(pipe, Content::text);
    writer.join();
    const auto of_file = open_input(path);
    for (InputStream *in : {of_file.get(), of_pipe.get()}) {
        EXPECT_TRUE(in->isStatelessRead());
        EXPECT_EQ(in->size(), 10);
        std::string text(4, ' ');
        EXPECT_EQ(in->read(text.data(), 4, 5), 4);
        EXPECT_EQ(text, "5678");
        EXPECT_EQ(in->read(text.data(), 4, 8), 2);
        EXPECT_EQ(text, "8978");
        EXPECT_EQ(in->read(text.data(), 4, 10), 0);
        EXPECT_EQ(in->read(text.data(), 4, 1000), 0);
        EXPECT_EQ(in->tellg(), 0u);
    }
}

TEST_F(FileStream, AnotherStreamHasAPlaceOfItsOwn) {
    std::string all;
    for (int i = 0; i < 5000; ++i) all += std::to_string(i) + ",";
    put_contents(path, all);
    const auto in = open_input(path);
    in->seekg(20'000);
    const auto another = in->another();
    EXPECT_EQ(another->tellg(), 0u);
    EXPECT_EQ(another->bytes(), all.size());
    EXPECT_EQ(std::string(another->fileName()), path);
    const auto read = [](InputStream &from, std::size_t bytes) {
        std::string text(bytes, ' ');
        from.read(text.data(), int(bytes));
        return text;
    };
    EXPECT_EQ(read(*another, 3), all.substr(0, 3));
    EXPECT_EQ(read(*in, 5), all.substr(20'000, 5));
    EXPECT_EQ(read(*another, 9000), all.substr(3, 9000)); // more than is buffered
    EXPECT_EQ(read(*another, 4000), all.substr(9003, 4000));
    another->seekg(12'000);
    EXPECT_EQ(read(*another, 10), all.substr(12'000, 10));
    EXPECT_EQ(read(*in, 4), all.substr(20'005, 4));
}

TEST_F(FileStream, ErrorsNameTheFileAndTheReason) {
    const std::string nowhere = folder.file("missing/out.exr");
    EXPECT_EQ(what_of<Error>([&] { open_input(nowhere); }),
              nowhere + ": cannot open: No such file or directory");
    EXPECT_TRUE(what_of<Error>([&] {
                    open_input("/dev/zero");
                }).starts_with("/dev/zero: not an EXR file")); // endless
    EXPECT_EQ(what_of<Error>([&] { open_input(folder.file("")); }),
              folder.file("") + ": is a folder, not a file");
    EXPECT_EQ(what_of<Error>([&] { OutputFile file(folder.file("")); }),
              folder.file("") + ": cannot write: Is a directory");
    EXPECT_EQ(folder.entries(), 0u);
}

TEST_F(FileStream, MakesTheFolderOfAnOutput) {
    const std::string made = folder.file("made/too/out.exr");
    OutputFile(made).commit();
    EXPECT_TRUE(fs::is_regular_file(made));
}

TEST_F(FileStream, AFullDeviceIsAnError) {
    EXPECT_EQ(what_of<Error>([] { write_file("/dev/full", "x"); }),
              "/dev/full: cannot write: No space left on device");
}

TEST_F(FileStream, NamesMayBeAsLongAsTheFileSystemTakes) {
    const std::string longest = folder.file(std::string(255, 'n'));
    write_file(longest, "x");
    EXPECT_EQ(contents_of(longest), "x");
}

TEST_F(FileStream, OddNamesAreNames) {
    for (const char *name : {"with space", "it's \"quoted\"", "-o", "two\nlines", "%d $HOME `x`"}) {
        write_file(folder.file(name), name);
        EXPECT_EQ(contents_of(folder.file(name)), name);
    }
}

TEST_F(FileStream, ManyAtOnceBesideEachOther) {
    OutputFile one(path), two(path);
    put(one, "one");
    put(two, "two");
    two.commit();
    EXPECT_EQ(contents_of(path), "two");
    one.commit();
    EXPECT_EQ(contents_of(path), "one");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(DisplayName, OfTheStandardStream) {
    EXPECT_EQ(display_name("-"), "standard stream");
    EXPECT_EQ(display_name("./-"), "./-");
}

TEST(MakeFolder, MakesWhatIsMissing) {
    const ScratchFolder scratch;
    const std::string folder = scratch.file("a/b/c");
    make_folder(folder);
    EXPECT_TRUE(std::filesystem::is_directory(folder));
    put_contents(folder + "/file", "text");
    make_folder(folder); // it exists: nothing happens
    EXPECT_EQ(contents_of(folder + "/file"), "text");
}

TEST(MakeFolder, NamesWhatItCannotMake) {
    const ScratchFolder scratch;
    const std::string file = scratch.file("file");
    put_contents(file, "text");
    for (const std::string &folder : {file, file + "/under"}) {
        const std::string what = what_of<Error>([&] { make_folder(folder); });
        EXPECT_TRUE(what.starts_with(folder + ": cannot create the folder: ")) << what;
    }
    EXPECT_EQ(contents_of(file), "text");
}

} // namespace
} // namespace sparselens
