// Stands in for Vulkan's loader (libvulkan.so), and makes a device's calls fail. It passes all other calls on.
// - $FAULTY_VULKAN_CALL: all calls fail from this number on, counted since the instance was made. Calls that submit
//   work or wait for it fail as if the device were lost, the others as if the device or the host had no memory.
// - $FAULTY_VULKAN_MB: the device has so much memory.
#define VK_NO_PROTOTYPES
#include <dlfcn.h>
#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstdlib>
#include <map>
#include <string_view>
#include <type_traits>

namespace {

std::uint64_t number_in(const char *variable) {
    const char *const text = std::getenv(variable);
    return text ? std::strtoull(text, nullptr, 10) : ~std::uint64_t{0};
}

std::uint64_t calls, fails_from, most_bytes;

template <typename Function>
Function *as(PFN_vkVoidFunction function) {
    return reinterpret_cast<Function *>(function);
}
template <typename Function>
PFN_vkVoidFunction as_any(Function *function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

template <typename Function>
struct Faulty;
template <typename... Of>
struct Faulty<VkResult(Of...)> {
    using Function = VkResult(Of...);
    static inline Function *real;

    static VkResult call(Of... of) {
        constexpr auto is = []<typename Call>(Call) { return std::is_same_v<Function *, Call>; };
        if (++calls < fails_from) return real(of...);
        if constexpr (is(PFN_vkWaitForFences())) real(of...); // what was submitted may be taken apart then
        return is(PFN_vkWaitForFences()) || is(PFN_vkQueueSubmit()) ? VK_ERROR_DEVICE_LOST
               : is(PFN_vkMapMemory())                              ? VK_ERROR_OUT_OF_HOST_MEMORY
                                                                    : VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
};

// Memory of the device.

std::map<VkDeviceMemory, std::uint64_t> allocated;
std::uint64_t bytes_in_use;
PFN_vkFreeMemory real_free;

using Allocating = Faulty<std::remove_pointer_t<PFN_vkAllocateMemory>>;

VkResult allocate(VkDevice device, const VkMemoryAllocateInfo *what, const VkAllocationCallbacks *by,
                  VkDeviceMemory *made) {
    if (bytes_in_use + what->allocationSize > most_bytes) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const VkResult result = Allocating::call(device, what, by, made);
    if (result == VK_SUCCESS) bytes_in_use += allocated[*made] = what->allocationSize;
    return result;
}

void free_memory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks *by) {
    bytes_in_use -= allocated[memory];
    real_free(device, memory, by);
}

// Puts `call` in place of a function.
template <typename Function>
PFN_vkVoidFunction in_place_of(PFN_vkVoidFunction found, Function *&real, Function *call) {
    real = as<Function>(found);
    return as_any(call);
}

PFN_vkGetInstanceProcAddr real_of_instance;
PFN_vkGetDeviceProcAddr real_of_device;
PFN_vkCreateInstance real_create;

VkResult create(const VkInstanceCreateInfo *what, const VkAllocationCallbacks *by, VkInstance *made) {
    calls = 0;
    fails_from = number_in("FAULTY_VULKAN_CALL");
    const std::uint64_t mb = number_in("FAULTY_VULKAN_MB");
    most_bytes = mb < 1 << 20 ? mb << 20 : mb;
    return real_create(what, by, made);
}

PFN_vkVoidFunction faulty(std::string_view name, PFN_vkVoidFunction found);

PFN_vkVoidFunction of_device(VkDevice device, const char *name) {
    return faulty(name, real_of_device(device, name));
}

PFN_vkVoidFunction faulty(std::string_view name, PFN_vkVoidFunction found) {
    if (!found) return found;
    if (name == "vkCreateInstance") return in_place_of(found, real_create, create);
    if (name == "vkGetDeviceProcAddr") return in_place_of(found, real_of_device, of_device);
    if (name == "vkFreeMemory") return in_place_of(found, real_free, free_memory);
    if (name == "vkAllocateMemory") return in_place_of(found, Allocating::real, allocate);
#define FAULTY(function)                                                                                     \
    if (name == #function) {                                                                                 \
        using Instead = Faulty<std::remove_pointer_t<PFN_##function>>;                                       \
        return in_place_of(found, Instead::real, Instead::call);                                             \
    }
    FAULTY(vkEnumeratePhysicalDevices)
    FAULTY(vkCreateDevice)
    FAULTY(vkCreateCommandPool)
    FAULTY(vkAllocateCommandBuffers)
    FAULTY(vkBeginCommandBuffer)
    FAULTY(vkEndCommandBuffer)
    FAULTY(vkCreateFence)
    FAULTY(vkQueueSubmit)
    FAULTY(vkWaitForFences)
    FAULTY(vkCreateQueryPool)
    FAULTY(vkCreateBuffer)
    FAULTY(vkBindBufferMemory)
    FAULTY(vkMapMemory)
    FAULTY(vkCreateDescriptorSetLayout)
    FAULTY(vkCreateDescriptorPool)
    FAULTY(vkAllocateDescriptorSets)
    FAULTY(vkCreatePipelineLayout)
    FAULTY(vkCreateShaderModule)
    FAULTY(vkCreateComputePipelines)
#undef FAULTY
    return found;
}

} // namespace

extern "C" __attribute__((visibility("default"))) PFN_vkVoidFunction
vkGetInstanceProcAddr(VkInstance instance, const char *name) {
    if (!real_of_instance)
        if (void *const loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL))
            real_of_instance =
                reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
    return real_of_instance ? faulty(name, real_of_instance(instance, name)) : nullptr;
}
