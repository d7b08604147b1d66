// The output folder of dof-trace: pictures with their cameras, and camera.json, which describes them.
#pragma once

#include "deep/ldi.h"
#include "harness/tool.h"
#include "io/moment_files.h"
#include "lab/trace/render.h"
#include "view/view.h"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sparselens::lab {

// From where, and when, a picture is taken.
struct Viewpoint {
    Imath::V2d u{0, 0};                      // lens point
    std::optional<StatedMoment> moment = {}; // else the middle of the shutter

    double time() const { return moment ? moment_of(moment->moment, moment->moments).opens : 0.5; }
};

class TraceOutputs {
public:
    // `settings` are for the picture; views may have finer pixels. Creates the folder; throws Error if that fails.
    TraceOutputs(std::string folder, Camera camera, RenderSettings settings, PixelType type,
                 const ToolContext &tool);

    // Renders with `make`, writes DIR/name and records the rendering time. For pictures over the lens, the header states
    // the number of `rays` per pixel.
    void add(const std::string &name, const Viewpoint &from, const std::function<Image()> &make,
             std::optional<int> rays = {});
    void add_deep(const std::string &name, const Viewpoint &from, const std::function<Ldi()> &make);

    // Writes DIR/camera.json; an infinite number becomes null. `views` are the lens points of the rim views. The
    // samples of the views and of each half are counted per pixel of the picture.
    void write_summary(const std::vector<Imath::V2d> &views, int view_samples, int supersample,
                       int reference_samples, int half_samples) const;

private:
    Imf::Header header_of(const Windows &windows, const Viewpoint &from) const;
    void note(const std::string &name, double seconds);
    std::string path(const std::string &name) const { return folder_ + "/" + name; }

    std::string folder_;
    Camera camera_;
    RenderSettings settings_;
    PixelType type_;
    const ToolContext &tool_;
    std::vector<std::pair<std::string, double>> seconds_;
};

} // namespace sparselens::lab
