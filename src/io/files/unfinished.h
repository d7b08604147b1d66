// The temporary files of unfinished outputs, so that a process told to stop can remove them. Only SIGKILL or a crash
// leaves one: .NAME.PID-N.partial.
#pragma once

#include <string>

namespace sparselens {

// For its lifetime the file counts as unfinished. At most 64 files are remembered at a time.
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

// Unlinks all unfinished files; safe in a signal handler.
void remove_unfinished() noexcept;

} // namespace sparselens
