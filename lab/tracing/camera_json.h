// camera.json, which accompanies the pictures of dof-trace and ready-made ones.
#pragma once

#include <Imath/ImathVec.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sparselens::lab {

// A finished picture beside the views, made in another way or with another budget.
struct OtherPicture {
    std::string file, renderer, processor, budget;
    double rays = 0; // camera samples per pixel
};

struct CameraSummary {
    int width = 0, height = 0;
    double focal_mm = 0, sensor_width_mm = 0, focus_distance = 0, lens_radius = 0;
    std::vector<Imath::V2d> views;         // lens points of view_0.exr, ..., unit disc, y up
    int view_samples = 0;                  // per pixel of the picture
    int supersample = 1;                   // pixels of views, across and down, per pixel of the picture
    std::map<std::string, double> seconds; // the render time of each picture
    std::vector<OtherPicture> others;      // only in ready-made folders; "others" may be missing
};

// Reads the camera.json in that folder. Throws Error, naming the file, if it is missing or invalid.
CameraSummary read_camera_summary(const std::filesystem::path &folder);

} // namespace sparselens::lab
