// Plans on disk: the views that ldi-plan found worth rendering, as JSON and, on request, with one EXR mask per view.
//
//   {"version": 1, "center": FILE, "center_supersample": N, "display_window": [x0, y0, x1, y1], "data_window": [...],
//    "lens": {"radius": R, "focal_px": F, "focus_distance": D or null for infinity},
//    "margin": PX, "share": S, "advice": "none" | "planned" | "full", "noise_db": N or null,
//    "edges": S, "supersample": 1 | 2,
//    "rays": {"views": N, "supersample": N, "samples": N, "per_render": N, "noise_db": N or null, "alone": BOOL},
//            with a budget to divide (plan.h),
//    "moments": N, "motion": PX, if the centre views of several moments tell (block_motion.h),
//    "overscan": {"left": PX, "top": PX, "right": PX, "bottom": PX},
//    "views": [{"name": "view_0", "lens_point": [ux, uy], "position": [X, Y], "share": S, "uncovered": PIXELS,
//               "data_window": [...], "rectangles": [[x0, y0, x1, y1], ...], "mask": FILE}, ...]}
//
// Windows and rectangles are in EXR pixel coordinates, corners included. Shares are shares of one full view, except
// `edges`, a share of the centre view's pixels: if they are many, views of `supersample` times the size are worth it.
// The name of a mask (channel A, half, 1 in the pixels to render) is relative to the folder of the plan. Throws Error,
// naming the file and the problem.
#pragma once

#include "../plan/plan.h"

#include <optional>
#include <string>

namespace sparselens {

struct PlanSetting {
    std::string centre; // the file of the centre view
    Windows windows;
    ThinLens lens;
    int margin;
    int across = 1; // pixels of the centre view, across and down, per pixel of the picture
    std::optional<RayDivision> division = {}; // of a budget of rays
    std::optional<MomentsNeed> moments = {};  // of a shutter
};

// `masks` is a folder, created if missing, or empty for no masks.
void write_plan(const std::string &path, const Plan &plan, const PlanSetting &setting,
                const std::string &masks);

struct RequestedView {
    Imath::V2d u;                         // lens point
    Imath::Box2i window;                  // the smallest window with all pixels to render
    std::vector<Imath::Box2i> rectangles; // in the window
    std::string mask;                     // a file; empty: the pixels of the rectangles
};

struct PlanRequest {
    Imath::Box2i display;
    std::optional<int> across; // as in PlanSetting
    std::vector<RequestedView> views;
};

// The pixels of a view over its window. They take a byte each, so they are made for one view at a time.
PixelMask mask_of(const RequestedView &view);

PlanRequest read_plan(const std::string &path);

// The cameras of a plan on disk, as JSON or, for a spreadsheet, as CSV.
//
//   {"version": 1, "center": FILE, "lens_radius": R, "focus_distance": D or null for infinity,
//    "metres_per_unit": M or null, "screen_window": {"width": W, "center": [X, Y]},
//    "horizontal_field_degrees": A,
//    "cameras": [{"name": "view_0", "offset": [X, Y], "world_to_camera": [[4 numbers], ...] or null,
//                 "camera_to_world": ... or null}, ...]}
//
// Offsets are in scene units, x right and y up. world_to_camera is for EXR headers: x right, y up, z forward.
// camera_to_world places a camera that looks along -z. Matrices act on row vectors: the last row is the translation.
// CSV has a line of names, then a line per camera; matrices are 16 columns, empty if they are unknown.

// Data of the centre view that the file holds besides the cameras.
struct CamerasSetting {
    std::string centre;
    ThinLens lens;
    std::optional<double> metres_per_unit;
};

// Writes CSV if the name ends in .csv, JSON if it ends in .json. Throws UsageError for another name, and Error, naming
// the file, if it cannot be written.
void write_cameras(const std::string &path, const PlannedCameras &cameras, const CamerasSetting &setting);

} // namespace sparselens
