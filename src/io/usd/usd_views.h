// Writes the cameras of the centre view and the rim views as a layer of USD, with render products, so that any renderer
// of USD takes the views (UsdGeomCamera, UsdRender). The script of usd_script.h does so.
//
//   /sparselens/lens                   the place of the lens, keyed
//   /sparselens/lens/center, view_0    cameras without depth of field (fStop 0); rim cameras are moved right and up
//   /Render/sparselens                 settings: size of the picture, one product per camera, colour and planar depth
//
// Cameras keep the lens as sparselens:fStop and sparselens:focusDistance, so that film_camera() finds it again; and all
// other attributes of the camera that they are made of (exposure, shutter:open, custom ones), with their time samples.
#pragma once

#include "base/image.h"
#include "lens/thin_lens.h"
#include "view/view.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <map>
#include <string>
#include <vector>

namespace sparselens {

// The lens at one time. Lengths are in scene units, unless they are named mm.
struct UsdLensFrame {
    Imath::M44d to_world; // of a camera that looks along -z; without scale
    double focal_length_mm = 1, film_width_mm = 1;
    Imath::V2d offset_mm{0, 0}; // of the film's middle from the optical axis, x right, y up
    double radius = 0;          // of the aperture
    double fstop = 1, focus_distance = 1;
    Imath::V2d clipping{1, 1e6}; // near and far plane
    bool mirrored = false;       // the world was left-handed, which USD has not: z changed its sign
};

struct UsdViews {
    std::string source;         // what they were made of, for readers
    std::string stage, camera;  // whose other attributes they have; or empty
    double metres_per_unit = 1; // of all frames
    char up_axis = 'Y';
    double frames_per_second = 24;
    Windows windows;                       // of the picture
    std::vector<Imath::V2d> lens_points;   // of the rim views, in the unit disc
    std::map<double, UsdLensFrame> frames; // by time code; without `keyed`, one
    bool keyed = false;
};

// The lens of a camera whose position, frustum and lens are known. Throws Error, naming `file`, if its position is
// unknown.
UsdLensFrame usd_lens_frame(const Camera &camera, const ThinLens &lens, int display_width,
                            const std::string &file);

// Adds the lens points that are not there yet.
void add_lens_points(UsdViews &views, const std::vector<Imath::V2d> &points);

// The views as the script takes them: JSON, with the values of cameras by their names in USD.
std::string usd_views_json(const UsdViews &views);

// Writes the layer (.usda, .usdc, .usd); it appears complete or not at all (OutputFile). Throws Error, naming it, if it cannot be
// written.
void write_usd_views(const std::string &path, const UsdViews &views);

} // namespace sparselens
