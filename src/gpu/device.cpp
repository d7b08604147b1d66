#include "gpu/device.h"

#include "gpu/vulkan_device.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

namespace sparselens::gpu {

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
    vk::PhysicalDeviceFeatures features;
    features.shaderFloat64 = physical.getFeatures().shaderFloat64;
    vk::DeviceCreateInfo create({}, queue);
    create.pEnabledFeatures = &features;
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
    clock.emplace(device, vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, 2 * most_timed));
}

void Device::Vulkan::begin() {
    if (recorded) return;
    vk::raii::CommandBuffers one(
        device, vk::CommandBufferAllocateInfo(*commands, vk::CommandBufferLevel::ePrimary, 1));
    one.front().begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    if (clock) one.front().resetQueryPool(**clock, 0, 2 * most_timed);
    recorded.emplace(Recorded{std::move(one)});
}

void Device::Vulkan::order(const vk::raii::CommandBuffer &command) {
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

void Device::Vulkan::submit() try {
    if (!recorded) return;
    const Recorded work = std::move(*recorded);
    recorded.reset();
    filled = 0;
    const vk::raii::CommandBuffer &command = work.commands.front();
    command.end();
    const vk::raii::Fence done(device, vk::FenceCreateInfo());
    std::optional<Timed> waiting;
    if (!clock) waiting.emplace(times, "device");
    queue.submit(vk::SubmitInfo({}, {}, *command), *done);
    while (device.waitForFences(*done, true, ~std::uint64_t{0}) == vk::Result::eTimeout) {
    }
    if (!work.timed.empty()) take_times(work.timed);
} catch (const vk::OutOfDeviceMemoryError &) {
    throw vk::DeviceLostError("no memory to submit to it"); // less work at once would lack what was recorded
}

void Device::Vulkan::take_times(std::span<const char *const> timed) {
    std::vector<std::uint64_t> ticks(2 * timed.size());
    const vk::Result found = (*device).getQueryPoolResults(
        **clock, 0, std::uint32_t(ticks.size()), ticks.size() * sizeof(std::uint64_t), ticks.data(),
        sizeof(std::uint64_t), vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait,
        *device.getDispatcher());
    if (found != vk::Result::eSuccess) return;
    for (std::size_t n = 0; n < timed.size(); ++n)
        times.spent(timed[n], double(ticks[2 * n + 1] - ticks[2 * n]) * tick_ms);
}

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
            return std::shared_ptr<Buffer::Memory>(new Buffer::Memory{std::move(memory), std::move(buffer)});
        }
    throw vk::OutOfDeviceMemoryError("no memory of the kind that is needed");
}

const vk::raii::Buffer &Device::Vulkan::staging_buffer() {
    using Property = vk::MemoryPropertyFlagBits;
    if (!staging)
        staging = allocate(staging_bytes,
                           vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst,
                           {Property::eHostVisible | Property::eHostCoherent | Property::eHostCached,
                            Property::eHostVisible | Property::eHostCoherent});
    if (!staged) staged = static_cast<std::byte *>(staging->memory.mapMemory(0, staging_bytes));
    return staging->buffer;
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
        vk::raii::DescriptorPool pool(device,
                                      vk::DescriptorPoolCreateInfo(Flags::eFreeDescriptorSet, 1, size));
        vk::raii::DescriptorSets sets(device, vk::DescriptorSetAllocateInfo(*pool, *what.set_layout));
        const std::shared_ptr<const Vulkan::Bound> bound(new Vulkan::Bound{std::move(pool), std::move(sets)});
        std::vector<vk::DescriptorBufferInfo> whole;
        for (const Buffer &buffer : buffers) whole.emplace_back(*buffer.memory->buffer, 0, VK_WHOLE_SIZE);
        const vk::DescriptorSet &set = *bound->sets.front();
        device.updateDescriptorSets(
            vk::WriteDescriptorSet(set, 0, 0, vk::DescriptorType::eStorageBuffer, {}, whole), {});
        vulkan_->record(what.name, [&](const vk::raii::CommandBuffer &command) {
            constexpr auto compute = vk::PipelineBindPoint::eCompute;
            command.bindPipeline(compute, *what.pipeline);
            command.bindDescriptorSets(compute, *what.layout, 0, set, {});
            if (!push.empty())
                command.pushConstants<std::byte>(
                    *what.layout, vk::ShaderStageFlagBits::eCompute, 0,
                    vk::ArrayProxy<const std::byte>(std::uint32_t(push.size()), push.data()));
            command.dispatch(groups[0], groups[1], groups[2]);
        });
        auto &in_use = vulkan_->recorded->in_use;
        in_use.insert(in_use.end(), {bound, program.pipeline});
        for (const Buffer &buffer : buffers) in_use.push_back(buffer.memory);
    });
}

