#include "python/job.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace sparselens::python {

namespace {

struct News {
    std::string stage;
    int percent;
};

// Thrown through the work to end it early.
struct Cancelled {};

// The state that the two threads share.
class Desk {
public:
    // For any thread of the work.
    void may_end() const {
        if (cancelled_) throw Cancelled();
    }
    void post(const std::string &stage, int percent) {
        may_end();
        const std::lock_guard lock(mutex_);
        news_.push_back({stage, percent});
        changed_.notify_one();
    }
    void finish(std::exception_ptr failure) {
        const std::lock_guard lock(mutex_);
        failure_ = std::move(failure);
        done_ = true;
        changed_.notify_one();
    }

    // For the waiting thread: waits a little, takes the news since the last call, and returns whether the work is done.
    bool wait(std::vector<News> &news) {
        constexpr std::chrono::milliseconds between_signals(50);
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, between_signals, [&] { return done_ || !news_.empty(); });
        news = std::exchange(news_, {});
        return done_;
    }
    void cancel() { cancelled_ = true; }
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<News> news_;
    std::exception_ptr failure_;
    bool done_ = false;
    std::atomic<bool> cancelled_ = false;
};

// Calls back in ascending order. Threads that reach two percentages at the same time may post them in descending order.
class Teller {
public:
    explicit Teller(py::object callback) : callback_(std::move(callback)) {}

    void notify(const News &news) {
        if (callback_.is_none()) return;
        if (news.stage == last_.stage && news.percent <= last_.percent && news.percent > 0) return;
        last_ = news;
        callback_(news.stage, news.percent);
    }

private:
    py::object callback_;
    News last_{{}, -1};
};

} // namespace

void run_job(const py::object &callback, const std::function<void(Progress &)> &work) {
    if (!callback.is_none() && PyCallable_Check(callback.ptr()) == 0)
        throw py::type_error("progress: must be callable, or None");
    Desk desk;
    Progress progress([&](const std::string &stage, int percent) { desk.post(stage, percent); },
                      [&] { desk.may_end(); });
    std::thread worker([&] {
        std::exception_ptr failure;
        try {
            work(progress);
        } catch (...) {
            failure = std::current_exception();
        }
        desk.finish(failure);
    });
    const auto join = [&] {
        const py::gil_scoped_release unlocked;
        worker.join();
    };
    Teller teller(callback);
    try {
        for (bool done = false; !done;) {
            std::vector<News> news;
            {
                const py::gil_scoped_release unlocked;
                done = desk.wait(news);
            }
            for (const News &item : news) teller.notify(item);
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        }
    } catch (...) {
        desk.cancel();
        join();
        throw;
    }
    join();
    desk.rethrow();
}

} // namespace sparselens::python
