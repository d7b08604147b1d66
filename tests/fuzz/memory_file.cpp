#include "fuzz/fuzz.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

namespace sparselens::fuzz {

MemoryFile::MemoryFile(const std::uint8_t *data, std::size_t size)
    : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    if (descriptor_ < 0 || ::write(descriptor_, data, size) != ssize_t(size)) std::abort();
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

} // namespace sparselens::fuzz
