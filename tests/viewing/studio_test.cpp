#include "base/error.h"
#include "viewing/studio.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <vector>

namespace sparselens {
namespace {

using Answer = std::future<std::optional<std::string>>;

// A work that runs until it is released or no longer wanted, or for a limited time if a fault prevents both.
class Held {
public:
    Answer begin(Studio &studio, const std::string &page, const std::string &answer) {
        Answer asked = std::async(std::launch::async, [&studio, page, answer, this] {
            return studio.make(page, [this, answer](Progress &progress) {
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

TEST(Studio, AnswersAndFails) {
    Studio studio;
    EXPECT_EQ(studio.make("a", at_once), "now");
    EXPECT_THROW(studio.make("a", [](Progress &) -> std::string { throw UsageError("no"); }), UsageError);
    EXPECT_EQ(studio.make("a", at_once), "now");
    EXPECT_EQ(studio.finished(), 3u);
    EXPECT_FALSE(studio.state("a"));
}

TEST(Studio, NewerWorkEndsWhatIsAtWork) {
    Studio studio;
    Held held;
    Answer old = held.begin(studio, "a", "old");
    EXPECT_EQ(studio.state("a")->stage, "holding");
    EXPECT_FALSE(studio.state("b"));
    EXPECT_EQ(studio.make("a", at_once), "now"); // although the old one is not released
    EXPECT_FALSE(old.get());
    EXPECT_EQ(studio.finished(), 1u);
}

TEST(Studio, NewerWorkTakesThePlaceOfWhatWaits) {
    Studio studio;
    Held held;
    Answer other = held.begin(studio, "b", "other");
    const auto move = [&] {
        return std::async(std::launch::async, [&studio] { return studio.make("a", at_once); });
    };
    Answer last = move();
    while (studio.waiting() == 0) std::this_thread::yield();
    for (int i = 0; i < 9; ++i) {
        Answer newer = move();
        EXPECT_FALSE(last.get()); // ended by the newer request
        last = std::move(newer);
    }
    EXPECT_EQ(studio.waiting(), 1u);
    held.free = true;
    EXPECT_EQ(other.get(), "other"); // the other page keeps its own request
    EXPECT_EQ(last.get(), "now");
    EXPECT_EQ(studio.finished(), 2u);
}

TEST(Studio, IsLeftWithWorkInHand) {
    Held held;
    Answer asked;
    {
        Studio studio;
        asked = held.begin(studio, "a", "never");
        std::thread([&held] {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            held.free = true;
        }).detach();
        EXPECT_EQ(asked.get(), "never");
    }
}

TEST(Crew, DoesAllWithFewThreads) {
    std::atomic<int> done = 0, at_once_now = 0, most = 0;
    {
        Crew crew;
        for (int i = 0; i < 1000; ++i)
            crew.add([&] {
                const int now = ++at_once_now;
                for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
                }
                std::this_thread::sleep_for(std::chrono::microseconds(100));
                --at_once_now;
                ++done;
            });
    }
    EXPECT_EQ(done, 1000);
    EXPECT_LE(most, int(Crew::most_at_once));
}

} // namespace
} // namespace sparselens
