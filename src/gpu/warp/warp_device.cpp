#include "gpu/warp/warp_device.h"

#include "base/grid.h"
#include "base/matte.h"
#include "deep/build.h"
#include "gpu/device_worker.h"
#include "gpu/warp/warp_stripe.h"
#include "kernels/warp_layout.h"
#include "warp/photo_consistency.h"
#include "warp/reprojected_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace sparselens::gpu {

// The kernels of the warp, and their work on one stripe: views are uploaded, samples of the LDI are downloaded.

// The work groups for a number of items; more than one row if they are many.
std::array<std::uint32_t, 3> groups_for(std::size_t items, std::size_t per_group);

// The prefix sum of numbers in a buffer of a device: each becomes the sum of those before it.
class PrefixSum {
public:
    explicit PrefixSum(Device &device);

    // The numbers are 32 bits each, and so is their sum.
    void run(Buffer &numbers, std::size_t count);

private:
    Device &device_;
    Program within_, add_; // within blocks; and adding to each block the sum of those before it
};

struct WarpKernels {
    explicit WarpKernels(Device &device);

    Program land, surfaces, differences, vote, emit;
    PrefixSum sum;
};

class StripeWork {
public:
    // Uploads what the stripe needs. `most`: samples in a pixel.
    StripeWork(Device &device, WarpKernels &kernels, const WarpScene &scene, const WarpStripe &stripe,
               std::uint32_t most);

    // Puts all samples into the pixels that they fall into. Returns false if some pixel has too many samples; nothing
    // else can be done then.
    bool land();
    Ldi merge();                                       // once, after land()
    std::vector<Disagreement> differing_blocks();      // after merge(); see WarpedBands
    std::size_t uploaded() const { return uploaded_; } // bytes

private:
    enum Binding : std::size_t; // as in warp_data.glsl

    void upload_views();
    void upload(std::size_t binding, std::span<const std::byte> bytes);
    void make(std::size_t binding, std::size_t bytes);
    std::uint32_t word(std::size_t binding, std::size_t index); // 32 bits of a buffer
    void run(const Program &program, std::span<const std::byte> push,
             const std::array<std::uint32_t, 3> &groups);
    Ldi download(std::size_t samples);

    Device &device_;
    WarpKernels &kernels_;
    const WarpScene &scene_;
    const WarpStripe &stripe_;
    std::size_t pixels_, blocks_, uploaded_ = 0;
    std::array<std::optional<Buffer>, 15> buffers_;
};

namespace {

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

namespace {

constexpr std::uint32_t within_code[] = {
#include <warp_scan.comp.inc>
};
constexpr std::uint32_t add_code[] = {
#include <warp_scan_add.comp.inc>
};

using warp_kernel::scan_block, warp_kernel::threads;
constexpr std::size_t most_in_row = 1 << 15; // every device takes as many groups

} // namespace

std::array<std::uint32_t, 3> groups_for(std::size_t items, std::size_t per_group) {
    const std::size_t groups = std::max(pieces_of(items, per_group), std::size_t{1});
    return {std::uint32_t(std::min(groups, most_in_row)), std::uint32_t(pieces_of(groups, most_in_row)), 1};
}

PrefixSum::PrefixSum(Device &device)
    : device_(device), within_(device.program("scan", within_code, 2, 4)),
      add_(device.program("scan", add_code, 2, 4)) {}

void PrefixSum::run(Buffer &numbers, std::size_t count) {
    const std::size_t blocks = pieces_of(count, std::size_t{scan_block});
    Buffer sums = device_.buffer(blocks * 4);
    const auto push_count = std::uint32_t(count);
    const std::array<const Buffer *, 2> buffers{&numbers, &sums};
    const auto push = std::as_bytes(std::span(&push_count, 1));
    device_.run(within_, buffers, push, groups_for(count, std::size_t{scan_block}));
    if (blocks <= 1) return;
    run(sums, blocks);
    device_.run(add_, buffers, push, groups_for(count, threads));
}

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

using warp_kernel::threads;
constexpr std::uint32_t bindings = 15;

} // namespace

enum StripeWork::Binding : std::size_t {
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
    state
};

WarpKernels::WarpKernels(Device &device)
    : land(device.program("land", land_code, bindings, 4)),
      surfaces(device.program("surfaces", surfaces_code, bindings, 0)),
      differences(device.program("differences", differences_code, bindings, 0)),
      vote(device.program("vote", vote_code, bindings, 0)),
      emit(device.program("emit", emit_code, bindings, 0)), sum(device) {}

