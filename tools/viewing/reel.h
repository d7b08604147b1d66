// Holds as many frames of a sequence as fit into memory. Each is read when it is first requested; a thread of its own
// reads the frames after the last requested one ahead. One file is read at a time.
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

    // `paths`: the files in order; several frames may share a file. The held frames take at most `most_bytes`, except
    // that the last requested one is always held.
    Reel(const std::vector<std::string> &paths, std::uint64_t most_bytes, Read read);
    ~Reel(); // waits for the current read
    Reel(const Reel &) = delete;
    Reel &operator=(const Reel &) = delete;

    // Returns the frame of the file; reads it if it is not held, and throws that read's errors. Any number of threads
    // may call it.
    Held at(const std::string &path);

    std::size_t held() const; // number of files
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
    std::map<std::size_t, Held> held_; // by the file's number
    std::vector<bool> bad_;            // files that could not be read ahead
    std::size_t last_asked_ = 0;
    std::uint64_t held_bytes_ = 0, largest_ = 0; // largest: of all frames so far
    bool forwards_ = true, reading_ = false, closing_ = false;
    std::thread reader_; // last: it uses the members above; none for a single file
};

} // namespace sparselens
