// The progress of long work: the code that works reports it, and a listener (a terminal, a render farm) shows it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace sparselens {

class Progress {
public:
    // Called with the name of the stage and a whole percentage, at most once for each, on the thread that reached
    // it. An empty listener reports nothing.
    using Listener = std::function<void(const std::string &stage, int percent)>;

    // Called between the steps of long work. Throws if the work is to end.
    using Watch = std::function<void()>;

    Progress() = default;
    explicit Progress(Listener listener, Watch watch = {})
        : listener_(std::move(listener)), watch_(std::move(watch)) {}

    void start(std::string stage, std::size_t steps);
    void advance(std::size_t steps = 1); // from any thread
    void may_end() const;                // from any thread, at points where nothing is left half done

    // Counts the time that a step took, once more; from any thread.
    void spent(const std::string &step, double ms);
    void spent(const std::map<std::string, double> &ms);
    // Milliseconds of the steps since this was last called.
    std::map<std::string, double> take_times();

private:
    Listener listener_;
    Watch watch_;
    std::string stage_;
    std::size_t total_ = 0;
    std::atomic<std::size_t> done_ = 0;
    std::mutex guard_; // for ms_
    std::map<std::string, double> ms_;
};

// Counts the time until it is destroyed.
class Timed {
public:
    Timed(Progress &progress, std::string step) : progress_(progress), step_(std::move(step)) {}
    ~Timed() {
        progress_.spent(step_, std::chrono::duration<double, std::milli>(Clock::now() - begin_).count());
    }
    Timed(const Timed &) = delete;
    Timed &operator=(const Timed &) = delete;

private:
    using Clock = std::chrono::steady_clock;
    Progress &progress_;
    std::string step_;
    Clock::time_point begin_ = Clock::now();
};

// The work that a device did, and the work that it left to the CPU.

// The work since the report was last taken. The device chooses the unit of work: tiles or rows.
struct DeviceReport {
    std::size_t on_device = 0;
    std::size_t uploaded = 0;                       // bytes
    std::map<std::string, double> ms = {};          // of uploads, downloads and programs
    std::map<std::string, std::size_t> on_cpu = {}; // work left to the CPU, by its reason in a few words
    std::string failure = {};                       // not empty: how the device failed; the CPU did the rest
};

} // namespace sparselens
