#include "lab/tracing/trace_outputs.h"

#include "io/camera/camera_metadata.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"
#include "io/files/folder.h"
#include "lab/trace/camera_at.h"

#include <chrono>
#include <cmath>
#include <cstdio>

namespace sparselens::lab {

namespace {

std::string text_of(double value, const char *format) {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// JSON knows no infinity.
std::string json(double value, const char *format = "%.17g") {
    return std::isfinite(value) ? text_of(value, format) : "null";
}

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
    tool_.say("lens radius " + text_of(lens.radius, "%g") + ", focus distance " + text_of(lens.focus, "%g") +
              ", focal length " + text_of(lens.focal_px, "%g") + " pixels");
}

void TraceOutputs::note(const std::string &name, double seconds) {
    seconds_.emplace_back(name, seconds);
    tool_.say(path(name) + ": " + text_of(seconds, "%.3f") + " s");
}

void TraceOutputs::add(const std::string &name, const Imath::V2d &u, const std::function<Image()> &make) {
    double seconds = 0;
    Image image = timed(make, seconds);
    set_colour_type(image.channels, type_);
    Imf::Header header;
    write_camera(header, camera_at(camera_, settings_.windows, settings_.lens.radius * u));
    write_flat_exr(path(name), image, header);
    note(name, seconds);
}

void TraceOutputs::add_deep(const std::string &name, const std::function<Ldi()> &make) {
    double seconds = 0;
    Ldi ldi = timed(make, seconds);
    set_colour_type(ldi.channels, type_);
    Imf::Header header;
    write_camera(header, camera_at(camera_, settings_.windows, {0, 0}));
    write_ldi(path(name), ldi, header);
    note(name, seconds);
}

void TraceOutputs::write_summary(const std::vector<Imath::V2d> &views, int view_samples,
                                 int reference_samples) const {
    std::string text = "{\n";
    const auto put = [&](const char *key, const std::string &value) {
        text += std::string(" \"") + key + "\": " + value + ",\n";
    };
    put("width", std::to_string(settings_.windows.display_width()));
    put("height", std::to_string(settings_.windows.display_height()));
    put("focal_mm", json(*camera_.focal_length_mm));
    put("sensor_width_mm", json(*camera_.sensor_width_mm));
    put("fstop", json(*camera_.fstop));
    put("focus_distance", json(*camera_.focus_distance));
    put("lens_radius", json(settings_.lens.radius));
    std::string points;
    for (const Imath::V2d &u : views)
        points += (points.empty() ? "[" : ", [") + json(u.x) + ", " + json(u.y) + "]";
    put("views", "[" + points + "]");
    put("view_spp", std::to_string(view_samples));
    put("ref_spp", std::to_string(reference_samples));
    std::string seconds;
    for (const auto &[name, time] : seconds_)
        seconds += (seconds.empty() ? "\n  \"" : ",\n  \"") + name + "\": " + json(time, "%.3f");
    text += " \"seconds\": {" + seconds + "\n }\n}\n";
    OutputFile file(path("camera.json"));
    file.stream().write(text.data(), int(text.size()));
    file.commit();
}

} // namespace sparselens::lab
