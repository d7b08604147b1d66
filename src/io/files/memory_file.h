// A file in memory for code that writes or reads files only by name. It is in no folder, so no other user can open it,
// put a link in its place, or find it after a crash.
#pragma once

#include <string>
#include <string_view>

namespace sparselens {

class MemoryFile {
public:
    explicit MemoryFile(std::string_view contents = {}); // throws Error if the system provides none
    ~MemoryFile();                                       // removes the file, too
    MemoryFile(const MemoryFile &) = delete;
    MemoryFile &operator=(const MemoryFile &) = delete;

    // A path that opens the file, in this process only.
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

} // namespace sparselens
