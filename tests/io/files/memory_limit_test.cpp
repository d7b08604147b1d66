#include "base/error.h"
#include "io/files/memory_limit.h"

#include <gtest/gtest.h>

#include <limits>

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

} // namespace
} // namespace sparselens
