#include "gpu/warp/warp_device.h"

#include "base/grid.h"
#include "base/matte.h"
#include "gpu/warp/stripe_work.h"
#include "warp/photo_consistency.h"
#include "warp/reprojected_views.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparselens::gpu {

namespace {

constexpr std::size_t stripe_bytes = std::size_t{512} << 20; // of a buffer, even if a device allows more

// One thread sorts a pixel, in time proportional to the square of its samples.
constexpr std::uint32_t most_in_pixel = 1024;

// Mesa's software device ends a program after 65535 turns of its loops, and what the program has not written is
// garbage.
std::uint32_t most_in_software(const WarpScene &scene) {
    const std::size_t turns = std::max(scene.layout.channels.size(), 4 * scene.views.size());
    return std::uint32_t(std::clamp<std::size_t>(20'000 / turns, 1, 128));
}

class WarpGpu : public WarpDevice {
public:
    WarpGpu(const DeviceInfo &info, const Watch &watch) : device_(info, watch), kernels_(device_) {}

    void warp(const WarpScene &scene, const std::function<void(WarpedBands)> &done) override {
        const int height = scene.layout.windows.height();
        const std::size_t before = report_.on_device;
        const auto leave = [&](const char *why) {
            report_.on_cpu[why] += std::size_t(height) - (report_.on_device - before);
        };
        if (lost_) return leave(failed);
        if (!find_mattes(scene.layout.channels).empty()) return leave("Cryptomattes");
        const double inverse_z = largest_inverse_z(scene.views);
        if (!std::isfinite(inverse_z)) return leave("depths that single precision hardly holds");
        try {
            warp_by_stripes(scene, inverse_z, done);
        } catch (const DeviceFailed &failure) {
            lost_ = true;
            report_.failure = failure.what();
            leave(failed);
        }
    }

    DeviceReport take_report() override { return std::exchange(report_, {}); }

private:
    static constexpr const char *failed = "the device failed";

    void warp_by_stripes(const WarpScene &scene, double inverse_z,
                         const std::function<void(WarpedBands)> &done) {
        const Imath::Box2i &data = scene.layout.windows.data;
        const std::size_t bands = pieces_of(std::size_t(Grid(data).height()), std::size_t(warp_band_rows));
        std::size_t at_once = bands;
        for (std::size_t first = 0; first < bands;) {
            const std::size_t count = std::min(at_once, bands - first);
            Imath::Box2i box = data;
            box.min.y += int(first) * warp_band_rows;
            box.max.y = std::min(box.max.y, box.min.y + int(count) * warp_band_rows - 1);
            const WarpStripe stripe = make_stripe(scene, box, inverse_z);
            if (buffer_bytes(scene, stripe) > std::min(stripe_bytes, device_.largest_buffer()) && count > 1) {
                at_once = pieces_of(count, std::size_t{2});
                continue;
            }
            warp_stripe(scene, stripe, first, count, done);
            first += count;
        }
    }

    void warp_stripe(const WarpScene &scene, const WarpStripe &stripe, std::size_t first, std::size_t count,
                     const std::function<void(WarpedBands)> &done) {
        const auto rows = std::size_t(Grid(stripe.box).height());
        if (buffer_bytes(scene, stripe) > device_.largest_buffer()) {
            report_.on_cpu["more samples than its buffers hold"] += rows;
            return;
        }
        const std::uint32_t most =
            device_.info().kind == Kind::software ? most_in_software(scene) : most_in_pixel;
        StripeWork work(device_, kernels_, scene, stripe, most);
        report_.uploaded += work.uploaded();
        if (!work.land()) {
            report_.on_cpu["more samples in a pixel than it sorts"] += rows;
            return;
        }
        done({first, count, work.merge(), work.differing_blocks()});
        report_.on_device += rows;
    }

    Device device_;
    WarpKernels kernels_;
    DeviceReport report_;
    bool lost_ = false;
};

} // namespace

std::unique_ptr<WarpDevice> open_warp_device(const DeviceInfo &info, const Watch &watch) {
    if (!info.float64) throw DeviceFailed(info.name + " lacks double precision");
    return std::make_unique<WarpGpu>(info, watch);
}

} // namespace sparselens::gpu
