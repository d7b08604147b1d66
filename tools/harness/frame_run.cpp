#include "harness/frame_run.h"

#include <algorithm>
#include <system_error>

namespace sparselens {

bool FrameRun::go_on(const Frame &frame) {
    std::size_t n = 0;
    {
        std::unique_lock lock(guard_);
        n = begun_;
        moved_.wait(lock, [&] {
            return ended_ == n || (ended_ + 1 == n && (frame.beside || at_work_[(n - 1) % 2].worked));
        });
        if (stopped_) return false;
        at_work_[n % 2] = {frame.take_turn};
        ++begun_;
        pass_turns();
    }
    std::future<void> &thread = threads_[n % 2]; // frame n - 2, which used it, has ended
    if (frame.aside) try {
            thread = std::async(std::launch::async, [this, frame, n] { run(frame, n); });
            return true;
        } catch (const std::system_error &) { // no thread is available
        }
    run(frame, n);
    return !stopped();
}

void FrameRun::run(const Frame &frame, std::size_t n) {
    std::exception_ptr failure;
    try {
        frame.work();
    } catch (...) {
        failure = std::current_exception();
    }
    std::unique_lock lock(guard_);
    at_work_[n % 2].worked = !failure;
    pass_turns();
    moved_.notify_all();
    moved_.wait(lock, [&] { return ended_ == n; });
    if (!stopped_) {
        lock.unlock();
        const int code = frame.end(failure);
        lock.lock();
        worst_ = std::max(worst_, code);
        stopped_ = !is_well(code);
    }
    ++ended_;
    pass_turns();
    moved_.notify_all();
}

void FrameRun::pass_turns() {
    for (; !stopped_ && turns_ < begun_; ++turns_) {
        if (turns_ > ended_ && !at_work_[(turns_ - 1) % 2].worked) return;
        at_work_[turns_ % 2].take_turn();
    }
}

int FrameRun::worst() {
    for (std::future<void> &thread : threads_)
        if (thread.valid()) thread.get();
    return worst_;
}

bool FrameRun::stopped() const {
    const std::lock_guard lock(guard_);
    return stopped_;
}

} // namespace sparselens
