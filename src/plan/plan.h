// What is worth rendering in addition to the centre view, derived from the centre view and the lens.
#pragma once

#include "../base/progress.h"
#include "../view/view.h"
#include "disocclusion.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct PlanOptions {
    int views = 4;  // the largest number of views
    int margin = 2; // pixels around what the centre view misses; edges are told apart from both sides
    std::optional<double> noise = {}; // standard deviation of a pixel's noise, tone-mapped; empty: measured
    int across = 1;                   // pixels of the centre view, across and down, per pixel of the picture
};

struct PlannedView {
    Imath::V2d u; // lens point
    PixelMask mask;
    std::size_t uncovered = 0; // pixels that something nearer hides from the centre view, without the margin
};

// The pixels beyond each border from which the lens brings light inside: the largest CoC along that border.
struct OverscanNeed {
    int left = 0, top = 0, right = 0, bottom = 0;
};

struct Plan {
    std::vector<PlannedView> views; // empty: the centre view is enough
    OverscanNeed overscan;
    double noise = 0;      // mean square, tone-mapped, in the lens picture of the centre view alone (noise.h)
    std::size_t noisy = 0; // pixels of the centre view that are asked for again, as further samples
    bool full_views = false; // noise is the larger error: whole views are worth it as further samples
    double edges =
        0; // share of pixels of the centre view beside a jump of depth: surfaces are torn (kernels/surface.h)
    int supersample =
        1; // factor on the views' size that is worth it for the same rays; 1 if the centre view has sub-pixels

    double share() const; // all views together, as a share of one full view
};

// How many moments of a shutter a picture with motion blur needs (block_motion.h).
struct MomentsNeed {
    double motion = 0; // how far things move while the shutter is open, pixels of the picture
    int moments = 1;   // 1: the blur of this motion does not show
};

// The candidates are eight or more views, spaced evenly on the rim. The even ring of `views` of them, which begins at
// the right, is taken unless others uncover noticeably more; views that add nothing are left out. `centre` stands at
// the origin.
Plan make_plan(const View &centre, const ThinLens &lens, const PlanOptions &options, Progress &progress);

// The cameras that take the centre view and the views of a plan, in numbers that a person or a script can give to any
// renderer. All cameras look in the same direction as the centre camera and have its screen window.

// The part of the plane at depth 1 that the display window shows, as in OpenEXR: its width, and its centre relative to
// the optical axis; x right, y up.
struct ScreenWindow {
    double width = 1; // (0, inf)
    Imath::V2d centre{0, 0};
};

struct PlannedCamera {
    std::string name;                           // center, view_0, ...
    Imath::V2d offset{0, 0};                    // from the centre camera, scene units, x right, y up
    std::optional<Imath::M44d> world_to_camera; // as in Camera; empty if the centre's is unknown
};

struct PlannedCameras {
    ScreenWindow window;
    std::vector<PlannedCamera> cameras; // the centre camera first
};

// `camera` and `lens` are the centre view's, `display_width` is its width in pixels.
PlannedCameras cameras_of(const Plan &plan, const Camera &camera, const ThinLens &lens, int display_width);

// The placement of a camera that looks along -z, as in Maya, Houdini, USD and Blender: x right, y up. The rows are the
// axes and the position in world space.
Imath::M44d camera_to_world_looking_back(const Imath::M44d &world_to_camera);

// Divides a budget of rays between views, which are gathered, and two renders through the lens, which finish the picture.
//
// The first rays go into the views, because a gathered picture of few rays has less error than as many rays through the
// lens. Its error soon stops falling. The error of rays does not, so all further rays go through the lens. Where the
// noise of all rays through the lens is small, views add nothing to one render of them.

// Counts rays for each pixel of the picture.
struct RayDivision {
    int views = 1;       // number of views, the centre view included
    int supersample = 1; // times the size of the picture at which views are rendered
    int samples = 1;     // samples of each pixel of a view
    int per_render = 0;  // rays of each of the two renders through the lens; 0: views alone
    double noise = 0;    // of one render of all rays through the lens: mean square, tone-mapped
    bool alone = false;  // that one render has less error than this division

    int of_views() const { return views * samples * supersample * supersample; }
};

// `rays`: all rays of a pixel. `views`: how many are worth rendering, the centre view included. `supersample`: the size
// at which they are; a view with fewer rays than its pixels at that size is rendered at the size of the picture.
// `noise`: as in RayDivision. The division has at most `rays` rays. Throws UsageError if `rays` are fewer than `views`.
RayDivision divide_rays(int rays, int views, int supersample, double noise);

} // namespace sparselens