std::map<std::string, double> Device::take_times() { return vulkan_->times.take_times(); }

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
    using Usage = vk::BufferUsageFlagBits;
    constexpr auto usage = Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst;
    const std::size_t some = std::max(bytes, std::size_t{4});
    return guarded(info_, [&] {
        if (some > largest_buffer()) throw vk::OutOfDeviceMemoryError("more than a buffer holds");
        return Buffer{vulkan_->allocate(some, usage, {vk::MemoryPropertyFlagBits::eDeviceLocal, {}}), some};
    });
}

void Device::make_room(std::vector<Buffer> &buffers, std::span<const std::size_t> bytes) {
    std::vector<Buffer> made = std::exchange(buffers, {});
    made.resize(bytes.size());
    for (std::size_t n = 0; n < made.size(); ++n) {
        if (made[n].memory && made[n].bytes >= bytes[n]) continue;
        made[n] = {};
        made[n] = buffer(std::max(bytes[n], std::min(bytes[n] + bytes[n] / 8, largest_buffer())));
    }
    buffers = std::move(made);
}

void Device::fill(Buffer &buffer, std::uint32_t word) {
    guarded(info_, [&] {
        vulkan_->record("fill", [&](const vk::raii::CommandBuffer &command) {
            command.fillBuffer(*buffer.memory->buffer, 0, VK_WHOLE_SIZE, word);
        });
        vulkan_->recorded->in_use.push_back(buffer.memory);
    });
}

void Device::upload(Buffer &to, std::span<const std::byte> from, std::size_t at) {
    const ByteRange all{0, from.size()};
    upload(to, from, {&all, 1}, at);
}

void Device::upload(Buffer &to, std::span<const std::byte> from, std::span<const ByteRange> ranges,
                    std::size_t at) {
    guarded(info_, [&] {
        const vk::raii::Buffer &staging = vulkan_->staging_buffer();
        std::size_t &filled = vulkan_->filled, done = 0; // of the first range
        while (!ranges.empty()) {
            if (filled == Vulkan::staging_bytes) vulkan_->submit();
            std::vector<vk::BufferCopy> copies;
            {
                const Timed copying(vulkan_->times, "upload");
                while (!ranges.empty() && filled < Vulkan::staging_bytes) {
                    const std::size_t begin = ranges.front().begin + done,
                                      piece = std::min(Vulkan::staging_bytes - filled,
                                                       ranges.front().end - begin);
                    if (piece > 0) copies.emplace_back(filled, at + begin, piece);
                    if (piece > 0) std::memcpy(vulkan_->staged + filled, from.data() + begin, piece);
                    filled += piece;
                    done += piece;
                    if (begin + piece < ranges.front().end) continue;
                    ranges = ranges.subspan(1);
                    done = 0;
                }
            }
            if (copies.empty()) continue;
            vulkan_->record("upload", [&](const vk::raii::CommandBuffer &command) {
                command.copyBuffer(*staging, *to.memory->buffer, copies);
            });
            vulkan_->recorded->in_use.push_back(to.memory);
        }
    });
}

void Device::finish(std::span<const Download> results) {
    struct Copy {
        std::byte *to, *from;
        std::size_t bytes;
    };
    guarded(info_, [&] {
        const vk::raii::Buffer &staging = vulkan_->staging_buffer();
        std::vector<Copy> copies;
        const auto take = [&] {
            vulkan_->submit();
            const Timed copying(vulkan_->times, "download");
            for (const Copy &copy : copies) std::memcpy(copy.to, copy.from, copy.bytes);
            copies.clear();
        };
        for (const Download &result : results)
            for (std::size_t done = 0; done < result.to.size(); done += copies.back().bytes) {
                std::size_t &filled = vulkan_->filled;
                if (filled == Vulkan::staging_bytes) take();
                const vk::BufferCopy copy(result.at + done, filled,
                                          std::min(Vulkan::staging_bytes - filled, result.to.size() - done));
                vulkan_->record("download", [&](const vk::raii::CommandBuffer &command) {
                    command.copyBuffer(*result.from.memory->buffer, *staging, copy);
                });
                copies.push_back({result.to.data() + done, vulkan_->staged + filled, copy.size});
                filled += copy.size;
            }
        take();
    });
}

} // namespace sparselens::gpu
