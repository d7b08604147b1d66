#include "lab/tracing/trace_outputs.h"

#include "io/camera/camera_header.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/exr/exr_header.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "lab/trace/camera_at.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>

namespace sparselens::lab {

namespace {

void set_colour_type(std::vector<Channel> &channels, PixelType type) {
    for (Channel &channel : channels)
        if (channel.type == PixelType::half) channel.type = type;
}

template <typename Make>
auto timed(const Make &make, double &seconds) {
    const auto start = std::chrono::steady_clock::now();
    auto result = make();
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

} // namespace

TraceOutputs::TraceOutputs(std::string folder, Camera camera, RenderSettings settings, PixelType type,
                           const ToolContext &tool)
    : folder_(std::move(folder)), camera_(std::move(camera)), settings_(std::move(settings)), type_(type),
      tool_(tool) {
    make_folder(folder_);
    const ThinLens &lens = settings_.lens;
    tool_.say(fmt::format("lens radius {:g}, focus distance {:g}, focal length {:g} pixels", lens.radius,
                          lens.focus, lens.focal_px));
}

// Counts the pixels of this camera per pixel of the picture: finer pixels, more of them.
Imf::Header TraceOutputs::header_of(const Windows &windows, const Viewpoint &from) const {
    Camera camera = camera_at(camera_, settings_.windows, settings_.lens.radius * from.u,
                              Placement(settings_.camera, from.time()));
    const int across = windows.display_width() / settings_.windows.display_width();
    if (across > 1) camera.supersample = across;
    Imf::Header header;
    write_camera(header, camera);
    if (from.moment) write_stated_moment(header, *from.moment);
    return header;
}

void TraceOutputs::note(const std::string &name, double seconds) {
    seconds_.emplace_back(name, seconds);
    tool_.say(fmt::format("{}: {:.3f} s", path(name), seconds));
}

void TraceOutputs::add(const std::string &name, const Viewpoint &from, const std::function<Image()> &make,
                       std::optional<int> rays) {
    double seconds = 0;
    Image image = timed(make, seconds);
    set_colour_type(image.channels, type_);
    Imf::Header header = header_of(image.windows, from);
    if (rays) write_render_samples(header, *rays);
    write_flat_exr(path(name), image, header);
    note(name, seconds);
}

void TraceOutputs::add_deep(const std::string &name, const Viewpoint &from,
                            const std::function<Ldi()> &make) {
    double seconds = 0;
    Ldi ldi = timed(make, seconds);
    set_colour_type(ldi.channels, type_);
    write_ldi(path(name), ldi, header_of(ldi.windows, from));
    note(name, seconds);
}

void TraceOutputs::write_summary(const std::vector<Imath::V2d> &views, int view_samples, int supersample,
                                 int reference_samples, int half_samples) const {
    nlohmann::ordered_json json{{"width", settings_.windows.display_width()},
                                {"height", settings_.windows.display_height()},
                                {"focal_mm", *camera_.focal_length_mm},
                                {"sensor_width_mm", *camera_.sensor_width_mm},
                                {"fstop", *camera_.fstop},
                                {"focus_distance", *camera_.focus_distance},
                                {"lens_radius", settings_.lens.radius},
                                {"views", nlohmann::ordered_json::array()},
                                {"view_spp", view_samples},
                                {"supersample", supersample},
                                {"ref_spp", reference_samples},
                                {"half_spp", half_samples},
                                {"seconds", nlohmann::ordered_json::object()}};
    for (const Imath::V2d &u : views) json["views"].push_back({u.x, u.y});
    for (const auto &[name, time] : seconds_) json["seconds"][name] = std::round(time * 1000) / 1000;
    write_text_file(path("camera.json"), json.dump(1) + '\n'); // infinity as null
}

} // namespace sparselens::lab
