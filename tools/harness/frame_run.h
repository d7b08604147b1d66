// The frames of a command line, in their order, no more than two at a time: one may be worked on while the one before it is worked
// on or ends. A frame ends, which writes it, when those before it have ended, and if all was well with them; so files appear and
// exit codes come as if there were one at a time.
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <future>
#include <mutex>

namespace sparselens {

struct Frame {
    std::function<void()> work; // what it throws reaches `end`
    // Called once, unless the run stops before: no frame before this is worked on any more.
    std::function<void()> take_turn;
    std::function<int(std::exception_ptr failure)> end; // returns the exit code
    bool beside = false; // the work of the one before; else that is done first, and well
    bool aside = false;  // on a thread of its own, if one can be had, while others are begun
};

class FrameRun {
public:
    explicit FrameRun(bool skip_bad_frames) : skip_bad_frames_(skip_bad_frames) {}
    ~FrameRun() { worst(); }

    // Begins a frame as soon as it may begin, and waits for its end unless it is aside. Whether to go on with the next.
    bool go_on(const Frame &frame);

    // The largest exit code of all; all have ended.
    int worst();

    // Whether a frame failed after which nothing is written: what is still at work may give up.
    bool stopped() const;

private:
    struct Begun {
        std::function<void()> take_turn;
        bool worked = false; // and well
    };

    void run(const Frame &frame, std::size_t n);
    void pass_turns(); // to those whose turn has come
    bool is_well(int code) const { return code == 0 || (code == 1 && skip_bad_frames_); }

    const bool skip_bad_frames_;
    std::array<std::future<void>, 2> threads_; // of frames n and n + 1, at n % 2

    mutable std::mutex guard_; // of what follows
    std::condition_variable moved_;
    std::array<Begun, 2> at_work_;                  // as threads_
    std::size_t begun_ = 0, turns_ = 0, ended_ = 0; // frames that have: the first ones
    bool stopped_ = false;
    int worst_ = 0;
};

} // namespace sparselens
