// The temporary files of outputs that are not finished yet, so that a process told to stop can take them with it.
// Only after SIGKILL, or a crash, one is left: .NAME.PID-N.partial.
#pragma once

#include <string>

namespace sparselens {

// For its lifetime the file counts as unfinished. Of more than 64 at a time the rest is not remembered.
class Unfinished {
public:
    explicit Unfinished(std::string path);
    ~Unfinished();
    Unfinished(const Unfinished &) = delete;
    Unfinished &operator=(const Unfinished &) = delete;

    const std::string &path() const { return path_; }

private:
    std::string path_;
    std::size_t slot_;
};

// Unlinks them all; safe in a signal handler.
void remove_unfinished() noexcept;

} // namespace sparselens
