#include "viewing/studio.h"

#include "base/error.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <utility>

namespace sparselens {

namespace {

// An exception that ends the work early.
struct Outdated {};

} // namespace

struct Studio::Job {
    std::string page;
    Work work;
    std::atomic<bool> outdated = false;
    bool done = false;
    std::string answer = {};
    std::exception_ptr failure = {};
    State state = {};
};

Studio::Studio() : worker_([this] { run(); }) {}

Studio::~Studio() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
        if (at_work_) at_work_->outdated = true;
        for (const auto &job : waiting_) job->outdated = true;
        changed_.notify_all();
    }
    worker_.join();
}

std::optional<std::string> Studio::make(const std::string &page, Work work) {
    const auto job = std::make_shared<Job>();
    job->page = page;
    job->work = std::move(work);
    std::unique_lock lock(mutex_);
    if (at_work_ && at_work_->page == page) at_work_->outdated = true;
    const auto before = std::ranges::find(waiting_, page, [](const auto &other) { return other->page; });
    if (before != waiting_.end()) {
        (*before)->outdated = true;
        *before = job; // keeps its turn
    } else if (waiting_.size() < most_waiting) {
        waiting_.push_back(job);
    } else {
        throw Error("too many pages wait for pictures: close some");
    }
    changed_.notify_all();
    changed_.wait(lock, [&] { return job->done || job->outdated; });
    if (job->outdated) return {};
    if (job->failure) std::rethrow_exception(job->failure);
    return std::move(job->answer);
}

std::optional<Studio::State> Studio::state(const std::string &page) const {
    const std::lock_guard lock(mutex_);
    if (!at_work_ || at_work_->page != page) return {};
    return at_work_->state;
}

std::size_t Studio::waiting() const {
    const std::lock_guard lock(mutex_);
    return waiting_.size();
}

std::size_t Studio::finished() const {
    const std::lock_guard lock(mutex_);
    return finished_;
}

void Studio::run() {
    for (;;) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return closing_ || !waiting_.empty(); });
        if (closing_) return;
        at_work_ = waiting_.front();
        waiting_.pop_front();
        const std::shared_ptr<Job> job = at_work_;
        lock.unlock();
        work_on(*job);
        lock.lock();
        at_work_.reset();
        job->done = true;
        if (!job->outdated) ++finished_;
        changed_.notify_all();
    }
}

// The answer is read only after the job is done.
void Studio::work_on(Job &job) {
    const auto watch = [&job] {
        if (job.outdated) throw Outdated();
    };
    const auto say = [&](const std::string &stage, int percent) {
        watch();
        const std::lock_guard lock(mutex_);
        job.state = {stage, percent};
    };
    try {
        Progress progress(say, watch);
        job.answer = job.work(progress);
    } catch (const Outdated &) {
        return; // nobody waits for the answer
    } catch (...) {
        job.failure = std::current_exception();
    }
}

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
