// What the operating system does: files by number, stamps of files, child processes. file_stream_test.cpp has the rest.
#include "base/system/system.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

namespace sparselens::system {

namespace {

class SystemTest : public testing::Test {
protected:
    const std::string path_ = testing::TempDir() + "system_test ä";
    void SetUp() override { std::filesystem::remove(path_); }
    void TearDown() override { std::filesystem::remove(path_); }
};

std::string text_of(const UnnamedFile &file) {
    std::string text(100, '\0');
    text.resize(read_at(file.number(), text.data(), text.size(), 0));
    return text;
}

} // namespace

TEST_F(SystemTest, MakesAFileOnceAndReadsItWhereverItStands) {
    const int file = open(path_, Open::create);
    ASSERT_GE(file, 0);
    EXPECT_LT(open(path_, Open::secret), 0);
    EXPECT_EQ(errno, EEXIST);
    EXPECT_EQ(write(file, "one\ntwo\n", 8), 8);
    std::string two(9, 'x');
    EXPECT_EQ(read_at(file, two.data(), 9, 4), 4u);
    EXPECT_EQ(two.substr(0, 4), "two\n");
    EXPECT_EQ(size_of(file), 8u);
    EXPECT_FALSE(is_pipe(file));
    EXPECT_TRUE(close(file));
}

TEST_F(SystemTest, AStampChangesWithTheFileAndTheIdentityDoesNot) {
    EXPECT_FALSE(stamp_of(path_));
    std::ofstream(path_) << "a";
    const auto before = stamp_of(path_);
    std::ofstream(path_, std::ios::app) << "b";
    const auto after = stamp_of(path_);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(before->identity, after->identity);
    EXPECT_NE(before->state, after->state);
    EXPECT_EQ(stamp_of(testing::TempDir())->identity, "");
}

TEST_F(SystemTest, RunsAProgramWithItsThreeStreams) {
    const UnnamedFile in, out, said;
    write(in.number(), "given", 5);
    const std::vector<std::string> streams{in.path(), out.path(), said.path()};
    EXPECT_EQ(run_program({"sh", "-c", "cat; echo \"$1\" >&2; exit 3", "sh", "a \"b\\"}, streams), 3);
    EXPECT_EQ(text_of(out), "given");
    EXPECT_EQ(text_of(said), "a \"b\\\n");
    EXPECT_EQ(run_program({"sh", "-c", "kill -9 $$"}, streams), 128 + 9);
    EXPECT_EQ(run_program({"no-such-program-here"}, streams), -1);
    EXPECT_EQ(errno, ENOENT);
}

} // namespace sparselens::system
