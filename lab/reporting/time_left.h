// A line on a terminal with the current step, the number of steps and the time left. Prints nothing elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace sparselens::lab {

class TimeLeft {
public:
    explicit TimeLeft(std::string name);
    ~TimeLeft(); // clears the line

    // The weight of work is its estimated time in seconds; estimates are scaled by the times measured so far.
    void expect(double weight);
    void begin(const std::string &what);
    void end(double weight);

private:
    std::string name_;
    bool visible_;
    std::chrono::steady_clock::time_point start_;
    double expected_ = 0, done_ = 0;
    int steps_ = 0, step_ = 0;
};

} // namespace sparselens::lab
