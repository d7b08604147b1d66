#include "base/error.h"
#include "viewing/job_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>

namespace sparselens {
namespace {

using Answer = std::future<std::optional<std::string>>;

// A work that runs until it is released or no longer wanted, or for a limited time if a fault prevents both.
class Held {
public:
    Answer begin(JobQueue &queue, const std::string &page, const std::string &answer) {
        Answer asked = std::async(std::launch::async, [&queue, page, answer, this] {
            return queue.make(page, [this, answer](Progress &progress) {
                const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(10);
                for (int percent = 0; !free && std::chrono::steady_clock::now() < latest;
                     percent = std::min(percent + 1, 50)) {
                    progress.start("holding", 100);
                    progress.advance(std::size_t(percent));
                    if (percent == 0) begun.set_value(); // its state is known now
                    progress.may_end();
                    std::this_thread::sleep_for(std::chrono::milliseconds(1));
                }
                return answer;
            });
        });
        begun.get_future().wait();
        return asked;
    }
    std::promise<void> begun;
    std::atomic<bool> free = false;
};

std::string at_once(Progress &) { return "now"; }

TEST(JobQueue, AnswersAndFails) {
    JobQueue queue;
    EXPECT_EQ(queue.make("a", at_once), "now");
    EXPECT_THROW(queue.make("a", [](Progress &) -> std::string { throw UsageError("no"); }), UsageError);
    EXPECT_EQ(queue.make("a", at_once), "now");
    EXPECT_EQ(queue.finished(), 3u);
    EXPECT_FALSE(queue.state("a"));
}

TEST(JobQueue, NewerWorkEndsWhatIsAtWork) {
    JobQueue queue;
    Held held;
    Answer old = held.begin(queue, "a", "old");
    EXPECT_EQ(queue.state("a")->stage, "holding");
    EXPECT_FALSE(queue.state("b"));
    EXPECT_EQ(queue.make("a", at_once), "now"); // although the old one is not released
    EXPECT_FALSE(old.get());
    EXPECT_EQ(queue.finished(), 1u);
}

TEST(JobQueue, NewerWorkTakesThePlaceOfWhatWaits) {
    JobQueue queue;
    Held held;
    Answer other = held.begin(queue, "b", "other");
    const auto move = [&] {
        return std::async(std::launch::async, [&queue] { return queue.make("a", at_once); });
    };
    Answer last = move();
    while (queue.waiting() == 0) std::this_thread::yield();
    for (int i = 0; i < 9; ++i) {
        Answer newer = move();
        EXPECT_FALSE(last.get()); // ended by the newer request
        last = std::move(newer);
    }
    EXPECT_EQ(queue.waiting(), 1u);
    held.free = true;
    EXPECT_EQ(other.get(), "other"); // the other page keeps its own request
    EXPECT_EQ(last.get(), "now");
    EXPECT_EQ(queue.finished(), 2u);
}

TEST(JobQueue, IsLeftWithWorkInHand) {
    Held held;
    Answer asked;
    {
        JobQueue queue;
        asked = held.begin(queue, "a", "never");
        std::thread([&held] {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            held.free = true;
        }).detach();
        EXPECT_EQ(asked.get(), "never");
    }
}

} // namespace
} // namespace sparselens
