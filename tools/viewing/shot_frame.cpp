#include "viewing/shot_frame.h"

#include "base/error.h"
#include "deep/front_samples.h"

#include <ImfStringAttribute.h>
#include <fmt/format.h>
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

Ldi all_rows(const PackedRows &rows) {
    const Imath::Box2i &data = rows.windows().data;
    return rows.rows(data.min.y, data.max.y);
}

Ldi ShotFrame::row(int y) const { return packed.rows(y, y); }

OpenedLdi ShotFrame::unpacked() const {
    OpenedLdi all = in;
    all.ldi = all_rows(packed);
    return all;
}

Camera ShotFrame::camera(const PictureRequest &request) const {
    return picture_camera(request, in, [this](const Imath::V2i &at) { return front_depth(row(at.y), at); });
}

ThinLens ShotFrame::lens(const PictureRequest &request) const {
    return picture_lens(request, in, camera(request));
}

ShotFrame pack(OpenedLdi in) {
    PackedRows rows(in.ldi.windows);
    rows.append(in.ldi);
    Ldi bare;
    bare.windows = in.ldi.windows;
    bare.channels = in.ldi.channels;
    in.ldi = std::move(bare);
    return {std::move(in), std::move(rows)};
}

ShotFrame shot_frame(OpenedLdi in, const WindowOptions &windows, const ColourOptions &colour) {
    if (!all_found(find_rgb(in.ldi.channels)))
        throw Error(in.name + ": needs the channels R, G and B, which are what is shown");
    const DepthExtent depths = depth_extent(in.ldi);
    ShotFrame frame = pack(std::move(in));
    frame.across = subpixels_of(windows, frame.in).across;
    frame.depths = depths;
    frame.names = object_names(frame.in.header);
    frame.to_display = output_transform(colour, frame.in.header);
    return frame;
}

namespace {

// The depth of the nearest sample in the middle of the picture; if there is none, the smallest depth of the picture.
float depth_in_the_middle(const ShotFrame &frame) {
    const Imath::Box2i &display = frame.in.ldi.windows.display;
    const Imath::V2i at((display.min.x + display.max.x) / 2, (display.min.y + display.max.y) / 2);
    const float z = frame.in.ldi.windows.data.intersects(at) ? front_depth(frame.row(at.y), at) : 0;
    return z > 0 ? z : float(frame.depths.nearest);
}

} // namespace

Words lens_guess(const ShotFrame &frame, const Camera &camera) {
    const auto radius = lens_radius_of(camera);
    if (radius == 0.0) return {}; // nothing else is needed
    Words words;
    const auto add = [&](const char *option, std::string value) {
        words.push_back(option);
        words.push_back(std::move(value));
    };
    const bool field_known = focal_length_px(camera, frame.in.ldi.windows.display_width()).has_value();
    if (!camera.focal_length_mm && (!field_known || !radius)) add("--focal-length", "50");
    if (!camera.sensor_width_mm && !field_known) add("--sensor-width", "36");
    if (!radius && !camera.fstop) add("--fstop", "2.8");
    if (!camera.focus_distance) add("--focus-distance", fmt::format("{}", depth_in_the_middle(frame)));
    return words;
}

std::string guess_in_words(const Words &guess) {
    std::string text;
    for (std::size_t i = 0; i + 1 < guess.size(); i += 2)
        text += (i ? " " : "") + guess[i] + " " + guess[i + 1];
    return text.empty() ? text
                        : "the file does not say all of its lens; this is a guess to begin with: " + text;
}

} // namespace sparselens
