// One picture at a time: pages ask, a thread of its own works. What a page asks for anew takes the place of what it asked for
// before, whether that waits or is at work; pages take turns.
#pragma once

#include "base/progress.h"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace sparselens {

class Studio {
public:
    // Makes the bytes of an answer. Ends early, by an exception of `Progress`, where nobody wants it any more.
    using Work = std::function<std::string(Progress &)>;

    // What is being made for a page.
    struct State {
        std::string stage;
        int percent = 0;
    };

    static constexpr std::size_t most_waiting = 16;

    Studio();
    ~Studio(); // ends what is at work
    Studio(const Studio &) = delete;
    Studio &operator=(const Studio &) = delete;

    // Waits for the answer; empty where the page has asked for something newer meanwhile. Rethrows what the work throws.
    // Throws Error where more than `most_waiting` pages wait.
    std::optional<std::string> make(const std::string &page, Work work);

    // Empty where nothing is at work for the page.
    std::optional<State> state(const std::string &page) const;

    std::size_t waiting() const;  // how many works are still to be begun
    std::size_t finished() const; // how many works have come to their end

private:
    struct Job;
    void run();
    void work_on(Job &job);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::shared_ptr<Job>> waiting_; // one a page at most
    std::shared_ptr<Job> at_work_;             // null: none is
    std::size_t finished_ = 0;
    bool closing_ = false;
    std::thread worker_; // last: it uses the others
};

} // namespace sparselens
