#include "io/camera/camera_headers.h"

#include <ImfFloatAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <cmath>
#include <numbers>

namespace sparselens::camera_headers {

namespace {

// Rows: the camera's axes and its position in the world.
Imath::M44d to_world(const Imath::V3d &x, const Imath::V3d &y, const Imath::V3d &z, const Imath::V3d &place) {
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, place.x, place.y, place.z, 1};
}
Imath::M44d backward_camera(const Pose &p) { return to_world(p.right, p.up, -p.forward, p.place).inverse(); }
double degrees(double field) { return 2 * std::atan(field / 2) * 180 / std::numbers::pi; }
std::string text_of(const Imath::M44d &m) {
    std::string text;
    for (int i = 0; i < 16; ++i) text += (i > 0 ? "," : "") + std::to_string(m[i / 4][i % 4]);
    return text;
}

void put_lens(Imf::Header &h) {
    put(h, "aperture", fstop);
    put(h, "focus", focus);
}

} // namespace

Imath::M44d standard_camera(const Pose &p) { return to_world(p.right, p.up, p.forward, p.place).inverse(); }

Imath::M44d projection(Ndc kind, double sign, double shift) {
    const double x = focal / film, y = x * 64 / 36;
    const Imath::M44d clip(2 * x, 0, 0, 0, 0, 2 * y, 0, 0, sign * 2 * shift, 0, sign, sign, 0, 0, -0.1, 0);
    const Imath::M44d halved(0.5, 0, 0, 0, 0, kind == Ndc::y_up ? 0.5 : -0.5, 0, 0, 0, 0, 1, 0, 0.5, 0.5, 0,
                             1);
    return kind == Ndc::clip ? clip : clip * halved;
}

void put(Imf::Header &h, const char *name, double value) {
    h.insert(name, Imf::FloatAttribute(float(value)));
}
void put(Imf::Header &h, const char *name, const Imath::M44d &m) {
    h.insert(name, Imf::M44fAttribute(Imath::M44f(m)));
}
void put(Imf::Header &h, const char *name, const std::string &text) {
    h.insert(name, Imf::StringAttribute(text));
}

void write_standard(Imf::Header &h, const Pose &p, Ndc kind, double shift) {
    put_lens(h);
    put(h, "pinholeFocalLength", focal);
    put(h, "worldToCamera", standard_camera(p));
    put(h, "worldToNDC", standard_camera(p) * projection(kind, 1, shift));
}

void write_unreal(Imf::Header &h, const Pose &p, const std::string &lens, const std::string &place) {
    // Unreal's world is left-handed: x forward, y right, z up. Yaw turns x to y, pitch x to z.
    const double pan = 0.7, tilt = -0.3, degree = 180 / std::numbers::pi;
    const auto say = [&](const std::string &name, double value) {
        put(h, name.c_str(), std::to_string(value));
    };
    say(place + "curPos/x", -p.place.z);
    say(place + "curPos/y", p.place.x);
    say(place + "curPos/z", p.place.y);
    say(place + "curRot/pitch", tilt * degree);
    say(place + "curRot/yaw", pan * degree);
    say(place + "curRot/roll", 0);
    say(lens + "focalLength", focal);
    say(lens + "sensorWidth", film);
    say(lens + "fov", degrees(film / focal));
    say(lens + "fstop", fstop);
    say(lens + "focalDistance", focus);
}

