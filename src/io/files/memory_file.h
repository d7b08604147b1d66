// A file in memory for code that writes or reads files by name only. No folder holds it, so nobody else can meet it, put a
// link in its place, or find it after a crash.
#pragma once

#include <string>
#include <string_view>

namespace sparselens {

class MemoryFile {
public:
    explicit MemoryFile(std::string_view contents = {}); // throws Error where the system gives none
    ~MemoryFile();                                       // the file is gone, too
    MemoryFile(const MemoryFile &) = delete;
    MemoryFile &operator=(const MemoryFile &) = delete;

    // Can be opened as any other's, in this process.
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

} // namespace sparselens
