#include "viewing/shot.h"

#include "base/error.h"
#include "deep/front_depth.h"
#include "io/camera/camera_read.h"
#include "io/channels.h"
#include "io/picture_looks.h"
#include "loading/holdout_file.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace sparselens {

namespace {

// The first of several is the one that a page uses; the others were tried on the way to it.
constexpr std::size_t most_small = 2;

// What is shown of it.
Image rgba_of(const Image &image) {
    std::vector<Channel> channels;
    for (const Channel &channel : image.channels)
        if (channel.name == "R" || channel.name == "G" || channel.name == "B" || channel.name == "A")
            channels.push_back(channel);
    Image out(image.windows, channels);
    for (std::size_t k = 0; k < channels.size(); ++k)
        std::ranges::copy(image.plane(find_channel(image.channels, channels[k].name)), out.plane(k).begin());
    return out;
}

} // namespace

Shot::Shot(const GatherCommand &options, const ToolContext &tool)
    : device_([](const gpu::DeviceInfo &info) { return gpu::open_gather_device(info); },
              {"gathers", "tiles gathered"}) {
    const OpenedLdi &opened =
        cache_.load(options.input, options.channels, {options.lens, options.depth}, options.colour, tool);
    if (!all_found(find_rgb(opened.ldi.channels)))
        throw Error(opened.name + ": needs the channels R, G and B, which are what is shown");
    across_ = subpixels_of(options.windows, opened).across;
    to_display_ = output_transform(options.colour, opened.header);
}

Camera Shot::camera(const GatherCommand &options) const {
    Camera camera = camera_with_options(options.lens, read_camera(in().header));
    if (options.focus_pixel) {
        const float z = front_depth(in().ldi, middle_subpixel(*options.focus_pixel, across_));
        if (!(z > 0)) throw UsageError("--focus-pixel: " + in().name + " has no sample there");
        camera.focus_distance = double(z);
    }
    return camera;
}

ThinLens Shot::lens(const Camera &camera) const {
    ThinLens lens = resolve_lens(camera, in().ldi.windows);
    lens.focal_px /= across_;
    return lens;
}

const GatherWindows &Shot::small_windows(const WindowOptions &options, int proxy) {
    if (const auto found = small_.find(proxy); found != small_.end()) return found->second;
    if (small_.size() >= most_small) small_.erase(small_.begin());
    ThinLens any;
    WindowOptions by = options;
    by.proxy = proxy;
    return small_.emplace(proxy, gather_windows(by, in(), any)).first->second;
}

TakenPicture Shot::taken(const GatherCommand &options, const ToolContext &tool, Progress &progress) {
    TakenPicture out{{}, camera(options), {}};
    ThinLens lens = resolve_lens(out.camera, in().ldi.windows);
    out.lens = this->lens(out.camera);
    if (const auto warning = warning_of_wide_lens(out.camera, lens)) out.warnings.push_back(*warning);
    const auto holdout = open_holdout(options.holdout, in(), options.windows, {options.lens, options.depth});
    GatherWindows frame;
    if (options.windows.proxy > 1) {
        frame = small_windows(options.windows, options.windows.proxy);
        lens.focal_px /= options.windows.proxy * across_;
    } else {
        frame = gather_windows(options.windows, in(), lens);
    }
    const LensFile given_looks = read_looks(options.looks, out.camera.fstop);
    Imf::Header header = in().header;
    LensLooks looks;
    if (options.picture.method == &gather_methods().front())
        looks = picture_looks(given_looks, out.camera, header, lens, frame.ldi(in()).windows);
    else if (const auto warning = warning_of_round_aperture(out.camera.looks, options.picture.method->name))
        out.warnings.push_back(*warning);
    choose_windows(frame, options.windows, in(), lens, looks);
    raise_highlights(frame, in(), highlight_gain(given_looks.values));
    progress.may_end();
    LensTiles tiles;
    PictureOptions by = options.picture;
    by.holdout = holdout ? &*holdout : nullptr;
    by.gather.lens.chosen = &tiles;
    by.gather.lens.device = device_.open(options.device, tool);
    by.gather.lens.looks = looks;
    by.gather.lens.across = frame.subpixels.across;
    Image made;
    if (needs_gather(options.show))
        made =
            frame.changed && options.show == Show::picture
                ? gather_picture(std::move(*frame.changed), lens, frame.gathered, frame.needed, by, progress)
                : gather_picture(frame.ldi(in()), lens, frame.gathered, frame.needed, by, progress);
    device_.report(tool);
    if (options.show != Show::picture) {
        ThinLens of_picture = lens;
        of_picture.focal_px /= frame.subpixels.across;
        made = crop(shown(options.show, frame.ldi(in()), of_picture, frame.gathered, tiles), frame.needed);
    }
    out.image = frame.picture_of(rgba_of(made));
    return out;
}

ShownPixels Shot::displayed(Image image, double exposure) const {
    image = rgba_of(image);
    const auto gain = float(std::exp2(exposure));
    if (exposure != 0)
        for (std::size_t k = 0; k < image.channels.size(); ++k)
            if (image.channels[k].name != "A")
                for (float &value : image.plane(k)) value *= gain;
    transform_colours(to_display_, image);
    return shown_pixels(in().name, image);
}

} // namespace sparselens
