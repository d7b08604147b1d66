#include "gpu/device_vulkan.h"

#include <algorithm>
#include <vector>

namespace sparselens::gpu {

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

// Throws Vulkan-Hpp's exception for a result. Vulkan-Hpp's own function for this has moved between namespaces.
[[noreturn]] void throw_as_asked(vk::Result result) {
    constexpr const char *why = "as the test asked";
    switch (result) {
    case vk::Result::eErrorDeviceLost: throw vk::DeviceLostError(why);
    case vk::Result::eErrorOutOfDeviceMemory: throw vk::OutOfDeviceMemoryError(why);
    case vk::Result::eErrorOutOfHostMemory: throw vk::OutOfHostMemoryError(why);
    default: throw vk::SystemError(vk::make_error_code(result), why);
    }
}

} // namespace

Program::Program(std::unique_ptr<Pipeline> pipeline) : pipeline_(std::move(pipeline)) {}
Program::Program(Program &&) noexcept = default;
Program::~Program() = default;

Device::Vulkan::Vulkan(const DeviceInfo &info, const Watch &watch_)
    : instance(watch_.validation ? &watch_.validation : nullptr),
      physical(std::move(vk::raii::PhysicalDevices(instance.instance).at(info.index))),
      family(compute_family(physical)), device(make_device(physical, family)), queue(device, family, 0),
      commands(device, vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient, family)),
      memories(physical.getMemoryProperties()), watch(watch_) {}

void Device::Vulkan::ask_watch() const {
    if (const int result = watch.fails ? watch.fails() : 0) throw_as_asked(vk::Result(result));
}

Device::Device(const DeviceInfo &info, const Watch &watch) : info_(info), watch_(watch) {
    guarded(info_, [&] { vulkan_ = std::make_unique<Vulkan>(info_, watch_); });
}

Device::~Device() = default;

double Device::most_turns() const {
    return std::min(info_.kind == Kind::software ? 6e4 : watch_.most_turns, watch_.most_turns);
}

Program Device::program(std::span<const std::uint32_t> spirv, std::uint32_t buffers,
                        std::uint32_t push_bytes) {
    return guarded(info_, [&] {
        const vk::raii::Device &device = vulkan_->device;
        vk::raii::DescriptorSetLayout sets = make_set_layout(device, buffers);
        const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, push_bytes);
        vk::PipelineLayoutCreateInfo create({}, *sets);
        if (push_bytes > 0) create.setPushConstantRanges(push);
        vk::raii::PipelineLayout layout(device, create);
        const vk::raii::ShaderModule shader(device,
                                            vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data()));
        const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *shader, "main");
        vk::raii::Pipeline pipeline(device, nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout));
        return Program(std::make_unique<Program::Pipeline>(
            Program::Pipeline{buffers, push_bytes, std::move(sets), std::move(layout), std::move(pipeline)}));
    });
}

void Device::run(const Program &program, std::span<const Buffer *const> buffers,
                 std::span<const std::byte> push, const std::array<std::uint32_t, 3> &groups) {
    guarded(info_, [&] {
        const vk::raii::Device &device = vulkan_->device;
        const Program::Pipeline &what = *program.pipeline_;
        const vk::DescriptorPoolSize size(vk::DescriptorType::eStorageBuffer, what.buffers);
        using Flags = vk::DescriptorPoolCreateFlagBits;
        const vk::raii::DescriptorPool pool(device,
                                            vk::DescriptorPoolCreateInfo(Flags::eFreeDescriptorSet, 1, size));
        const vk::raii::DescriptorSets sets(device, vk::DescriptorSetAllocateInfo(*pool, *what.set_layout));
        std::vector<vk::DescriptorBufferInfo> whole;
        for (const Buffer *buffer : buffers) whole.emplace_back(*buffer->memory_->buffer, 0, VK_WHOLE_SIZE);
        device.updateDescriptorSets(
            vk::WriteDescriptorSet(*sets.front(), 0, 0, vk::DescriptorType::eStorageBuffer, {}, whole), {});
        vulkan_->submit([&](const vk::raii::CommandBuffer &command) {
            constexpr auto compute = vk::PipelineBindPoint::eCompute;
            command.bindPipeline(compute, *what.pipeline);
            command.bindDescriptorSets(compute, *what.layout, 0, *sets.front(), {});
            if (!push.empty())
                command.pushConstants<std::byte>(
                    *what.layout, vk::ShaderStageFlagBits::eCompute, 0,
                    vk::ArrayProxy<const std::byte>(std::uint32_t(push.size()), push.data()));
            command.dispatch(groups[0], groups[1], groups[2]);
            using Access = vk::AccessFlagBits;
            using Stage = vk::PipelineStageFlagBits;
            const vk::MemoryBarrier written(Access::eShaderWrite, Access::eShaderRead | Access::eShaderWrite);
            command.pipelineBarrier(Stage::eComputeShader, Stage::eComputeShader, {}, written, {}, {});
        });
    });
}

} // namespace sparselens::gpu
