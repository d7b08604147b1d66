#include "python/device.h"

#include "gpu/gather/gather_device.h"

#include <memory>
#include <mutex>

namespace sparselens::python {

namespace {

// What the calls of a process share.
struct Kept {
    std::mutex mutex;
    std::string word;
    std::unique_ptr<TileDevice> device;
};

Kept &kept() {
    static Kept one;
    return one;
}

std::unique_ptr<TileDevice> opened(const std::string &word, std::vector<std::string> &warnings) {
    if (word == "auto" && !gpu::may_have_gpu()) return {};
    const auto chosen = gpu::choose_device(word, gpu::list_devices());
    if (!chosen) return {};
    try {
        return gpu::open_gather_device(*chosen);
    } catch (const gpu::DeviceFailed &failure) {
        warnings.push_back(std::string(failure.what()) + "; the CPU gathers");
        return {};
    }
}

} // namespace

void with_device(const std::string &word, std::vector<std::string> &warnings,
                 const std::function<void(TileDevice *)> &work) {
    if (word == "cpu") return work(nullptr);
    const std::lock_guard lock(kept().mutex);
    if (kept().word != word) {
        kept().device.reset();
        kept().word.clear();
        kept().device = opened(word, warnings);
        kept().word = word;
    }
    TileDevice *device = kept().device.get();
    work(device);
    if (!device) return;
    const TileReport did = device->take_report();
    if (!did.failure.empty()) warnings.push_back(did.failure + "; the CPU gathered what it had not");
}

void release_device() {
    const std::lock_guard lock(kept().mutex);
    kept().device.reset();
    kept().word.clear();
}

} // namespace sparselens::python