namespace {

const Renderer all_renderers[] = {
    {"standard", [](Imf::Header &h, const Pose &p) { write_standard(h, p); }},
    {"y up", [](Imf::Header &h, const Pose &p) { write_standard(h, p, Ndc::y_up); }},
    {"clip space", [](Imf::Header &h, const Pose &p) { write_standard(h, p, Ndc::clip); }},
    {"off-axis", [](Imf::Header &h, const Pose &p) { write_standard(h, p, Ndc::standard, 0.2); }},
    {"off-axis, clip space", [](Imf::Header &h, const Pose &p) { write_standard(h, p, Ndc::clip, -0.1); }},
    {"looking along -z",
     [](Imf::Header &h, const Pose &p) {
         put_lens(h);
         put(h, "pinholeFocalLength", focal);
         put(h, "worldToCamera", backward_camera(p));
         put(h, "worldToNDC", backward_camera(p) * projection(Ndc::clip, -1));
     }},
    {"stored by columns",
     [](Imf::Header &h, const Pose &p) {
         put_lens(h);
         put(h, "pinholeFocalLength", focal);
         put(h, "worldToCamera", standard_camera(p).transposed());
         put(h, "worldToNDC", (standard_camera(p) * projection(Ndc::standard, 1)).transposed());
     }},
    {"screen window",
     [](Imf::Header &h, const Pose &p) {
         put_lens(h);
         put(h, "nominalFocalLength", focal);
         put(h, "worldToCamera", standard_camera(p));
         h.screenWindowWidth() = float(film / focal);
     }},
    {"sensor",
     [](Imf::Header &h, const Pose &p) {
         put_lens(h);
         put(h, "effectiveFocalLength", focal);
         put(h, "sensorPhotositePitch", 12.25);
         h.insert("sensorAcquisitionRectangle", Imf::Box2iAttribute(Imath::Box2i({100, 100}, {2099, 1223})));
         put(h, "worldToCamera", standard_camera(p));
     }},
    {"Arnold",
     [](Imf::Header &h, const Pose &p) {
         put(h, "CameraFocalLength", focal);
         put(h, "CameraFilmApertureHorizontal", film);
         put(h, "worldToCamera", backward_camera(p));
         put(h, "worldToNDC", backward_camera(p) * projection(Ndc::clip, -1));
     },
     false, false},
    {"V-Ray",
     [](Imf::Header &h, const Pose &p) {
         put(h, "cameraFocalLength", focal);
         put(h, "cameraAperture", 36); // the picture shows a part of it
         put(h, "cameraFov", degrees(film / focal));
         put(h, "cameraFNumber", fstop);
         put(h, "cameraTransform", to_world(p.right, p.up, -p.forward, p.place));
     },
     false},
    {"V-Ray for Maya",
     [](Imf::Header &h, const Pose &p) {
         put(h, "vrayInfo/vrayversion", std::string("Version of V-Ray for Maya 3.60.04"));
         put(h, "cameraFocalLength", focal);
         put(h, "cameraFov", degrees(film / focal));
         put(h, "cameraFNumber", fstop);
         put(h, "cameraTransform", to_world(p.right, -p.forward, -p.up, p.place));
     },
     false},
    {"RenderMan",
     [](Imf::Header &h, const Pose &p) {
         put_lens(h);
         put(h, "Exif:FocalLength", focal);
         put(h, "Nl", standard_camera(p));
         put(h, "NP", standard_camera(p) * projection(Ndc::clip, 1));
     }},
    {"Redshift",
     [](Imf::Header &h, const Pose &p) {
         put(h, "rs/camera/fov", degrees(film / focal));
         h.insert("rs/camera/aperture", Imf::V2fAttribute({float(film / 25.4), 0.6f})); // inches, from Maya
         put(h, "rs/camera/FStop", fstop);
         put(h, "rs/camera/DOFFocusDistance", focus);
         put(h, "rs/camera/transform", text_of(to_world(p.right, p.up, p.forward, p.place)));
     }},
    {"Redshift, radians and mm",
     [](Imf::Header &h, const Pose &p) {
         put(h, "rs/camera/fov", degrees(film / focal) * std::numbers::pi / 180);
         h.insert("rs/camera/aperture", Imf::V2fAttribute({float(film), 18.0f}));
         put(h, "rs/camera/FStop", fstop);
         put(h, "rs/camera/DOFFocusDistance", focus);
         put(h, "rs/camera/transform", to_world(p.right, p.up, p.forward, p.place));
     }},
    {"Unreal", [](Imf::Header &h,
                  const Pose &p) { write_unreal(h, p, "unreal/camera/FinalImage/", "unreal/camera/"); }},
    {"Unreal's render graph",
     [](Imf::Header &h, const Pose &p) {
         write_unreal(h, p, "unreal/layerData/rgba/", "unreal/layerData/rgba/");
     }},
    {"Nuke",
     [](Imf::Header &h, const Pose &p) { // V-Ray's attributes after Nuke's Read and Write
         put(h, "nuke/exr/cameraFocalLength", std::to_string(focal));
         put(h, "nuke/exr/cameraFov", std::to_string(degrees(film / focal)));
         put(h, "nuke/exr/cameraFNumber", std::to_string(fstop));
         put(h, "nuke/exr/cameraTransform",
             "{" + text_of(to_world(p.right, p.up, -p.forward, p.place)) + "}");
     },
     false},
    {"OpenImageIO",
     [](Imf::Header &h, const Pose &p) {
         put(h, "Exif:FocalLength", focal);
         put(h, "Exif:FNumber", fstop);
         put(h, "Exif:SubjectDistance", focus);
         put(h, "worldtocamera", standard_camera(p));
         put(h, "worldtoscreen", standard_camera(p) * projection(Ndc::clip, 1));
     }},
};

} // namespace

std::span<const Renderer> renderers() { return all_renderers; }

} // namespace sparselens::camera_headers
