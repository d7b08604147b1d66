#include "python/device.h"

#include "gpu/gather/gather_device.h"
#include "gpu/warp/warp_device.h"

#include <memory>
#include <mutex>

namespace sparselens::python {

namespace {

// What the calls of a process share.
template <typename Device>
class Kept {
public:
    using Open = std::unique_ptr<Device> (*)(const gpu::DeviceInfo &, const gpu::Watch &);
    // `verb`: in messages, "the CPU gathers".
    Kept(Open open, std::string verb) : open_(open), verb_(std::move(verb)) {}

    void with(const std::string &word, std::vector<std::string> &warnings,
              const std::function<void(Device *)> &work) {
        if (word == "cpu") return work(nullptr);
        const std::lock_guard lock(mutex_);
        if (word_ != word) look_for(word, warnings);
        work(device_.get());
        if (!device_) return;
        const DeviceReport did = device_->take_report();
        if (!did.failure.empty()) warnings.push_back(did.failure + "; the CPU did what it had not");
    }
    void release() {
        const std::lock_guard lock(mutex_);
        device_.reset();
        word_.clear();
    }

private:
    void look_for(const std::string &word, std::vector<std::string> &warnings) {
        device_.reset();
        word_.clear();
        if (word != "auto" || gpu::may_have_gpu())
            if (const auto chosen = gpu::choose_device(word, gpu::list_devices())) try {
                    device_ = open_(*chosen, {});
                } catch (const gpu::DeviceFailed &failure) {
                    warnings.push_back(std::string(failure.what()) + "; the CPU " + verb_);
                }
        word_ = word;
    }

    Open open_;
    std::string verb_;
    std::mutex mutex_;
    std::string word_;
    std::unique_ptr<Device> device_;
};

Kept<TileDevice> &gather_device() {
    static Kept<TileDevice> one(gpu::open_gather_device, "gathers");
    return one;
}

Kept<WarpDevice> &warp_device() {
    static Kept<WarpDevice> one(gpu::open_warp_device, "warps");
    return one;
}

} // namespace

void with_gather_device(const std::string &word, std::vector<std::string> &warnings,
                        const std::function<void(TileDevice *)> &work) {
    gather_device().with(word, warnings, work);
}

void with_warp_device(const std::string &word, std::vector<std::string> &warnings,
                      const std::function<void(WarpDevice *)> &work) {
    warp_device().with(word, warnings, work);
}

void release_devices() {
    gather_device().release();
    warp_device().release();
}

} // namespace sparselens::python
