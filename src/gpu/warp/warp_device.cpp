#include "gpu/warp/warp_device.h"

#include "base/grid.h"
#include "base/matte.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "gpu/device_worker.h"
#include "gpu/warp/prefix_sums.h"
#include "kernels/warp_layout.h"
#include "kernels/warp_rules.h"
#include "warp/photo_consistency.h"
#include "warp/reprojected_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
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
          emit(device.program("emit", emit_code, bindings, 0)), sums(device) {}

    Program land, surfaces, differences, vote, emit;
    PrefixSums sums;
    std::vector<Buffer> buffers; // by Binding; kept for later warps
};

// The work groups for a number of items; more than one row if they are many.
std::array<std::uint32_t, 3> groups_for(std::size_t items) {
    constexpr std::size_t most_in_row = 1 << 15; // every device takes as many groups
    const std::size_t groups = std::max(pieces_of(items, std::size_t{warp_kernel::threads}), std::size_t{1});
    return {std::uint32_t(std::min(groups, most_in_row)), std::uint32_t(pieces_of(groups, most_in_row)), 1};
}

// Whether a device in single precision holds all depths and their inverses: it may take denormal numbers for 0.
bool holds_depths(const ReprojectedViews &views) {
    constexpr float infinity = std::numeric_limits<float>::infinity(),
                    normal = std::numeric_limits<float>::min();
    std::vector<char> holds(views.size());
    parallel_for(views.size(), [&](std::size_t v) {
        const ViewSamples &view = views.samples(v);
        float nearest = infinity, farthest = 1;
        for (std::size_t p = 0; p < view.windows.pixels(); ++p)
            for (const std::uint64_t i : view.pixel(p)) {
                nearest = std::min(nearest, view.z(i));
                if (view.z(i) < infinity) farthest = std::max(farthest, view.z(i));
            }
        holds[v] = nearest >= normal && 1 / double(farthest) >= double(normal);
    });
    return std::ranges::find(holds, 0) == holds.end();
}

std::vector<warp_kernel::View> views_of(const ReprojectedViews &views) {
    std::vector<warp_kernel::View> all;
    std::size_t begins = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
        const ViewMapping &mapping = views.reprojection(v).mapping();
        const Imath::V2d offset = mapping.at_infinity({0, 0}), step = mapping.parallax({0, 0});
        const Windows &windows = views.samples(v).windows;
        const Imath::Box2i &data = windows.data;
        all.push_back({mapping.unzoom(), mapping.approach(), offset.x, offset.y, step.x, step.y, data.min.x,
                       data.min.y, data.max.x, data.max.y, std::uint32_t(begins), 0});
        begins += windows.pixels() + 1;
    }
    return all;
}

std::size_t sample_count(const ReprojectedViews &views) {
    std::size_t count = 0;
    for (std::size_t v = 0; v < views.size(); ++v)
        count += views.samples(v).count(0, std::size_t(views.samples(v).windows.height()));
    return count;
}

warp_kernel::Frame frame_of(const WarpScene &scene, std::size_t samples, std::uint32_t most_in_pixel) {
    warp_kernel::Frame frame{};
    frame.tolerance = scene.tolerance;
    frame.inverse_scale = 1 / scene.scale;
    frame.motion_unit = kernels::motion_unit(scene.across);
    const Windows &windows = scene.layout.windows;
    frame.first_x = windows.data.min.x;
    frame.first_y = windows.data.min.y;
    frame.width = windows.width();
    frame.height = windows.height();
    frame.views = std::uint32_t(scene.views.size());
    frame.samples = std::uint32_t(samples);
    frame.channels = std::uint32_t(scene.layout.channels.size());
    const std::size_t alpha = find_channel(scene.layout.channels, "A");
    frame.alpha = alpha == npos ? warp_kernel::none : std::uint32_t(alpha);
    for (const std::size_t colour : find_rgb(scene.layout.channels))
        if (colour != npos) frame.colours[frame.colours[3]++] = std::uint32_t(colour);
    frame.rules = scene.averages ? warp_kernel::averages : 0;
    if (scene.focus) {
        frame.rules |= std::isinf(scene.focus->focus)
                           ? warp_kernel::focus_known | warp_kernel::focus_at_infinity
                           : warp_kernel::focus_known;
        frame.focus_scale = scene.focus->radius * scene.focus->focal_px;
        frame.focus = scene.focus->focus;
    }
    frame.most_in_pixel = most_in_pixel;
    return frame;
}

