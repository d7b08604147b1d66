// The memory of a device. Copies go piece by piece through a staging buffer that host and device both see. Uploads wait
// there for the next submission. Each submission waits for a fence.

#include "gpu/device.h"

#include "base/progress.h"
#include "gpu/vulkan_instance.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace sparselens::gpu {

using Copies = std::map<VkBuffer, std::vector<vk::BufferCopy>>;

// The Vulkan parts of a Device, its buffers and its programs.
struct Buffer::Memory {
    vk::raii::DeviceMemory memory;
    vk::raii::Buffer buffer;
    Copies &waiting; // of all buffers

    ~Memory() { waiting.erase(*buffer); }
};

struct Program::Pipeline {
    const char *name;
    std::uint32_t buffers;
    vk::raii::DescriptorSetLayout set_layout;
    vk::raii::PipelineLayout layout;
    vk::raii::Pipeline pipeline;
};

struct Device::Vulkan {
    VulkanInstance instance;
    vk::raii::PhysicalDevice physical;
    std::uint32_t family; // of queues that compute
    vk::raii::Device device;
    vk::raii::Queue queue;
    vk::raii::CommandPool commands;
    vk::PhysicalDeviceMemoryProperties memories;
    double tick_ms = 0;                               // of the device's clock; 0: it has none
    std::optional<vk::raii::QueryPool> begin_and_end; // of a program, in ticks
    Copies waiting;                                   // from the staging buffer
    std::size_t filled = 0;                           // bytes of it
    std::shared_ptr<Buffer::Memory> staging;          // seen by host and device; made when it is first needed
    std::byte *staged = nullptr;                      // its bytes as this process sees them
    Progress times;

    Vulkan(const DeviceInfo &info, const Watch &watch);

    // Allocates in the first kind of memory that has the best of these sets of properties.
    std::shared_ptr<Buffer::Memory> allocate(std::size_t bytes, vk::BufferUsageFlags usage,
                                             std::initializer_list<vk::MemoryPropertyFlags> best_first);
    const vk::raii::Buffer &staging_buffer();
    double ticked_ms() const; // of the last program

    // Submits the copies that wait, then the commands that record(command buffer) records, and waits until they are
    // done.
    template <typename Record>
    void submit(const Record &record) {
        const vk::raii::CommandBuffers buffers(
            device, vk::CommandBufferAllocateInfo(*commands, vk::CommandBufferLevel::ePrimary, 1));
        const vk::raii::CommandBuffer &command = buffers.front();
        command.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
        for (const auto &[to, copies] : waiting) command.copyBuffer(*staging->buffer, vk::Buffer(to), copies);
        order(command);
        record(command);
        order(command);
        command.end();
        const vk::raii::Fence done(device, vk::FenceCreateInfo());
        queue.submit(vk::SubmitInfo({}, {}, *command), *done);
        while (device.waitForFences(*done, true, ~std::uint64_t{0}) == vk::Result::eTimeout) {
        }
        waiting.clear();
        filled = 0;
    }

private:
    // Makes the commands after it see what the commands before it wrote.
    static void order(const vk::raii::CommandBuffer &command) {
        using Stage = vk::PipelineStageFlagBits;
        using Access = vk::AccessFlagBits;
        constexpr auto device_works = Stage::eComputeShader | Stage::eTransfer;
        command.pipelineBarrier(device_works, device_works | Stage::eHost, {},
                                vk::MemoryBarrier(Access::eShaderWrite | Access::eTransferWrite,
                                                  Access::eShaderRead | Access::eShaderWrite |
                                                      Access::eTransferRead | Access::eTransferWrite |
                                                      Access::eHostRead),
                                {}, {});
    }
};

// Runs `work`. Turns what Vulkan throws into DeviceFailed.
template <typename Work>
auto guarded(const DeviceInfo &info, const Work &work) {
    try {
        return work();
    } catch (const vk::DeviceLostError &) {
        throw DeviceFailed(info.name + " was lost");
    } catch (const vk::OutOfDeviceMemoryError &) {
        throw DeviceFull(info.name + " has not enough memory");
    } catch (const vk::OutOfHostMemoryError &) {
        throw DeviceFailed(info.name + ": its driver found not enough memory");
    } catch (const std::exception &error) { // Vulkan's other errors, and a missing loader
        throw DeviceFailed(info.name + " failed (" + error.what() + ")");
    }
}

