// Runs the frames of a command line in order, at most two at a time: a frame may be worked on while the one before is
// worked on or ends. A frame ends, and is written, after all earlier frames have ended, and only if they succeeded. So
// files appear and exit codes come as if frames ran one at a time.
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
    std::function<void()> work; // its exceptions are passed to `end`
    // Called once, unless the run stops first, when no earlier frame is worked on any more.
    std::function<void()> take_turn;
    std::function<int(std::exception_ptr failure)> end; // returns the exit code
    bool beside = false; // may run beside the work of the frame before; else after its success
    bool aside = false;  // on its own thread, if one is available, while later frames begin
};

class FrameRun {
public:
    explicit FrameRun(bool skip_bad_frames) : skip_bad_frames_(skip_bad_frames) {}
    ~FrameRun() { worst(); }

    // Begins a frame as soon as it may begin, and waits for its end unless it is `aside`. Returns whether to go on with
    // the next.
    bool go_on(const Frame &frame);

    // Waits until all frames have ended; returns their largest exit code.
    int worst();

    // Whether a frame failed after which nothing more is written, so that work in progress may stop.
    bool stopped() const;

private:
    struct Begun {
        std::function<void()> take_turn;
        bool worked = false; // and has succeeded
    };

    void run(const Frame &frame, std::size_t n);
    void pass_turns(); // calls take_turn of each frame whose turn has come
    bool is_well(int code) const { return code == 0 || (code == 1 && skip_bad_frames_); }

    const bool skip_bad_frames_;
    std::array<std::future<void>, 2> threads_; // of frames n and n + 1, at n % 2

    mutable std::mutex guard_; // for the members below
    std::condition_variable moved_;
    std::array<Begun, 2> at_work_;                  // indexed as threads_ is
    std::size_t begun_ = 0, turns_ = 0, ended_ = 0; // counts of frames; the first ones have done so
    bool stopped_ = false;
    int worst_ = 0;
};

} // namespace sparselens
