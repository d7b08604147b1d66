#include "gpu/gpu_fixture.h"

#include "support/lens_ldi.h"

#include <dlfcn.h>

#include <cstdlib>

namespace sparselens::gpu {

namespace {

// Vulkan is opened by name, which means this library from now on.
[[maybe_unused]] const void *const faulty = dlopen(SPARSELENS_FAULTY_VULKAN, RTLD_NOW);

class Set { // a variable of the environment
public:
    Set(const char *name, std::size_t value) : name_(name) { setenv(name, std::to_string(value).c_str(), 1); }
    ~Set() { unsetenv(name_); }
    Set(const Set &) = delete;
    Set &operator=(const Set &) = delete;

private:
    const char *name_;
};

} // namespace

void GpuTest::expect_bears_failures(const Work &work) {
    const DeviceReport sound = work();
    EXPECT_EQ(sound.failure, "");
    EXPECT_GT(sound.on_device, 0u);
    std::map<std::string, std::size_t> failures;
    for (std::size_t call = 1;; ++call) {
        const Set fails("FAULTY_VULKAN_CALL", call);
        validates = call % 4 == 0; // it takes most of the time
        std::string failure;
        try {
            failure = work().failure;
            if (failure.empty()) break;
        } catch (const DeviceFailed &failed) { // when it is opened
            failure = failed.what();
        }
        ++failures[failure];
    }
    EXPECT_EQ(failures.size(), 3u);
    EXPECT_GE(failures[info->name + " was lost"], 4u);
    EXPECT_GE(failures[info->name + " has not enough memory"], 50u);
    EXPECT_EQ(failures[info->name + ": its driver found not enough memory"], 1u);
}

DeviceReport GpuTest::with_little_memory(const Work &work) {
    const Set memory("FAULTY_VULKAN_MB", 64);
    return work();
}

void GpuTest::expect_exceeds_memory(const Work &work) {
    const DeviceReport did = with_little_memory(work);
    EXPECT_EQ(did.on_device, 0u);
    EXPECT_EQ(did.failure, info->name + " has not enough memory");
}

void TileDeviceTest::expect_bears_failures(const Gather &gather, const Image &expected, double tolerance) {
    GpuTest::expect_bears_failures([&] {
        device.reset(); // only one device can be faulty at a time
        device = open_gather_device(*info, watch());
        EXPECT_LE(largest_difference(gather(device.get()), expected), tolerance);
        const TileReport did = device->take_report();
        if (did.failure.empty()) return did;
        EXPECT_EQ(did.on_device, 0u);
        const bool full = did.failure.ends_with("has not enough memory");
        EXPECT_EQ(did.on_cpu, (Tiles{{full ? "the device has not enough memory" : "the device failed", 1}}));
        EXPECT_EQ(gather(device.get()).values, expected.values);
        EXPECT_EQ(device->take_report().failure.empty(), !full); // a lost device is not used any more
        return did;
    });
}

void TileDeviceTest::expect_exceeds_buffers(const Gather &gather, const Image &expected) {
    Watch small = watch();
    small.largest_buffer = 1 << 12;
    device = open_gather_device(*info, small);
    EXPECT_EQ(gather(device.get()).values, expected.values);
    const TileReport did = device->take_report();
    EXPECT_EQ(did.on_device, 0u);
    EXPECT_GT(did.on_cpu.at("the device has not enough memory"), 0u);
}

void TileDeviceTest::expect_needs_little_memory(const Gather &gather, const Image &expected,
                                                double tolerance) {
    const TileReport did = with_little_memory([&] {
        device = open_gather_device(*info, watch());
        EXPECT_LE(largest_difference(gather(device.get()), expected), tolerance);
        return device->take_report();
    });
    EXPECT_EQ(did.on_cpu, Tiles());
    EXPECT_EQ(did.failure, "");
}

} // namespace sparselens::gpu
