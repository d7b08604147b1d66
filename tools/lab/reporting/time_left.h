// A line on a terminal: what is being done, how much of it there is, how long it may take. Silent elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace sparselens::lab {

class TimeLeft {
public:
    explicit TimeLeft(std::string name);
    ~TimeLeft(); // wipes the line

    // Work is weighed in seconds as guessed beforehand; guesses are scaled by how wrong they were so far.
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