StripeWork::StripeWork(Device &device, WarpKernels &kernels, const WarpScene &scene, const WarpStripe &stripe,
                       std::uint32_t most)
    : device_(device), kernels_(kernels), scene_(scene), stripe_(stripe), pixels_(Grid(stripe.box).size()),
      blocks_(Tiles(stripe.box, kernels::photo_block).count()) {
    const warp_kernel::Frame constants = frame_of(scene, stripe, most);
    upload(frame, std::as_bytes(std::span(&constants, 1)));
    upload(views, std::as_bytes(std::span(stripe.views)));
    upload_views();
    std::vector<std::uint32_t> copied;
    for (const Channel &channel : scene.layout.channels) copied.push_back(holds_ids(channel) ? 1 : 0);
    upload(ids, std::as_bytes(std::span(copied)));
    for (const std::size_t binding : {landed, marks, means, verdicts, emitted, results}) make(binding, 4);
    make(ends, (pixels_ + 1) * 4);
    device_.fill(*buffers_[ends], 0);
    make(state, 4);
    device_.fill(*buffers_[state], 0);
}

void StripeWork::upload(std::size_t binding, std::span<const std::byte> bytes) {
    make(binding, bytes.size());
    device_.upload(*buffers_[binding], bytes);
    uploaded_ += bytes.size();
}

void StripeWork::make(std::size_t binding, std::size_t bytes) {
    buffers_[binding].reset();
    buffers_[binding] = device_.buffer(bytes);
}

// Uploads the arrays of all views, one after the other, and where in them the samples of each pixel begin; after the
// pixels of a view, where its last sample ends.
void StripeWork::upload_views() {
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
        const auto place = [&](std::size_t binding, const std::vector<float> &array, std::size_t to) {
            const auto part = std::as_bytes(std::span(array));
            device_.upload(*buffers_[binding], part, to * sizeof(float));
            uploaded_ += part.size();
        };
        place(depths, view.z, at);
        place(weights, view.weight, at);
        for (std::size_t k = 0; k < channels; ++k) place(values, view.values[k], k * stripe_.samples + at);
        at += slice.samples;
    }
    upload(begins, std::as_bytes(std::span(first_samples)));
}

std::uint32_t StripeWork::word(std::size_t binding, std::size_t index) {
    std::uint32_t value = 0;
    device_.download(std::as_writable_bytes(std::span(&value, 1)), *buffers_[binding], index * 4);
    return value;
}

void StripeWork::run(const Program &program, std::span<const std::byte> push,
                     const std::array<std::uint32_t, 3> &groups) {
    std::array<const Buffer *, bindings> all;
    std::ranges::transform(buffers_, all.begin(), [](const auto &buffer) { return &*buffer; });
    device_.run(program, all, push, groups);
}

bool StripeWork::land() {
    std::size_t most_pixels = 1;
    for (const warp_kernel::View &view : stripe_.views)
        most_pixels =
            std::max(most_pixels, std::size_t(view.rows) * std::size_t(view.max_x - view.min_x + 1));
    std::array<std::uint32_t, 3> groups = groups_for(most_pixels, threads);
    groups[2] = std::uint32_t(stripe_.slices.size());
    const auto pass = [&](std::uint32_t list) {
        run(kernels_.land, std::as_bytes(std::span(&list, 1)), groups);
    };
    pass(0);
    if (word(state, 0) != 0) return false;
    kernels_.sum.run(*buffers_[ends], pixels_ + 1);
    const std::size_t count = word(ends, pixels_);
    make(landed, count * 16);
    make(marks, count * 8);
    make(means, count * 8);
    pass(1);
    return true;
}

Ldi StripeWork::merge() {
    const auto groups = groups_for(pixels_, threads);
    run(kernels_.surfaces, {}, groups);
    make(verdicts, blocks_ * 4);
    if (scene_.tests_photo_consistency)
        run(kernels_.differences, {}, groups_for(blocks_, threads));
    else
        device_.fill(*buffers_[verdicts], kernels::may_average);
    make(emitted, (pixels_ + 1) * 4);
    run(kernels_.vote, {}, groups);
    kernels_.sum.run(*buffers_[emitted], pixels_ + 1);
    const std::size_t samples = word(emitted, pixels_);
    make(results, (4 + scene_.layout.channels.size()) * samples * 4);
    run(kernels_.emit, {}, groups);
    return download(samples);
}

Ldi StripeWork::download(std::size_t samples) {
    Ldi ldi = empty_like(scene_.layout);
    std::vector<std::uint32_t> begin(pixels_ + 1);
    device_.download(std::as_writable_bytes(std::span(begin)), *buffers_[emitted]);
    ldi.begin.assign(begin.begin(), begin.end());
    std::size_t at = 0;
    const auto take = [&](std::vector<float> &array) {
        array.resize(samples);
        device_.download(std::as_writable_bytes(std::span(array)), *buffers_[results], at);
        at += samples * sizeof(float);
    };
    for (std::vector<float> *array : {&ldi.z, &ldi.dx, &ldi.dy, &ldi.weight}) take(*array);
    for (std::vector<float> &array : ldi.values) take(array);
    return ldi;
}

std::vector<Disagreement> StripeWork::differing_blocks() {
    std::vector<std::uint32_t> words(blocks_);
    device_.download(std::as_writable_bytes(std::span(words)), *buffers_[verdicts]);
    std::vector<Disagreement> differ(blocks_);
    std::ranges::transform(words, differ.begin(), disagreement_of);
    return differ;
}

} // namespace sparselens::gpu
