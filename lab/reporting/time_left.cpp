#include "lab/reporting/time_left.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace sparselens::lab {

TimeLeft::TimeLeft(std::string name)
    : name_(std::move(name)), visible_(isatty(STDERR_FILENO)), start_(std::chrono::steady_clock::now()) {}

TimeLeft::~TimeLeft() {
    if (visible_) std::fputs("\r\033[K", stderr);
}

void TimeLeft::expect(double weight) {
    expected_ += weight;
    ++steps_;
}

void TimeLeft::begin(const std::string &what) {
    ++step_;
    if (!visible_) return;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
    const double scale = done_ > 0 ? passed.count() / done_ : 1;
    const int seconds = int((expected_ - done_) * scale);
    fmt::print(stderr, "\r\033[K{}: {} of {}, {}:{:02} left: {}", name_, step_, steps_, seconds / 60,
               seconds % 60, what);
}

void TimeLeft::end(double weight) { done_ += weight; }

} // namespace sparselens::lab
