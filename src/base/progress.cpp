#include "base/progress.h"

namespace sparselens {

void Progress::start(std::string stage, std::size_t steps) {
    stage_ = std::move(stage);
    total_ = steps;
    done_ = 0;
    if (listener_) listener_(stage_, 0);
}

void Progress::advance(std::size_t steps) {
    if (!listener_ || total_ == 0) return;
    const std::size_t after = done_.fetch_add(steps) + steps;
    const int percent = int(100 * after / total_), before = int(100 * (after - steps) / total_);
    if (percent != before) listener_(stage_, percent);
}

void Progress::may_end() const {
    if (watch_) watch_();
}

void Progress::spent(const std::string &step, double ms) {
    const std::lock_guard lock(guard_);
    ms_[step] += ms;
}

void Progress::spent(const std::map<std::string, double> &ms) {
    for (const auto &[step, some] : ms) spent(step, some);
}

std::map<std::string, double> Progress::take_times() {
    const std::lock_guard lock(guard_);
    return std::exchange(ms_, {});
}

} // namespace sparselens
