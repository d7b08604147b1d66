// The Vulkan objects of a Device (gpu/device.h), and the work that is recorded for it. Uploads and downloads pass
// through a staging buffer that both the host and the device can access. Each submission waits for a fence.
#pragma once

#include "base/progress.h"
#include "gpu/device.h"
#include "gpu/vulkan_instance.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sparselens::gpu {

struct Buffer::Memory {
    vk::raii::DeviceMemory memory;
    vk::raii::Buffer buffer;
};

struct Program::Pipeline {
    const char *name;
    std::uint32_t buffers;
    vk::raii::DescriptorSetLayout set_layout;
    vk::raii::PipelineLayout layout;
    vk::raii::Pipeline pipeline;
};

struct Device::Vulkan {
    // The buffers of one run.
    struct Bound {
        vk::raii::DescriptorPool pool;
        vk::raii::DescriptorSets sets;
    };
    // The work of the next submission.
    struct Recorded {
        vk::raii::CommandBuffers commands;                    // one
        std::vector<std::shared_ptr<const void>> in_use = {}; // until it is done
        std::vector<const char *> timed = {};                 // two ticks of each are queried
    };
    static constexpr std::uint32_t most_timed = 256;
    static constexpr std::size_t staging_bytes = std::size_t{16} << 20;

    VulkanInstance instance;
    vk::raii::PhysicalDevice physical;
    std::uint32_t family; // of queues that compute
    vk::raii::Device device;
    vk::raii::Queue queue;
    vk::raii::CommandPool commands;
    vk::PhysicalDeviceMemoryProperties memories;
    double tick_ms = 0; // of the device's clock
    std::optional<vk::raii::QueryPool> clock;
    std::shared_ptr<Buffer::Memory> staging; // made when it is first needed
    std::byte *staged = nullptr;             // its bytes as this process sees them
    std::size_t filled = 0;                  // of them, by what is recorded
    std::optional<Recorded> recorded;
    Progress times;

    Vulkan(const DeviceInfo &info, const Watch &watch);

    // Allocates in the first kind of memory that has the best of these sets of properties.
    std::shared_ptr<Buffer::Memory> allocate(std::size_t bytes, vk::BufferUsageFlags usage,
                                             std::initializer_list<vk::MemoryPropertyFlags> best_first);
    const vk::raii::Buffer &staging_buffer();

    // Records the commands that work(command buffer) records, and takes their time under this name. Commands after them
    // see what they wrote.
    template <typename Work>
    void record(const char *name, const Work &work) {
        begin();
        const vk::raii::CommandBuffer &command = recorded->commands.front();
        const auto number = std::uint32_t(recorded->timed.size());
        const auto stamp = [&](std::uint32_t tick) {
            if (clock && number < most_timed)
                command.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, **clock, 2 * number + tick);
        };
        stamp(0);
        work(command);
        order(command);
        stamp(1);
        if (clock && number < most_timed) recorded->timed.push_back(name);
    }
    // Submits what was recorded, and waits until it is done. If this fails, what was recorded is gone.
    void submit();

private:
    void begin();
    void take_times(std::span<const char *const> timed);
    static void order(const vk::raii::CommandBuffer &command);
};

} // namespace sparselens::gpu
