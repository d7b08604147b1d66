#include "viewing/job_queue.h"

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

struct JobQueue::Job {
    std::string page;
    std::atomic<bool> outdated = false;
    State state = {};
};

// Waits until it is the job's turn; returns false if it is outdated before.
bool JobQueue::begin(const std::shared_ptr<Job> &job) {
    std::unique_lock lock(mutex_);
    if (at_work_ && at_work_->page == job->page) at_work_->outdated = true;
    const auto before = std::ranges::find(waiting_, job->page, [](const auto &other) { return other->page; });
    if (before != waiting_.end()) {
        (*before)->outdated = true;
        *before = job; // keeps its turn
    } else if (waiting_.size() < most_waiting) {
        waiting_.push_back(job);
    } else {
        throw Error("too many pages wait for pictures: close some");
    }
    changed_.notify_all();
    changed_.wait(lock, [&] { return job->outdated || (!at_work_ && waiting_.front() == job); });
    if (job->outdated) return false;
    waiting_.pop_front();
    at_work_ = job;
    return true;
}

void JobQueue::end(const Job &job) {
    const std::lock_guard lock(mutex_);
    at_work_.reset();
    if (!job.outdated) ++finished_;
    changed_.notify_all();
}

std::optional<std::string> JobQueue::make(const std::string &page, const Work &work) {
    const auto job = std::make_shared<Job>();
    job->page = page;
    if (!begin(job)) return {};
    const std::shared_ptr<void> ended(nullptr, [&](void *) { end(*job); });
    const auto watch = [&] {
        if (job->outdated) throw Outdated();
    };
    const auto say = [&](const std::string &stage, int percent) {
        watch();
        const std::lock_guard lock(mutex_);
        job->state = {stage, percent};
    };
    try {
        Progress progress(say, watch);
        std::string answer = work(progress);
        return job->outdated ? std::nullopt : std::optional(std::move(answer));
    } catch (const Outdated &) {
        return {};
    }
}

std::optional<JobQueue::State> JobQueue::state(const std::string &page) const {
    const std::lock_guard lock(mutex_);
    if (!at_work_ || at_work_->page != page) return {};
    return at_work_->state;
}

std::size_t JobQueue::waiting() const {
    const std::lock_guard lock(mutex_);
    return waiting_.size();
}

std::size_t JobQueue::finished() const {
    const std::lock_guard lock(mutex_);
    return finished_;
}

} // namespace sparselens
