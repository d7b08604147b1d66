#include "base/error.h"
#include "viewing/frame_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <thread>

namespace sparselens {
namespace {

const std::vector<std::string> five{"a", "b", "c", "d", "e"};

LoadedFrame frame_called(const std::string &path) {
    LoadedFrame frame{{}, PackedRows(windows_of_size(250, 1))};
    frame.in.name = path;
    Ldi ldi;
    ldi.windows = windows_of_size(250, 1);
    ldi.begin.assign(251, 1);
    ldi.begin[0] = 0;
    ldi.z = {1};
    frame.packed.append(ldi);
    return frame;
}
// Memory for this many frames.
std::uint64_t memory_of(double frames) {
    return std::uint64_t(frames * double(frame_called("any").packed.bytes()));
}

// Records the files read, in order.
class Files {
public:
    FrameCache::Read reader(const std::string &bad = "") {
        return [this, bad](const std::string &path) {
            const std::lock_guard lock(mutex_);
            read_ += path;
            if (path == bad) throw Error(path + ": cannot be read");
            return frame_called(path);
        };
    }
    // Waits until `count` files were read, or for a limited time if a fault prevents it.
    std::string once(std::size_t count) const {
        for (int i = 0; i < 2000 && read().size() < count; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return read();
    }
    std::string read() const {
        const std::lock_guard lock(mutex_);
        return read_;
    }

private:
    mutable std::mutex mutex_;
    std::string read_;
};

TEST(FrameCache, ReadsAheadAndRoundTheEnd) {
    Files files;
    FrameCache frames(five, memory_of(10), files.reader());
    EXPECT_EQ(files.read(), "");
    EXPECT_EQ(frames.at("c")->in.name, "c");
    EXPECT_EQ(files.once(5), "cdeab");
    const FrameCache::Held held = frames.at("a");
    EXPECT_EQ(frames.at("a"), held);
    EXPECT_EQ(files.read(), "cdeab"); // each once
    EXPECT_EQ(frames.held(), 5u);
}

TEST(FrameCache, GoesBackwardsWhereItIsAskedTo) {
    Files files;
    FrameCache frames(five, memory_of(2), files.reader());
    frames.at("c");
    EXPECT_EQ(files.once(2), "cd");
    frames.at("b");
    EXPECT_EQ(files.once(4), "cdba");
}

TEST(FrameCache, HoldsNoMoreThanFits) {
    Files files;
    FrameCache frames(five, memory_of(3.5), files.reader());
    frames.at("a");
    EXPECT_EQ(files.once(3), "abc");
    frames.at("b");
    EXPECT_EQ(files.once(4), "abcd");
    std::this_thread::sleep_for(std::chrono::milliseconds(20)); // any further read would happen now
    EXPECT_EQ(files.read(), "abcd");
    EXPECT_EQ(frames.held(), 3u);
    EXPECT_FALSE(frames.holds("a"));
}

TEST(FrameCache, HoldsOneHoweverLarge) {
    Files files;
    FrameCache frames(five, 10, files.reader());
    frames.at("a");
    frames.at("b");
    EXPECT_EQ(frames.held(), 1u);
    EXPECT_TRUE(frames.holds("b"));
    frames.at("b");
    EXPECT_EQ(files.read(), "ab");
}

TEST(FrameCache, WhoAsksForABadFrameIsToldAndOthersAreReadAhead) {
    Files files;
    FrameCache frames({"a", "b", "a", "c"}, memory_of(10), files.reader("b"));
    frames.at("a");
    EXPECT_EQ(files.once(3), "abc");
    EXPECT_THROW(frames.at("b"), Error);
    EXPECT_EQ(frames.at("c")->in.name, "c");
    EXPECT_EQ(files.read(), "abcb");
}

} // namespace
} // namespace sparselens
