#include "io/files/unfinished.h"

#include <unistd.h>

#include <array>
#include <atomic>

namespace sparselens {

namespace {

std::array<std::atomic<const char *>, 64> paths{};
static_assert(std::atomic<const char *>::is_always_lock_free, "a signal handler cannot wait for locks");

} // namespace

Unfinished::Unfinished(std::string path) : path_(std::move(path)), slot_(0) {
    for (; slot_ < paths.size(); ++slot_) {
        const char *none = nullptr;
        if (paths[slot_].compare_exchange_strong(none, path_.c_str())) return;
    }
}

Unfinished::~Unfinished() {
    if (slot_ < paths.size()) paths[slot_] = nullptr;
}

void remove_unfinished() noexcept {
    for (const auto &path : paths)
        if (const char *name = path) ::unlink(name);
}

} // namespace sparselens