// One warp: views are uploaded, samples of the LDI are downloaded.
class WarpWork {
public:
    // Records the whole warp. `most`: the largest number of samples in a pixel.
    WarpWork(Device &device, WarpKernels &kernels, const WarpScene &scene, std::uint32_t most)
        : device_(device), kernels_(kernels), scene_(scene) {
        const std::size_t samples = sample_count(scene.views), channels = scene.layout.channels.size(),
                          all_begins = views_.back().begins + pixels_of(views_.back()) + 1;
        device.make_room(kernels.buffers,
                         std::array{sizeof(warp_kernel::Frame), views_.size() * sizeof(warp_kernel::View),
                                    all_begins * 4, samples * 4, samples * 4, channels * samples * 4,
                                    channels * 4, (pixels_ + 2) * 4, samples * 16, samples * 8, samples * 8,
                                    blocks_ * 4, (pixels_ + 1) * 4, (4 + channels) * samples * 4});
        const warp_kernel::Frame constants = frame_of(scene, samples, most);
        upload(frame, std::span(&constants, 1));
        upload(views, std::span(views_));
        upload_views(samples);
        std::vector<std::uint32_t> copied;
        for (const Channel &channel : scene.layout.channels) copied.push_back(holds_ids(channel) ? 1 : 0);
        upload(ids, std::span(copied));
        land();
        merge();
    }

    std::size_t uploaded() const { return uploaded_; } // bytes

    // Submits the warp, and downloads the LDI. Returns nothing if some pixel has too many samples.
    std::optional<Ldi> finish() {
        std::uint32_t too_many = 0;
        std::vector<std::uint32_t> begin(pixels_ + 1);
        verdicts_.resize(blocks_);
        device_.finish(std::array{to(begin, emitted), to(verdicts_, verdicts),
                                  to(std::span(&too_many, 1), ends, pixels_ + 1)});
        if (too_many != 0) return {};
        Ldi ldi = empty_like(scene_.layout);
        ldi.begin.assign(begin.begin(), begin.end());
        std::vector<Download> arrays;
        const auto take = [&](std::vector<float> &array) {
            array.resize(begin.back());
            arrays.push_back(to(array, results, arrays.size() * begin.back()));
        };
        for (std::vector<float> *array : {&ldi.z, &ldi.dx, &ldi.dy, &ldi.weight}) take(*array);
        for (std::vector<float> &array : ldi.values) take(array);
        device_.finish(arrays);
        return ldi;
    }

    std::vector<Disagreement> differing_blocks() const { // after finish(); see WarpedViews
        std::vector<Disagreement> differ(blocks_);
        std::ranges::transform(verdicts_, differ.begin(), disagreement_of);
        return differ;
    }

private:
    static std::size_t pixels_of(const warp_kernel::View &view) {
        return std::size_t(view.max_x - view.min_x + 1) * std::size_t(view.max_y - view.min_y + 1);
    }

    // Puts all samples into the pixels that they fall into.
    void land() {
        std::size_t most_pixels = 1;
        for (const warp_kernel::View &view : views_) most_pixels = std::max(most_pixels, pixels_of(view));
        std::array<std::uint32_t, 3> groups = groups_for(most_pixels);
        groups[2] = std::uint32_t(views_.size());
        device_.fill(kernels_.buffers[ends], 0);
        for (const std::uint32_t list : {0u, 1u}) {
            device_.run(kernels_.land, kernels_.buffers, std::as_bytes(std::span(&list, 1)), groups);
            if (list == 0) kernels_.sums.run(kernels_.buffers[ends], pixels_ + 1);
        }
    }

