#include "viewing/shot_frame.h"

#include "base/error.h"
#include "deep/front_samples.h"
#include "io/camera/camera_read.h"
#include "chain/channels.h"

#include <ImfStringAttribute.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace sparselens {

namespace {

using Json = nlohmann::json;

void add_names(ObjectNames &names, const std::string &manifest) {
    const Json json = Json::parse(manifest, nullptr, false);
    if (!json.is_object()) return;
    for (const auto &[name, id] : json.items())
        if (id.is_string())
            names[std::uint32_t(std::strtoul(id.get_ref<const std::string &>().c_str(), nullptr, 16))] = name;
}

} // namespace

ObjectNames object_names(const Imf::Header &header) {
    ObjectNames names;
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const std::string name = attribute.name();
        const auto *text = dynamic_cast<const Imf::StringAttribute *>(&attribute.attribute());
        if (text && name.starts_with("cryptomatte/") && name.ends_with("/manifest"))
            add_names(names, text->value());
    }
    return names;
}

DepthExtent depth_extent(const Ldi &ldi) {
    const std::vector<float> &depths = ldi.optical.empty() ? ldi.z : ldi.optical;
    if (depths.empty()) return {};
    DepthExtent extent{HUGE_VAL, 0};
    for (const float z : depths) {
        if (!(z > 0)) continue; // rays would meet behind the camera
        extent.nearest = std::min(extent.nearest, double(z));
        extent.farthest = std::max(extent.farthest, double(z));
    }
    return extent.farthest > 0 ? extent : DepthExtent{};
}

Ldi PackedLdi::row(int y) const { return packed.rows(y, y); }

OpenedLdi PackedLdi::unpacked() const {
    OpenedLdi all = in;
    const Imath::Box2i &data = packed.windows().data;
    all.ldi = packed.rows(data.min.y, data.max.y);
    return all;
}

PackedLdi pack(OpenedLdi in) {
    PackedRows rows(in.ldi.windows);
    rows.append(in.ldi);
    Ldi bare;
    bare.windows = in.ldi.windows;
    bare.channels = in.ldi.channels;
    in.ldi = std::move(bare);
    return {std::move(in), std::move(rows)};
}

Camera ShotFrame::camera(const GatherCommand &options) const {
    Camera camera = camera_with_options(options.lens, read_camera(in.header));
    if (options.focus_pixel) {
        const Imath::V2i at = middle_subpixel(*options.focus_pixel, across);
        const float z = in.ldi.windows.data.intersects(at) ? front_depth(row(at.y), at) : 0;
        if (!(z > 0)) throw UsageError("--focus-pixel: " + in.name + " has no sample there");
        camera.focus_distance = double(z);
    }
    return camera;
}

ThinLens ShotFrame::lens(const Camera &camera) const {
    ThinLens lens = resolve_lens(camera, in.ldi.windows);
    lens.focal_px /= across;
    return lens;
}

ShotFrame shot_frame(OpenedLdi in, const WindowOptions &windows, const ColourOptions &colour) {
    if (!all_found(find_rgb(in.ldi.channels)))
        throw Error(in.name + ": needs the channels R, G and B, which are what is shown");
    const DepthExtent depths = depth_extent(in.ldi);
    const int across = subpixels_of(windows, in).across;
    ObjectNames names = object_names(in.header);
    ColourTransform to_display = output_transform(colour, in.header);
    return {pack(std::move(in)), across, depths, std::move(names), std::move(to_display)};
}

} // namespace sparselens
