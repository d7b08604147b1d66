#include "viewing/crew.h"

#include <exception>
#include <utility>

namespace sparselens {

void Crew::add(std::function<void()> task) {
    const std::lock_guard lock(mutex_);
    if (ending_) return;
    waiting_.push_back(std::move(task));
    if (idle_ < waiting_.size() && threads_.size() < most_at_once) try {
            threads_.emplace_back([this] { run(); });
        } catch (const std::exception &) { // no memory for another thread: the existing ones do the task
            if (threads_.empty()) {
                waiting_.pop_back();
                throw;
            }
        }
    changed_.notify_all();
}

void Crew::end() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        changed_.notify_all();
    }
    for (std::thread &thread : threads_) thread.join();
    threads_.clear();
}

void Crew::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        ++idle_;
        changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
        --idle_;
        if (waiting_.empty()) return;
        const std::function<void()> task = std::move(waiting_.front());
        waiting_.pop_front();
        changed_.notify_all();
        lock.unlock();
        task();
        lock.lock();
    }
}

} // namespace sparselens
