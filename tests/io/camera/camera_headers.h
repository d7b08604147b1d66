// Headers as each renderer writes them: one camera, with one set of attributes per renderer.
#pragma once

#include "base/image.h"

#include <Imath/ImathVec.h>
#include <ImfHeader.h>
#include <ImfMatrixAttribute.h>

#include <functional>
#include <span>
#include <string>

namespace sparselens::camera_headers {

// A 35 mm lens before a film of 24.5 mm, and a picture of 64 x 36 pixels.
inline constexpr double focal = 35, film = 24.5, fstop = 2.8, focus = 6.5;
inline const Windows windows = windows_of_size(64, 36);

// A camera in a right-handed world with y up, and the same one moved `offset` to the right and up.
struct Pose {
    Imath::V3d right, up, forward, place;
    explicit Pose(const Imath::V2d &offset = {0, 0}) {
        const double pan = 0.7, tilt = -0.3;
        forward = {std::cos(tilt) * std::sin(pan), std::sin(tilt), -std::cos(tilt) * std::cos(pan)};
        right = Imath::V3d(std::cos(pan), 0, std::sin(pan));
        up = right.cross(forward);
        place = Imath::V3d(3, 4, -5) + offset.x * right + offset.y * up;
    }
};

// Rows of the matrix: the camera's axes, looking forward, and its position in the world.
Imath::M44d standard_camera(const Pose &p);

enum class Ndc { standard, y_up, clip };
// For a camera that looks along its positive (sign 1) or negative z. `shift`: of the picture, in picture widths.
Imath::M44d projection(Ndc kind, double sign, double shift = 0);

void put(Imf::Header &h, const char *name, double value);
void put(Imf::Header &h, const char *name, const Imath::M44d &m);
void put(Imf::Header &h, const char *name, const std::string &text);

void write_standard(Imf::Header &h, const Pose &p, Ndc kind = Ndc::standard, double shift = 0);
void write_unreal(Imf::Header &h, const Pose &p, const std::string &lens, const std::string &place);

using Write = std::function<void(Imf::Header &, const Pose &)>;

struct Renderer {
    const char *name;
    Write write;
    bool knows_focus = true, knows_fstop = true;
};
std::span<const Renderer> renderers();

} // namespace sparselens::camera_headers
