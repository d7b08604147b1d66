// The memory of a device. Copies go piece by piece through a staging buffer that host and device both see. Each
// submission waits for a fence, which orders what it wrote before everything that comes later.
#include "gpu/device_vulkan.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace sparselens::gpu {

namespace {

constexpr std::size_t staging_bytes = std::size_t{16} << 20;

using Property = vk::MemoryPropertyFlagBits;
using Usage = vk::BufferUsageFlagBits;

// The staging buffer's bytes as this process sees them.
class Mapped {
public:
    explicit Mapped(const vk::raii::DeviceMemory &memory)
        : memory_(memory), at_(static_cast<std::byte *>(memory.mapMemory(0, staging_bytes))) {}
    ~Mapped() { memory_.unmapMemory(); }
    Mapped(const Mapped &) = delete;
    Mapped &operator=(const Mapped &) = delete;
    std::byte *at() const { return at_; }

private:
    const vk::raii::DeviceMemory &memory_;
    std::byte *at_;
};

// Makes the written data visible to later reads of the device and to the host.
void finish_transfer(const vk::raii::CommandBuffer &command) {
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    command.pipelineBarrier(
        Stage::eTransfer, Stage::eHost | Stage::eComputeShader | Stage::eTransfer, {},
        vk::MemoryBarrier(Access::eTransferWrite, Access::eHostRead | Access::eShaderRead |
                                                      Access::eShaderWrite | Access::eTransferRead),
        {}, {});
}

void begin_transfer(const vk::raii::CommandBuffer &command) {
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    command.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer, Stage::eTransfer, {},
                            vk::MemoryBarrier(Access::eShaderWrite | Access::eTransferWrite,
                                              Access::eTransferRead | Access::eTransferWrite),
                            {}, {});
}

} // namespace

Buffer::Buffer(std::unique_ptr<Memory> memory, std::size_t bytes)
    : memory_(std::move(memory)), bytes_(bytes) {}
Buffer::Buffer(Buffer &&) noexcept = default;
Buffer &Buffer::operator=(Buffer &&) noexcept = default;
Buffer::~Buffer() = default;

std::unique_ptr<Buffer::Memory>
Device::Vulkan::allocate(std::size_t bytes, vk::BufferUsageFlags usage,
                         std::initializer_list<vk::MemoryPropertyFlags> best_first) const {
    ask_watch();
    vk::raii::Buffer buffer(device, vk::BufferCreateInfo({}, bytes, usage));
    const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
    for (const vk::MemoryPropertyFlags wanted : best_first)
        for (std::uint32_t type = 0; type < memories.memoryTypeCount; ++type) {
            if (!(needs.memoryTypeBits >> type & 1)) continue;
            if ((memories.memoryTypes[type].propertyFlags & wanted) != wanted) continue;
            vk::raii::DeviceMemory memory(device, vk::MemoryAllocateInfo(needs.size, type));
            buffer.bindMemory(*memory, 0);
            return std::make_unique<Buffer::Memory>(Buffer::Memory{std::move(memory), std::move(buffer)});
        }
    throw vk::OutOfDeviceMemoryError("no memory of the kind that is needed");
}

const Buffer::Memory &Device::Vulkan::staged() {
    if (!staging)
        staging = allocate(staging_bytes, Usage::eTransferSrc | Usage::eTransferDst,
                           {Property::eHostVisible | Property::eHostCoherent | Property::eHostCached,
                            Property::eHostVisible | Property::eHostCoherent});
    return *staging;
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

Buffer Device::buffer(std::size_t bytes) {
    constexpr auto usage = Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst;
    const std::size_t some = std::max(bytes, std::size_t{4});
    return guarded(info_, [&] {
        return Buffer(vulkan_->allocate(some, usage, {Property::eDeviceLocal, {}}), some);
    });
}

void Device::fill(Buffer &buffer, std::uint32_t word) {
    guarded(info_, [&] {
        vulkan_->submit([&](const vk::raii::CommandBuffer &command) {
            begin_transfer(command);
            command.fillBuffer(*buffer.memory_->buffer, 0, VK_WHOLE_SIZE, word);
            finish_transfer(command);
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
    guarded(info_, [&] {
        const Mapped staging(vulkan_->staged().memory);
        std::vector<vk::BufferCopy> copies;
        std::size_t filled = 0;
        const auto submit = [&] {
            if (copies.empty()) return;
            vulkan_->submit([&](const vk::raii::CommandBuffer &command) {
                command.copyBuffer(*vulkan_->staged().buffer, *to.memory_->buffer, copies);
                finish_transfer(command);
            });
            copies.clear();
            filled = 0;
        };
        for (auto [begin, end] : ranges)
            while (begin < end) {
                const std::size_t piece = std::min(staging_bytes - filled, end - begin);
                std::memcpy(staging.at() + filled, from.data() + begin, piece);
                copies.emplace_back(filled, at + begin, piece);
                begin += piece;
                filled += piece;
                if (filled == staging_bytes) submit();
            }
        submit();
    });
}

void Device::download(std::span<std::byte> to, const Buffer &from, std::size_t at) {
    guarded(info_, [&] {
        const Buffer::Memory &staged = vulkan_->staged();
        for (std::size_t done = 0; done < to.size(); done += staging_bytes) {
            const std::size_t piece = std::min(staging_bytes, to.size() - done);
            vulkan_->submit([&](const vk::raii::CommandBuffer &command) {
                begin_transfer(command);
                command.copyBuffer(*from.memory_->buffer, *staged.buffer,
                                   vk::BufferCopy(at + done, 0, piece));
                finish_transfer(command);
            });
            std::memcpy(to.data() + done, Mapped(staged.memory).at(), piece);
        }
    });
}

} // namespace sparselens::gpu
