#include "base/error.h"
#include "viewing/reel.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <thread>

namespace sparselens {
namespace {

const std::vector<std::string> five{"a", "b", "c", "d", "e"};

ShotFrame frame_called(const std::string &path) {
    ShotFrame frame{{}, PackedRows(windows_of_size(250, 1))};
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
    Reel::Read reader(const std::string &bad = "") {
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

TEST(Reel, ReadsAheadAndRoundTheEnd) {
    Files files;
    Reel reel(five, memory_of(10), files.reader());
    EXPECT_EQ(files.read(), "");
    EXPECT_EQ(reel.at("c")->in.name, "c");
    EXPECT_EQ(files.once(5), "cdeab");
    const Reel::Held held = reel.at("a");
    EXPECT_EQ(reel.at("a"), held);
    EXPECT_EQ(files.read(), "cdeab"); // each once
    EXPECT_EQ(reel.held(), 5u);
}

TEST(Reel, GoesBackwardsWhereItIsAskedTo) {
    Files files;
    Reel reel(five, memory_of(2), files.reader());
    reel.at("c");
    EXPECT_EQ(files.once(2), "cd");
    reel.at("b");
    EXPECT_EQ(files.once(4), "cdba");
}

TEST(Reel, HoldsNoMoreThanFits) {
    Files files;
    Reel reel(five, memory_of(3.5), files.reader());
    reel.at("a");
    EXPECT_EQ(files.once(3), "abc");
    reel.at("b");
    EXPECT_EQ(files.once(4), "abcd");
    std::this_thread::sleep_for(std::chrono::milliseconds(20)); // any further read would happen now
    EXPECT_EQ(files.read(), "abcd");
    EXPECT_EQ(reel.held(), 3u);
    EXPECT_FALSE(reel.holds("a"));
}

TEST(Reel, HoldsOneHoweverLarge) {
    Files files;
    Reel reel(five, 10, files.reader());
    reel.at("a");
    reel.at("b");
    EXPECT_EQ(reel.held(), 1u);
    EXPECT_TRUE(reel.holds("b"));
    reel.at("b");
    EXPECT_EQ(files.read(), "ab");
}

TEST(Reel, WhoAsksForABadFrameIsToldAndOthersAreReadAhead) {
    Files files;
    Reel reel({"a", "b", "a", "c"}, memory_of(10), files.reader("b"));
    reel.at("a");
    EXPECT_EQ(files.once(3), "abc");
    EXPECT_THROW(reel.at("b"), Error);
    EXPECT_EQ(reel.at("c")->in.name, "c");
    EXPECT_EQ(files.read(), "abcb");
}

} // namespace
} // namespace sparselens
