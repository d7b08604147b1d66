#include "io/files/memory_file.h"

#include "io/files/file_stream.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

namespace sparselens {

MemoryFile::MemoryFile(std::string_view contents) : descriptor_(::memfd_create("sparselens", MFD_CLOEXEC)) {
    if (descriptor_ < 0) fail_of_system("a file in memory", "cannot make");
    while (!contents.empty()) {
        const ssize_t written = ::write(descriptor_, contents.data(), contents.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) {
            ::close(descriptor_);
            fail_of_system("a file in memory", "cannot write");
        }
        contents.remove_prefix(std::size_t(written));
    }
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

} // namespace sparselens