namespace {

std::uint32_t compute_family(const vk::raii::PhysicalDevice &physical) {
    const auto families = physical.getQueueFamilyProperties();
    const auto found = std::ranges::find_if(families, [](const vk::QueueFamilyProperties &family) {
        return bool(family.queueFlags & vk::QueueFlagBits::eCompute);
    });
    return std::uint32_t(found - families.begin());
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice &physical, std::uint32_t family) {
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
    vk::PhysicalDeviceShaderAtomicInt64Features atomics;
    atomics.shaderSharedInt64Atomics = true;
    vk::PhysicalDeviceFeatures2 features;
    features.features.shaderInt64 = true;
    features.features.shaderFloat64 = physical.getFeatures().shaderFloat64;
    features.pNext = &atomics;
    vk::DeviceCreateInfo create({}, queue);
    create.pNext = &features;
    return {physical, create};
}

vk::raii::DescriptorSetLayout make_set_layout(const vk::raii::Device &device, std::uint32_t buffers) {
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (std::uint32_t i = 0; i < buffers; ++i)
        bindings.emplace_back(i, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute);
    return {device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

} // namespace

Device::Vulkan::Vulkan(const DeviceInfo &info, const Watch &watch)
    : instance(watch.validation ? &watch.validation : nullptr),
      physical(std::move(vk::raii::PhysicalDevices(instance.instance).at(info.index))),
      family(compute_family(physical)), device(make_device(physical, family)), queue(device, family, 0),
      commands(device, vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient, family)),
      memories(physical.getMemoryProperties()) {
    if (physical.getQueueFamilyProperties()[family].timestampValidBits < 64) return; // ticks may wrap round
    tick_ms = double(physical.getProperties().limits.timestampPeriod) * 1e-6;
    begin_and_end.emplace(device, vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, 2));
}

double Device::Vulkan::ticked_ms() const {
    std::array<std::uint64_t, 2> ticks{};
    const vk::Result found = (*device).getQueryPoolResults(
        **begin_and_end, 0, 2, sizeof(ticks), ticks.data(), sizeof(ticks[0]),
        vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait, *device.getDispatcher());
    return found == vk::Result::eSuccess ? double(ticks[1] - ticks[0]) * tick_ms : 0;
}

Device::Device(const DeviceInfo &info, const Watch &watch) : info_(info), watch_(watch) {
    guarded(info_, [&] { vulkan_ = std::make_unique<Vulkan>(info_, watch_); });
}

Device::~Device() = default;

double Device::most_turns() const {
    return std::min(info_.kind == Kind::software ? 6e4 : watch_.most_turns, watch_.most_turns);
}

Program Device::program(const char *name, std::span<const std::uint32_t> spirv, std::uint32_t buffers,
                        std::uint32_t push_bytes, std::span<const std::uint32_t> constants) {
    return guarded(info_, [&] {
        const vk::raii::Device &device = vulkan_->device;
        vk::raii::DescriptorSetLayout sets = make_set_layout(device, buffers);
        const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, push_bytes);
        vk::PipelineLayoutCreateInfo create({}, *sets);
        if (push_bytes > 0) create.setPushConstantRanges(push);
        vk::raii::PipelineLayout layout(device, create);
        const vk::raii::ShaderModule shader(device,
                                            vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data()));
        std::vector<vk::SpecializationMapEntry> entries;
        for (std::uint32_t n = 0; n < constants.size(); ++n) entries.emplace_back(n, 4 * n, 4);
        const vk::SpecializationInfo special(std::uint32_t(entries.size()), entries.data(),
                                             constants.size_bytes(), constants.data());
        const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *shader, "main",
                                                      &special);
        vk::raii::Pipeline pipeline(device, nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout));
        return Program{std::make_shared<Program::Pipeline>(
            Program::Pipeline{name, buffers, std::move(sets), std::move(layout), std::move(pipeline)})};
    });
}

void Device::run(const Program &program, std::span<const Buffer> buffers, std::span<const std::byte> push,
                 const std::array<std::uint32_t, 3> &groups) {
    guarded(info_, [&] {
        const vk::raii::Device &device = vulkan_->device;
        const Program::Pipeline &what = *program.pipeline;
        const vk::DescriptorPoolSize size(vk::DescriptorType::eStorageBuffer, what.buffers);
        using Flags = vk::DescriptorPoolCreateFlagBits;
        const vk::raii::DescriptorPool pool(device,
                                            vk::DescriptorPoolCreateInfo(Flags::eFreeDescriptorSet, 1, size));
        const vk::raii::DescriptorSets sets(device, vk::DescriptorSetAllocateInfo(*pool, *what.set_layout));
        std::vector<vk::DescriptorBufferInfo> whole;
        for (const Buffer &buffer : buffers) whole.emplace_back(*buffer.memory->buffer, 0, VK_WHOLE_SIZE);
        device.updateDescriptorSets(
            vk::WriteDescriptorSet(*sets.front(), 0, 0, vk::DescriptorType::eStorageBuffer, {}, whole), {});
        const auto &clock = vulkan_->begin_and_end;
        const auto record = [&](const vk::raii::CommandBuffer &command) {
            constexpr auto compute = vk::PipelineBindPoint::eCompute;
            if (clock) command.resetQueryPool(**clock, 0, 2);
            if (clock) command.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, **clock, 0);
            command.bindPipeline(compute, *what.pipeline);
            command.bindDescriptorSets(compute, *what.layout, 0, *sets.front(), {});
            if (!push.empty())
                command.pushConstants<std::byte>(
                    *what.layout, vk::ShaderStageFlagBits::eCompute, 0,
                    vk::ArrayProxy<const std::byte>(std::uint32_t(push.size()), push.data()));
            command.dispatch(groups[0], groups[1], groups[2]);
            if (clock) command.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, **clock, 1);
        };
        std::optional<Timed> waited;
        if (!clock) waited.emplace(vulkan_->times, what.name);
        vulkan_->submit(record);
        if (clock) vulkan_->times.spent(what.name, vulkan_->ticked_ms());
    });
}

