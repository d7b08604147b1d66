#include "gpu/warp/warp_device.h"

#include "base/grid.h"
#include "base/matte.h"
#include "deep/build.h"
#include "gpu/device_worker.h"
#include "gpu/warp/warp_frame.h"
#include "kernels/warp_layout.h"
#include "warp/photo_consistency.h"
#include "warp/reprojected_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace sparselens::gpu {

namespace {

constexpr std::uint32_t land_code[] = {
#include <warp_land.comp.inc>
};
constexpr std::uint32_t surfaces_code[] = {
#include <warp_surfaces.comp.inc>
};
constexpr std::uint32_t differences_code[] = {
#include <warp_differences.comp.inc>
};
constexpr std::uint32_t vote_code[] = {
#include <warp_vote.comp.inc>
};
constexpr std::uint32_t emit_code[] = {
#include <warp_emit.comp.inc>
};

// The buffers, as in warp_data.glsl; then their number.
enum Binding : std::uint32_t {
    frame,
    views,
    begins,
    depths,
    weights,
    values,
    ids,
    ends,
    landed,
    marks,
    means,
    verdicts,
    emitted,
    results,
    bindings
};

struct WarpKernels {
    explicit WarpKernels(Device &device)
        : land(device.program("land", land_code, bindings, 4)),
          surfaces(device.program("surfaces", surfaces_code, bindings, 0)),
          differences(device.program("differences", differences_code, bindings, 0)),
          vote(device.program("vote", vote_code, bindings, 0)),
          emit(device.program("emit", emit_code, bindings, 0)) {}

    Program land, surfaces, differences, vote, emit;
};

// The work groups for a number of items; more than one row if they are many.
std::array<std::uint32_t, 3> groups_for(std::size_t items) {
    constexpr std::size_t most_in_row = 1 << 15; // every device takes as many groups
    const std::size_t groups = std::max(pieces_of(items, std::size_t{warp_kernel::threads}), std::size_t{1});
    return {std::uint32_t(std::min(groups, most_in_row)), std::uint32_t(pieces_of(groups, most_in_row)), 1};
}

// The work of the kernels on one stripe: views are uploaded, samples of the LDI are downloaded.
class StripeWork {
public:
    // Uploads what the stripe needs. `most`: samples in a pixel.
    StripeWork(Device &device, WarpKernels &kernels, const WarpScene &scene, const WarpStripe &stripe,
               std::uint32_t most)
        : device_(device), kernels_(kernels), scene_(scene), stripe_(stripe),
          pixels_(Grid(stripe.box).size()), blocks_(Tiles(stripe.box, kernels::photo_block).count()) {
        const warp_kernel::Frame constants = frame_of(scene, stripe, most);
        upload(frame, std::span(&constants, 1));
        upload(views, std::span(stripe.views));
        upload_views();
        std::vector<std::uint32_t> copied;
        for (const Channel &channel : scene.layout.channels) copied.push_back(holds_ids(channel) ? 1 : 0);
        upload(ids, std::span(copied));
        for (const std::size_t binding : {landed, marks, means, verdicts, emitted, results}) make(binding, 4);
        make(ends, (pixels_ + 1) * 4);
        device_.fill(buffers_[ends], 0);
    }

    std::size_t uploaded() const { return uploaded_; } // bytes

    // Puts all samples into the pixels that they fall into. Returns false if some pixel has too many samples; nothing
    // else can be done then.
    bool land() {
        std::size_t most_pixels = 1;
        for (const warp_kernel::View &view : stripe_.views)
            most_pixels =
                std::max(most_pixels, std::size_t(view.rows) * std::size_t(view.max_x - view.min_x + 1));
        std::array<std::uint32_t, 3> groups = groups_for(most_pixels);
        groups[2] = std::uint32_t(stripe_.slices.size());
        const auto pass = [&](std::uint32_t list) {
            run(kernels_.land, groups, std::as_bytes(std::span(&list, 1)));
        };
        pass(0);
        std::vector<std::uint32_t> counts = download<std::uint32_t>(ends, pixels_ + 1);
        if (counts.back() != 0) return false;
        const std::size_t count = sum_up(counts);
        upload(ends, std::span(counts));
        make(landed, count * 16);
        make(marks, count * 8);
        make(means, count * 8);
        pass(1);
        return true;
    }

    Ldi merge() { // once, after land()
        const auto groups = groups_for(pixels_);
        run(kernels_.surfaces, groups);
        make(verdicts, blocks_ * 4);
        if (scene_.tests_photo_consistency)
            run(kernels_.differences, groups_for(blocks_));
        else
            device_.fill(buffers_[verdicts], kernels::may_average);
        make(emitted, (pixels_ + 1) * 4);
        run(kernels_.vote, groups);
        std::vector<std::uint32_t> begin = download<std::uint32_t>(emitted, pixels_ + 1);
        const std::size_t samples = sum_up(begin);
        upload(emitted, std::span(begin));
        make(results, (4 + scene_.layout.channels.size()) * samples * 4);
        run(kernels_.emit, groups);
        Ldi ldi = empty_like(scene_.layout);
        ldi.begin.assign(begin.begin(), begin.end());
        std::size_t array = 0;
        const auto take = [&](std::vector<float> &to) { to = download<float>(results, samples, array++); };
        for (std::vector<float> *to : {&ldi.z, &ldi.dx, &ldi.dy, &ldi.weight}) take(*to);
        for (std::vector<float> &to : ldi.values) take(to);
        return ldi;
    }

