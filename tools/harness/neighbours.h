// Finds which frames of a range share something that one frame keeps for the next, from what their jobs declare
// (Job::keeps in tool.h).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {

class FrameNeighbours {
public:
    // `keeps`: what each frame keeps; "" means nothing, an empty optional that the job does not say.
    explicit FrameNeighbours(std::vector<std::optional<std::string>> keeps) : keeps_(std::move(keeps)) {}

    bool keeps_for_next(std::size_t i) const { return i + 1 < keeps_.size() && same(i, i + 1); }
    // Whether a frame takes nothing from the frame before it, so that both may be worked on at the same time.
    bool are_apart(std::size_t i) const { return i > 0 && keeps_[i] && !same(i - 1, i); }

private:
    bool same(std::size_t i, std::size_t next) const { return keeps_[i] == keeps_[next] && keeps_[i] != ""; }

    std::vector<std::optional<std::string>> keeps_;
};

} // namespace sparselens
