// Which frames of a range have something in common that one keeps for the next, by what their jobs say (Job::keeps in tool.h).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {

class FrameNeighbours {
public:
    // What each keeps; "": nothing. None: it is not said.
    explicit FrameNeighbours(std::vector<std::optional<std::string>> keeps) : keeps_(std::move(keeps)) {}

    bool keeps_for_next(std::size_t i) const { return i + 1 < keeps_.size() && same(i, i + 1); }
    // Whether a frame takes nothing of the one before it, so that both may be worked on at the same time.
    bool are_apart(std::size_t i) const { return i > 0 && keeps_[i] && !same(i - 1, i); }

private:
    bool same(std::size_t i, std::size_t next) const { return keeps_[i] == keeps_[next] && keeps_[i] != ""; }

    std::vector<std::optional<std::string>> keeps_;
};

} // namespace sparselens
