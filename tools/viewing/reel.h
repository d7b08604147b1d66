// The frames of a sequence, as far as they fit into memory: each is read when it is first asked for, and those that come after
// the last one that was are read ahead, by a thread of their own. One is read at a time.
#pragma once

#include "viewing/shot_frame.h"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace sparselens {

class Reel {
public:
    using Held = std::shared_ptr<const ShotFrame>;
    using Read = std::function<ShotFrame(const std::string &path)>; // may throw

    // The files in their order; a file may be that of several frames. Frames of more than `most_bytes` are not held beside each other.
    Reel(const std::vector<std::string> &paths, std::uint64_t most_bytes, Read read);
    ~Reel(); // waits for what is being read
    Reel(const Reel &) = delete;
    Reel &operator=(const Reel &) = delete;

    // Reads it where it is not held, and throws what that throws. By any number of threads.
    Held at(const std::string &path);

    std::size_t held() const; // how many files
    bool holds(const std::string &path) const;

private:
    std::size_t number_of(const std::string &path) const;
    std::size_t ahead(std::size_t number) const;
    std::optional<std::size_t> next_ahead() const;
    void make_room(std::uint64_t bytes);
    Held read(std::unique_lock<std::mutex> &lock, std::size_t number);
    void read_ahead();

    std::vector<std::string> paths_; // each once
    std::uint64_t most_bytes_;
    Read read_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::size_t, Held> held_; // by their number
    std::vector<bool> bad_;            // that could not be read ahead
    std::size_t last_asked_ = 0;
    std::uint64_t held_bytes_ = 0, largest_ = 0; // largest: of all frames so far
    bool forwards_ = true, reading_ = false, closing_ = false;
    std::thread reader_; // last: it uses the others; none where there is one file
};

} // namespace sparselens
