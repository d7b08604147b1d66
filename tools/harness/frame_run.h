// Runs the frames of a command line in order, at most two at a time: a frame may be worked on while the one before is
// worked on or ends. A frame ends, and is written, after all earlier frames have ended, and only if they succeeded. So
// files appear and exit codes come as if frames ran one at a time.
#pragma once

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

// Finds which frames of a range share something that one frame keeps for the next, from what their jobs declare
// (Job::keeps in tool.h).
class FrameNeighbours {
public:
    // `keeps`: what each frame keeps; "" means nothing, an empty optional that the job does not say.
    explicit FrameNeighbours(std::vector<std::optional<std::string>> keeps) : keeps_(std::move(keeps)) {}

    bool keeps_for_next(std::size_t i) const { return i + 1 < keeps_.size() && same(i, i + 1); }
    // Whether a frame takes nothing from the frame before it, so that both may be worked on at the same time.
    bool are_apart(std::size_t i) const { return i > 0 && keeps_[i] && !same(i - 1, i); }

private:
    bool same(std::size_t i, std::size_t next) const { return keeps_[i] == keeps_[next] && keeps_[i] != ""; }

    std::vector<std::optional<std::string>> keeps_;
};

// Decides whether two frames fit into memory at the same time. Estimates a frame's memory from the size of its files,
// with the largest memory per byte that earlier frames took.
class TwoAtOnce {
public:
    // `bytes`: size of the files that each frame reads, 0 if unknown. `memory`: limit for both frames, in bytes.
    TwoAtOnce(std::vector<std::uint64_t> bytes, std::uint64_t memory)
        : bytes_(std::move(bytes)), memory_(double(memory)) {}

    // Whether frame i may run beside the frame before it. Call for each frame in order, before it begins; `peak` is the
    // largest memory use of the process so far, in bytes. The first two frames run alone, to measure what one takes.
    bool fit(std::size_t i, std::uint64_t peak) {
        if (i == 2) per_byte_ = double(peak) / of(0);
        if (i > 2) per_byte_ = std::max(per_byte_, double(peak) / most_at_once_);
        const double both = i > 0 ? of(i - 1) + of(i) : 0;
        const bool two = i >= 2 && per_byte_ * both <= memory_;
        most_at_once_ = std::max(most_at_once_, two ? both : of(i));
        return two;
    }

private:
    double of(std::size_t i) const { return double(std::max<std::uint64_t>(bytes_[i], 1)); }

    std::vector<std::uint64_t> bytes_;
    double memory_;
    double per_byte_ = 0, most_at_once_ = 0;
};

} // namespace sparselens
