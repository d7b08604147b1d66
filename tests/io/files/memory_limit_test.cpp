#include "base/error.h"
#include "io/files/memory_limit.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>

namespace sparselens {
namespace {

constexpr double megabyte = 1024 * 1024;

struct MemoryLimit : testing::Test {
    ~MemoryLimit() override { set_memory_limit({}); }
};

TEST_F(MemoryLimit, GrowsWithTheSizeOfTheFile) {
    EXPECT_NO_THROW(check_memory("x.exr", 64 * megabyte, 0));
    EXPECT_THROW(check_memory("x.exr", 64 * megabyte + 1, 0), Error);
    EXPECT_NO_THROW(check_memory("x.exr", 64 * megabyte + 1100 * 1000, 1000));
    EXPECT_THROW(check_memory("x.exr", 64 * megabyte + 1100 * 1000 + 1, 1000), Error);
}

TEST_F(MemoryLimit, IsWhatWasSetInstead) {
    set_memory_limit(1000);
    EXPECT_NO_THROW(check_memory("x.exr", 1000, 1 << 30));
    EXPECT_THROW(check_memory("x.exr", 1001, 1 << 30), Error);
}

TEST_F(MemoryLimit, ClaimsBeyondAnyIntegerAreRefused) {
    EXPECT_THROW(check_memory("x.exr", 0x1p80, std::numeric_limits<std::uint32_t>::max()), Error);
}

TEST_F(MemoryLimit, SaysWhichFileAsksForHowMuch) {
    try {
        check_memory("x.exr", 100 * megabyte, 0);
        FAIL();
    } catch (const Error &error) {
        EXPECT_STREQ(error.what(), "x.exr: asks for 100 MB of memory, more than is usual for a file of its "
                                   "size: give `max_memory` to allow it");
    }
}

// What control groups of both versions allow, in the group of the process and in those around it.
TEST(MemoryOfMachine, IsWhatItsControlGroupsAllow) {
    const std::uint64_t machine = memory_of_machine(), mega = 1 << 20;
    ScratchFolder folder;
    const auto put = [&](const std::string &name, const std::string &text) {
        const std::filesystem::path file = folder.file(name);
        std::filesystem::create_directories(file.parent_path());
        put_contents(file.string(), text);
    };
    const std::string root = std::filesystem::path(folder.file("x")).parent_path().string();
    EXPECT_GE(memory_of_machine(root), machine); // no groups
    put("proc/self/cgroup", "0::/pod/job\n");
    put("sys/fs/cgroup/pod/job/memory.max", "max\n");
    EXPECT_GE(memory_of_machine(root), machine);
    put("sys/fs/cgroup/pod/memory.max", std::to_string(64 * mega) + '\n');
    EXPECT_EQ(memory_of_machine(root), 64 * mega);
    put("sys/fs/cgroup/pod/job/memory.max", std::to_string(32 * mega) + '\n');
    EXPECT_EQ(memory_of_machine(root), 32 * mega);
    put("proc/self/cgroup", "0::/\n"); // as in a container of its own
    put("sys/fs/cgroup/memory.max", std::to_string(16 * mega) + '\n');
    EXPECT_EQ(memory_of_machine(root), 16 * mega);
    put("proc/self/cgroup", "12:cpu,cpuacct:/a\n4:hugetlb,memory:/docker/b\n1:name=systemd:/c:d\n");
    put("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_GE(memory_of_machine(root), machine);
    put("sys/fs/cgroup/memory/docker/b/memory.limit_in_bytes", std::to_string(8 * mega) + '\n');
    EXPECT_EQ(memory_of_machine(root), 8 * mega);
}

} // namespace
} // namespace sparselens
