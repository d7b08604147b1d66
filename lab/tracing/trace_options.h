// The command line of dof-trace.
#pragma once

#include "base/image.h"
#include "harness/commands/cli.h"
#include "lab/trace/render.h"
#include "options/picture_options.h"

#include <string>
#include <vector>

namespace sparselens::lab {

enum class DeepKind { visible, views, peel, strata };

struct DeepRequest {
    DeepKind kind;
    int layers; // for peel and strata
};

struct TraceOptions {
    std::string scene;
    std::string folder;
    std::string plan; // a plan to render instead of the centre view and the rim views
    int views = 4, lens_views = 0;
    int samples = 16;    // of each view, per pixel of the picture
    int supersample = 1; // pixels of views, across and down, per pixel of the picture
    int reference = 0;   // rays per pixel; 0: no reference
    int halves = 0;      // rays per pixel of both; 0: none
    int width = 640, height = 360;
    bool motion_blur = false;
    double rolling_shutter = 1;
    int moments = 0;  // of the shutter, each with its views; 0: views of a still
    int overscan = 0; // pixels
    double dolly = 0; // scene units
    int seed = 0;     // of the random numbers: different seeds share no noise
    Light light = Light::sun;
    PixelType type = PixelType::half;
    std::vector<DeepRequest> deep;
    LensValues lens;
    GivenLooks looks;
};

void add_trace_options(CLI::App &app, TraceOptions &options);

// The windows, the lens, the light, the camera's motion and the exposure of the picture, and of the views; `camera` is
// the scene's camera, changed by the options. Throws UsageError if they are unreasonably large.
RenderSettings render_settings(const TraceOptions &options, const Camera &camera, const Motion &motion);
RenderSettings view_settings(const TraceOptions &options, const Camera &camera, const Motion &motion);

// Samples per pixel of a view. Throws UsageError if the samples of a picture's pixel cannot be divided among the moments
// and its sub-pixels.
int view_samples(const TraceOptions &options);

} // namespace sparselens::lab