std::map<std::string, double> Device::take_times() { return vulkan_->times.take_times(); }

namespace {

constexpr std::size_t staging_bytes = std::size_t{16} << 20;

using Property = vk::MemoryPropertyFlagBits;
using Usage = vk::BufferUsageFlagBits;

} // namespace

std::shared_ptr<Buffer::Memory>
Device::Vulkan::allocate(std::size_t bytes, vk::BufferUsageFlags usage,
                         std::initializer_list<vk::MemoryPropertyFlags> best_first) {
    vk::raii::Buffer buffer(device, vk::BufferCreateInfo({}, bytes, usage));
    const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
    for (const vk::MemoryPropertyFlags wanted : best_first)
        for (std::uint32_t type = 0; type < memories.memoryTypeCount; ++type) {
            if (!(needs.memoryTypeBits >> type & 1)) continue;
            if ((memories.memoryTypes[type].propertyFlags & wanted) != wanted) continue;
            vk::raii::DeviceMemory memory(device, vk::MemoryAllocateInfo(needs.size, type));
            buffer.bindMemory(*memory, 0);
            return std::shared_ptr<Buffer::Memory>(
                new Buffer::Memory{std::move(memory), std::move(buffer), waiting});
        }
    throw vk::OutOfDeviceMemoryError("no memory of the kind that is needed");
}

const vk::raii::Buffer &Device::Vulkan::staging_buffer() {
    if (!staging)
        staging = allocate(staging_bytes, Usage::eTransferSrc | Usage::eTransferDst,
                           {Property::eHostVisible | Property::eHostCoherent | Property::eHostCached,
                            Property::eHostVisible | Property::eHostCoherent});
    if (!staged) staged = static_cast<std::byte *>(staging->memory.mapMemory(0, staging_bytes));
    return staging->buffer;
}

std::size_t Device::largest_buffer() const {
    const auto properties =
        vulkan_->physical
            .getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceMaintenance3Properties>();
    return std::size_t(std::min<vk::DeviceSize>(
        {properties.get<vk::PhysicalDeviceProperties2>().properties.limits.maxStorageBufferRange,
         properties.get<vk::PhysicalDeviceMaintenance3Properties>().maxMemoryAllocationSize,
         watch_.largest_buffer}));
}

std::size_t Device::shared_bytes() const {
    return vulkan_->physical.getProperties().limits.maxComputeSharedMemorySize;
}

Buffer Device::buffer(std::size_t bytes) {
    constexpr auto usage = Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst;
    const std::size_t some = std::max(bytes, std::size_t{4});
    return guarded(info_, [&] {
        return Buffer{vulkan_->allocate(some, usage, {Property::eDeviceLocal, {}}), some};
    });
}

void Device::fill(Buffer &buffer, std::uint32_t word) {
    guarded(info_, [&] {
        vulkan_->submit([&](const vk::raii::CommandBuffer &command) {
            command.fillBuffer(*buffer.memory->buffer, 0, VK_WHOLE_SIZE, word);
        });
    });
}

void Device::upload(Buffer &to, std::span<const std::byte> from, std::size_t at) {
    const ByteRange all{0, from.size()};
    upload(to, from, {&all, 1}, at);
}

void Device::upload(Buffer &to, std::span<const std::byte> from, std::span<const ByteRange> ranges,
                    std::size_t at) {
    if (ranges.empty()) return;
    const Timed uploading(vulkan_->times, "upload");
    guarded(info_, [&] {
        vulkan_->staging_buffer();
        for (auto [begin, end] : ranges)
            while (begin < end) {
                if (vulkan_->filled == staging_bytes) vulkan_->submit([](const auto &) {});
                const std::size_t piece = std::min(staging_bytes - vulkan_->filled, end - begin);
                std::memcpy(vulkan_->staged + vulkan_->filled, from.data() + begin, piece);
                vulkan_->waiting[*to.memory->buffer].emplace_back(vulkan_->filled, at + begin, piece);
                begin += piece;
                vulkan_->filled += piece;
            }
    });
}

void Device::download(std::span<std::byte> to, const Buffer &from, std::size_t at) {
    const Timed downloading(vulkan_->times, "download");
    guarded(info_, [&] {
        const vk::raii::Buffer &staging = vulkan_->staging_buffer();
        for (std::size_t done = 0; done < to.size(); done += staging_bytes) {
            const std::size_t piece = std::min(staging_bytes, to.size() - done);
            vulkan_->submit([&](const vk::raii::CommandBuffer &command) {
                command.copyBuffer(*from.memory->buffer, *staging, vk::BufferCopy(at + done, 0, piece));
            });
            std::memcpy(to.data() + done, vulkan_->staged, piece);
        }
    });
}

} // namespace sparselens::gpu