    std::vector<Disagreement> differing_blocks() { // after merge(); see WarpedBands
        std::vector<Disagreement> differ(blocks_);
        std::ranges::transform(download<std::uint32_t>(verdicts, blocks_), differ.begin(), disagreement_of);
        return differ;
    }

private:
    // Uploads the arrays of all views, one after the other, and where in them the samples of each pixel begin; after
    // the pixels of a view, where its last sample ends.
    void upload_views() {
        const std::size_t channels = scene_.layout.channels.size();
        make(depths, stripe_.samples * sizeof(float));
        make(weights, stripe_.samples * sizeof(float));
        make(values, channels * stripe_.samples * sizeof(float));
        std::vector<std::uint32_t> first_samples;
        first_samples.reserve(stripe_.begins);
        std::size_t at = 0;
        for (std::size_t v = 0; v < stripe_.slices.size(); ++v) {
            const WarpStripe::Slice &slice = stripe_.slices[v];
            const Ldi view = scene_.views.samples(v).rows(slice.first_row, slice.end_row);
            for (const std::uint64_t begin : view.begin) first_samples.push_back(std::uint32_t(begin + at));
            place(depths, std::span(view.z), at);
            place(weights, std::span(view.weight), at);
            for (std::size_t k = 0; k < channels; ++k)
                place(values, std::span(view.values[k]), k * stripe_.samples + at);
            at += slice.samples;
        }
        upload(begins, std::span(first_samples));
    }

    void make(std::size_t binding, std::size_t bytes) {
        buffers_[binding] = {};
        buffers_[binding] = device_.buffer(bytes);
    }
    template <typename Number>
    void place(std::size_t binding, std::span<const Number> numbers, std::size_t at) {
        device_.upload(buffers_[binding], std::as_bytes(numbers), at * sizeof(Number));
        uploaded_ += numbers.size_bytes();
    }
    template <typename Number>
    void upload(std::size_t binding, std::span<Number> numbers) {
        make(binding, numbers.size_bytes());
        place<std::remove_const_t<Number>>(binding, numbers, 0);
    }
    template <typename Number>
    std::vector<Number> download(std::size_t binding, std::size_t count, std::size_t array = 0) {
        std::vector<Number> numbers(count);
        device_.download(std::as_writable_bytes(std::span(numbers)), buffers_[binding],
                         array * count * sizeof(Number));
        return numbers;
    }

    // Each number becomes the sum of those before it. Returns the last one, which is the sum of all others.
    static std::size_t sum_up(std::vector<std::uint32_t> &numbers) {
        std::exclusive_scan(numbers.begin(), numbers.end(), numbers.begin(), 0u);
        return numbers.back();
    }

    void run(const Program &program, const std::array<std::uint32_t, 3> &groups,
             std::span<const std::byte> push = {}) {
        device_.run(program, buffers_, push, groups);
    }

    Device &device_;
    WarpKernels &kernels_;
    const WarpScene &scene_;
    const WarpStripe &stripe_;
    std::size_t pixels_, blocks_, uploaded_ = 0;
    std::array<Buffer, bindings> buffers_;
};

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
    WarpGpu(const DeviceInfo &info, const Watch &watch) : worker_(info, watch), kernels_(worker_.device) {}

    void warp(const WarpScene &scene, const std::function<void(WarpedBands)> &done) override {
        const auto height = std::size_t(scene.layout.windows.height());
        const auto leave = [&](const char *why) { worker_.report.on_cpu[why] += height; };
        worker_.unless_lost(height, [&] {
            if (!find_mattes(scene.layout.channels).empty()) return leave("Cryptomattes");
            const double inverse_z = largest_inverse_z(scene.views);
            if (!std::isfinite(inverse_z)) return leave("depths that single precision hardly holds");
            warp_rows(scene, height, inverse_z, done);
        });
    }

    DeviceReport take_report() override { return worker_.take_report(); }

private:
    void warp_rows(const WarpScene &scene, std::size_t height, double inverse_z,
                   const std::function<void(WarpedBands)> &done) {
        constexpr std::size_t band = warp_band_rows;
        const auto stripe_of = [&](std::size_t begin, std::size_t count) {
            Imath::Box2i box = scene.layout.windows.data;
            box.min.y += int(begin);
            box.max.y = box.min.y + int(count) - 1;
            return make_stripe(scene, box, inverse_z);
        };
        const auto fit = [&](std::size_t begin, std::size_t most, std::size_t bytes) {
            std::size_t rows = most;
            while (buffer_bytes(scene, stripe_of(begin, rows)) > bytes) {
                if (rows <= band) return std::size_t{0};
                rows = pieces_of(rows, 2 * band) * band;
            }
            return rows;
        };
        const auto work = [&](std::size_t begin, std::size_t rows) -> const char * {
            const WarpStripe stripe = stripe_of(begin, rows);
            const std::uint32_t most =
                worker_.device.info().kind == Kind::software ? most_in_software(scene) : most_in_pixel;
            StripeWork on(worker_.device, kernels_, scene, stripe, most);
            worker_.report.uploaded += on.uploaded();
            if (!on.land()) return "more samples in a pixel than it sorts";
            done({begin / band, pieces_of(rows, band), on.merge(), on.differing_blocks()});
            return nullptr;
        };
        worker_.by_stripes(height, band, fit, work);
    }

    DeviceWorker worker_;
    WarpKernels kernels_;
};

} // namespace

std::unique_ptr<WarpDevice> open_warp_device(const DeviceInfo &info, const Watch &watch) {
    if (!info.float64) throw DeviceFailed(info.name + " lacks double precision");
    return std::make_unique<WarpGpu>(info, watch);
}

} // namespace sparselens::gpu
