// The lens options every tool shares, and the rule that turns them and a file's metadata into a lens.
#pragma once

#include "base/image.h"
#include "lens/thin_lens.h"
#include "view/camera.h"
#include "view/depth.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace sparselens {

struct LensOptions {
    std::optional<double> focal_length_mm, sensor_width_mm, fstop, lens_radius, focus_distance, scene_unit;
};

// How files are read.
struct DepthOptions {
    DepthMeaning meaning = DepthMeaning::planar;
    std::string channel;   // empty: the usual names are tried
    std::string view = {}; // of a stereo file; empty: the default one
    double far = 1e10;     // what lies there or beyond is the sky, in the unit of the depth channel
};

void add_lens_options(CLI::App &app, LensOptions &options);
void add_depth_options(CLI::App &app, DepthOptions &options); // the view among them
void add_stereo_option(CLI::App &app, std::string &view);

// The file's camera with the options put over it. --lens-radius becomes an f-number; --scene-unit leaves the
// file's focus where it is in metres.
Camera camera_with_options(const LensOptions &options, Camera from_file);

// What is neither 0 nor below (nor infinite, unless allowed). CLI11 reads "inf" and "nan" as numbers; the second is
// never meant.
struct NumberRange {
    bool zero_allowed = false, infinity_allowed = false;
};
CLI::Validator number(const std::string &what, NumberRange range = {});

// Radius of the aperture, scene units; empty where the camera does not tell.
std::optional<double> lens_radius_of(const Camera &camera);

// The radius by --lens-radius, else by the camera's f-number, else UsageError naming the option to give.
double resolve_radius(const LensOptions &options, const Camera &camera);

// Focal length in pixels, or UsageError naming the option to give.
double resolve_focal_px(const Camera &camera, const Windows &windows);

// Each value: the option, else the file's metadata, else UsageError naming the option to give. A lens of radius
// 0 (--lens-radius 0, f-number inf) needs no other value. `windows` gives the display width and pixel aspect.
ThinLens resolve_lens(const LensOptions &options, const Camera &camera, const Windows &windows);

} // namespace sparselens
