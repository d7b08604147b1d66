// A device that computes: buffers in its memory, and programs that read and write them. Uploads and runs of programs
// are recorded. finish() submits them together, waits, and downloads results.
//
// A failure of the device throws DeviceFailed; the caller can then do the same work on the CPU.
#pragma once

#include "base/error.h"
#include "gpu/device_list.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sparselens::gpu {

// The device was lost, or has no memory left, or its driver failed. The message names the device.
struct DeviceFailed : Error {
    using Error::Error;
};

// The device has not enough memory, or no buffer of this size. Less work at once may need less.
struct DeviceFull : DeviceFailed {
    using DeviceFailed::DeviceFailed;
};

// Limits for tests, and a function that receives messages about mistakes.
struct Watch {
    // if set, receives the validation layer's messages
    std::function<void(const std::string &)> validation = {};
    std::size_t largest_buffer = ~std::size_t{0}; // bytes, if the device allows as many
    double most_turns = 1e300;                    // of loops, if the device allows as many
};

// Whether the validation layer is installed.
bool has_validation();

struct ByteRange {
    std::size_t begin, end;
};

// Storage that programs read and write. Copies of it are the same storage.
struct Buffer {
    struct Memory;
    std::shared_ptr<Memory> memory = {};
    std::size_t bytes = 0;
};

struct Download {
    std::span<std::byte> to;
    Buffer from;
    std::size_t at = 0; // position in the buffer, bytes
};

struct Program {
    struct Pipeline;
    std::shared_ptr<Pipeline> pipeline;
};

class Device {
public:
    // Throws DeviceFailed.
    explicit Device(const DeviceInfo &info, const Watch &watch = {});
    Device(const Device &) = delete;
    Device &operator=(const Device &) = delete;
    ~Device(); // after its buffers and programs

    const DeviceInfo &info() const { return info_; }
    std::size_t largest_buffer() const; // bytes that a program can reach
    std::size_t shared_bytes() const;   // that a work group can share
    // The turns of loops that a work group may take. Mesa's software device ends a program after 65535 turns, and what
    // the program has not written is garbage. Other devices have no such bound.
    double most_turns() const;

    // Bytes in the device's memory, at least one, uninitialised.
    Buffer buffer(std::size_t bytes);
    // Makes each buffer hold at least so many bytes; a new buffer has some room to grow. If one of them cannot be made,
    // frees all of them and throws.
    void make_room(std::vector<Buffer> &buffers, std::span<const std::size_t> bytes);

    // These four functions record work. Each piece of work sees what earlier work wrote.

    // `at`: position in the buffer, bytes.
    void upload(Buffer &to, std::span<const std::byte> from, std::size_t at = 0);
    // Uploads ranges of `from`, each to the same position in the buffer, from `at` on.
    void upload(Buffer &to, std::span<const std::byte> from, std::span<const ByteRange> ranges,
                std::size_t at = 0);
    void fill(Buffer &buffer, std::uint32_t word); // all of it
    void run(const Program &program, std::span<const Buffer> buffers, std::span<const std::byte> push,
             const std::array<std::uint32_t, 3> &groups);

    // Submits the recorded work, waits until it is done, and downloads these results. Operating systems end a
    // submission that takes seconds, so callers must finish long work piece by piece.
    void finish(std::span<const Download> results = {});

    // A compute shader "main" whose storage buffers are bindings 0 to buffers - 1 of set 0. `name`: for the times.
    // `constants`: its specialization constants, from 0 on.
    Program program(const char *name, std::span<const std::uint32_t> spirv, std::uint32_t buffers,
                    std::uint32_t push_bytes, std::span<const std::uint32_t> constants = {});

    // Milliseconds since this was last called: of "upload", "download", "fill" and each program, by the device's own
    // clock. The time that the host copies to and from its staging buffer is added to uploads and downloads. A device
    // without a clock has one time for all that it does: "device".
    std::map<std::string, double> take_times();

private:
    struct Vulkan;
    DeviceInfo info_;
    Watch watch_;
    std::unique_ptr<Vulkan> vulkan_;
};

} // namespace sparselens::gpu
