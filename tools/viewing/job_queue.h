// Makes one picture at a time, on the thread that asks for it. A page's newer request replaces its older one, which
// waits or is at work. Pages take turns.
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

namespace sparselens {

class JobQueue {
public:
    // Makes the bytes of an answer. Ends early, by an exception of `Progress`, if the answer is no longer wanted.
    using Work = std::function<std::string(Progress &)>;

    // The progress of a page's request.
    struct State {
        std::string stage;
        int percent = 0;
    };

    static constexpr std::size_t most_waiting = 16;

    // Waits for its turn and makes the answer; empty if the page has asked for something newer meanwhile. Throws what
    // the work throws, and Error if more than `most_waiting` pages wait. All calls must end before the studio does.
    std::optional<std::string> make(const std::string &page, const Work &work);

    // Empty if no work of the page is running.
    std::optional<State> state(const std::string &page) const;

    std::size_t waiting() const;  // works that have not begun
    std::size_t finished() const; // works that have ended

private:
    struct Job;
    bool begin(const std::shared_ptr<Job> &job);
    void end(const Job &job);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::shared_ptr<Job>> waiting_; // at most one per page
    std::shared_ptr<Job> at_work_;             // null: no work is running
    std::size_t finished_ = 0;
};

} // namespace sparselens