    void merge() {
        const auto run = [&](const Program &program, std::size_t items) {
            device_.run(program, kernels_.buffers, {}, groups_for(items));
        };
        run(kernels_.surfaces, pixels_);
        if (scene_.tests_photo_consistency)
            run(kernels_.differences, blocks_);
        else
            device_.fill(kernels_.buffers[verdicts], kernels::may_average);
        run(kernels_.vote, pixels_);
        kernels_.sums.run(kernels_.buffers[emitted], pixels_ + 1);
        run(kernels_.emit, pixels_);
    }

    // Uploads the arrays of all views, one after the other, and where in them the samples of each pixel begin; after
    // the pixels of a view, where its last sample ends.
    void upload_views(std::size_t samples) {
        std::vector<std::uint32_t> first_samples;
        std::size_t at = 0;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const Ldi view = scene_.views.samples(v).as_ldi();
            for (const std::uint64_t begin : view.begin) first_samples.push_back(std::uint32_t(begin + at));
            upload(depths, std::span(view.z), at);
            upload(weights, std::span(view.weight), at);
            for (std::size_t k = 0; k < view.values.size(); ++k)
                upload(values, std::span(view.values[k]), k * samples + at);
            at += view.samples();
        }
        upload(begins, std::span(first_samples));
    }

    // `at`: in numbers.
    template <typename Number>
    void upload(Binding binding, std::span<Number> numbers, std::size_t at = 0) {
        device_.upload(kernels_.buffers[binding], std::as_bytes(numbers), at * sizeof(Number));
        uploaded_ += numbers.size_bytes();
    }
    template <typename Numbers>
    Download to(Numbers &&numbers, Binding binding, std::size_t at = 0) const {
        return {std::as_writable_bytes(std::span(numbers)), kernels_.buffers[binding], at * 4};
    }

    Device &device_;
    WarpKernels &kernels_;
    const WarpScene &scene_;
    std::vector<warp_kernel::View> views_ = views_of(scene_.views);
    std::size_t pixels_ = scene_.layout.windows.pixels(),
                blocks_ = Tiles(scene_.layout.windows.data, kernels::photo_block).count(), uploaded_ = 0;
    std::vector<std::uint32_t> verdicts_ = {};
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

    std::optional<WarpedViews> warp(const WarpScene &scene) override {
        std::optional<WarpedViews> done;
        const auto height = std::size_t(scene.layout.windows.height());
        const auto leave = [&](const char *why) { worker_.report.on_cpu[why] += height; };
        worker_.unless_lost(height, [&] {
            if (!find_mattes(scene.layout.channels).empty()) return leave("Cryptomattes");
            if (!holds_depths(scene.views)) return leave("depths that single precision hardly holds");
            const bool in_software = worker_.device.info().kind == Kind::software;
            WarpWork on(worker_.device, kernels_, scene,
                        in_software ? most_in_software(scene) : most_in_pixel);
            worker_.report.uploaded += on.uploaded();
            std::optional<Ldi> ldi = on.finish();
            if (!ldi) return leave("more samples in a pixel than it sorts");
            done = {std::move(*ldi), on.differing_blocks()};
            worker_.report.on_device += height;
        });
        return done;
    }

    DeviceReport take_report() override { return worker_.take_report(); }

private:
    DeviceWorker worker_;
    WarpKernels kernels_;
};

} // namespace

std::unique_ptr<WarpDevice> open_warp_device(const DeviceInfo &info, const Watch &watch) {
    if (!info.float64) throw DeviceFailed(info.name + " lacks double precision");
    return std::make_unique<WarpGpu>(info, watch);
}

} // namespace sparselens::gpu
