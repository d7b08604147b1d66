// Prints the messages of frames in order: messages of a later frame are kept until its turn.
#pragma once

#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace sparselens {

class InTurn {
public:
    explicit InTurn(bool come) : come_(come) {}

    // Calls `line` now or when the turn comes, one at a time. `line` must not call say().
    void say(std::function<void()> line) {
        const std::lock_guard lock(guard_);
        if (come_)
            line();
        else
            kept_.push_back(std::move(line));
    }

    void come() {
        const std::lock_guard lock(guard_);
        come_ = true;
        for (const auto &line : std::exchange(kept_, {})) line();
    }

private:
    std::mutex guard_; // for the members below, and for printing
    bool come_;
    std::vector<std::function<void()>> kept_;
};

} // namespace sparselens
