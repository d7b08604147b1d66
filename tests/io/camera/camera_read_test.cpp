// Headers as each renderer writes them give the camera that rendered: one camera, one set of attributes a renderer.
// What is missing, wrong or contradictory is an error that names the option to give.
#include "base/error.h"
#include "io/camera/camera_metadata.h"
#include "options/lens_options.h"
#include "view/lens_views.h"

#include <ImfFloatAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace sparselens {
namespace {

// 35 mm behind a film of 24.5 mm, a picture of 64 x 36 pixels.
constexpr double focal = 35, film = 24.5, fstop = 2.8, focus = 6.5;
const Windows windows = windows_of_size(64, 36);

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

// Rows: the camera's axes and its place in the world.
Imath::M44d to_world(const Imath::V3d &x, const Imath::V3d &y, const Imath::V3d &z, const Imath::V3d &place) {
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, place.x, place.y, place.z, 1};
}
Imath::M44d standard_camera(const Pose &p) { return to_world(p.right, p.up, p.forward, p.place).inverse(); }
Imath::M44d backward_camera(const Pose &p) { return to_world(p.right, p.up, -p.forward, p.place).inverse(); }

enum class Ndc { standard, y_up, clip };
// For a camera that looks along its positive (sign 1) or negative z; shift: of the picture, in picture widths.
Imath::M44d projection(Ndc kind, double sign, double shift = 0) {
    const double x = focal / film, y = x * 64 / 36;
    const Imath::M44d clip(2 * x, 0, 0, 0, 0, 2 * y, 0, 0, sign * 2 * shift, 0, sign, sign, 0, 0, -0.1, 0);
    const Imath::M44d halved(0.5, 0, 0, 0, 0, kind == Ndc::y_up ? 0.5 : -0.5, 0, 0, 0, 0, 1, 0, 0.5, 0.5, 0,
                             1);
    return kind == Ndc::clip ? clip : clip * halved;
}

using Write = std::function<void(Imf::Header &, const Pose &)>;

void put(Imf::Header &h, const char *name, double value) {
    h.insert(name, Imf::FloatAttribute(float(value)));
}
void put(Imf::Header &h, const char *name, const Imath::M44d &m) {
    h.insert(name, Imf::M44fAttribute(Imath::M44f(m)));
}
void put(Imf::Header &h, const char *name, const std::string &text) {
    h.insert(name, Imf::StringAttribute(text));
}

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

void write_standard(Imf::Header &h, const Pose &p, Ndc kind = Ndc::standard, double shift = 0) {
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

struct Renderer {
    const char *name;
    Write write;
    bool knows_focus = true, knows_fstop = true;
};

const Renderer renderers[] = {
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
         put(h, "cameraAperture", 36); // of which the picture shows a part
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
     [](Imf::Header &h, const Pose &p) { // V-Ray's attributes that have gone through a Read and a Write
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

class CameraOf : public testing::TestWithParam<Renderer> {
protected:
    Camera camera(const Imath::V2d &offset = {0, 0}) const {
        Imf::Header header(64, 36);
        GetParam().write(header, Pose(offset));
        return read_camera(header);
    }
};

TEST_P(CameraOf, IsTheOneThatRendered) {
    const Camera read = camera();
    LensOptions options;
    if (!GetParam().knows_focus) options.focus_distance = focus;
    if (!GetParam().knows_fstop) options.fstop = fstop;
    const Camera complete = camera_with_options(options, read);
    const ThinLens lens = resolve_lens(options, complete, windows);
    EXPECT_NEAR(lens.focal_px, 64 * focal / film, 1e-3);
    EXPECT_NEAR(lens.focus, focus, 1e-5);
    EXPECT_NEAR(lens.radius, focal / 1000 / (2 * fstop) / complete.metres_per_unit.value_or(1), 1e-6);
    EXPECT_NEAR(complete.sensor_width_mm.value(), film, 1e-3);
    EXPECT_FALSE(read.found.empty());
    EXPECT_TRUE(read.unsure.empty()) << read.unsure.begin()->second;
}

TEST_P(CameraOf, StandsWhereItStood) {
    const auto place = position_relative_to(camera(), camera({0.25, -0.125}), "view");
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->x, 0.25, 1e-5);
    EXPECT_NEAR(place->y, -0.125, 1e-5);
    EXPECT_NEAR(place->z, 0, 1e-5);
}

TEST_P(CameraOf, ProjectsAsTheStandardHasIt) {
    const Camera read = camera();
    if (!read.world_to_ndc) return; // not every renderer writes one
    const Pose p;
    Imath::V3d ahead, right, below;
    read.world_to_ndc->multVecMatrix(p.place + 2.0 * p.forward, ahead);
    read.world_to_ndc->multVecMatrix(p.place + 2.0 * p.forward + p.right, right);
    read.world_to_ndc->multVecMatrix(p.place + 2.0 * p.forward - p.up, below);
    EXPECT_NEAR(right.x - ahead.x, focal / film / 2, 1e-4);
    EXPECT_NEAR(right.y, ahead.y, 1e-4);
    EXPECT_NEAR(below.y - ahead.y, focal / film * 64 / 36 / 2, 1e-4);
    EXPECT_NEAR(ahead.y, 0.5, 1e-4);
    Imath::V3d in_camera;
    read.world_to_camera->multVecMatrix(p.place + 2.0 * p.forward, in_camera);
    EXPECT_NEAR(in_camera.z, 2, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Renderers, CameraOf, testing::ValuesIn(renderers), [](const auto &renderer) {
    std::string name = renderer.param.name;
    std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
    return name;
});

// The picture moved by an eighth of its width: in NDC the axis lies at 5/8.
TEST(PrincipalPoint, IsWhereTheMatrixSendsTheAxis) {
    for (const Ndc kind : {Ndc::standard, Ndc::y_up, Ndc::clip}) {
        Imf::Header h(64, 36);
        write_standard(h, Pose(), kind, 0.125);
        const Camera camera = read_camera(h);
        ASSERT_TRUE(camera.principal_point);
        EXPECT_NEAR(camera.principal_point->x, 0.125, 1e-6);
        EXPECT_NEAR(camera.principal_point->y, 0, 1e-6);
        EXPECT_NE(camera.found.back().find("optical axis 0.125,"), std::string::npos) << camera.found.back();
        write_camera(h, camera); // as an LDI has it
        EXPECT_NEAR(read_camera(h).principal_point.value().x, 0.125, 1e-6);
    }
    // Down the picture, in its widths: a quarter of the height of 64 x 36.
    Imf::Header h(64, 36);
    write_standard(h, Pose());
    Imath::M44d move;
    move.setTranslation(Imath::V3d(0, 0.25, 0));
    put(h, "worldToNDC", standard_camera(Pose()) * projection(Ndc::standard, 1) * move);
    EXPECT_NEAR(read_camera(h).principal_point.value().y, 0.25 * 36 / 64, 1e-6);
}

// A window at depth 1 that is 0.7 wide and lies 0.07 to the right of and 0.14 above the axis.
TEST(PrincipalPoint, IsTheZeroOfTheScreenWindow) {
    Imf::Header h(64, 36);
    h.screenWindowWidth() = 0.7f;
    h.screenWindowCenter() = {0.07f, 0.14f};
    const Camera camera = read_camera(h);
    ASSERT_TRUE(camera.principal_point);
    EXPECT_NEAR(camera.principal_point->x, -0.1, 1e-6);
    EXPECT_NEAR(camera.principal_point->y, 0.2, 1e-6);
    write_standard(h, Pose(), Ndc::standard, 0.125);
    EXPECT_NEAR(read_camera(h).principal_point.value().x, 0.125, 1e-6); // the matrix knows better
    for (const float centre : {0.0f, std::nanf("")}) {
        Imf::Header silent(64, 36);
        silent.screenWindowCenter() = {centre, 0};
        EXPECT_FALSE(read_camera(silent).principal_point);
    }
}

// Rounding is no shift: nobody's pictures change for it.
TEST(PrincipalPoint, IsTheMiddleWhereNothingElseIsMeant) {
    for (const Ndc kind : {Ndc::standard, Ndc::y_up, Ndc::clip}) {
        Imf::Header h(64, 36);
        write_standard(h, Pose(), kind);
        EXPECT_EQ(read_camera(h).principal_point, Imath::V2d(0, 0));
    }
    EXPECT_FALSE(read_camera(Imf::Header(64, 36)).principal_point);
}

// What resolving the lens of a header says, with these options.
std::string complaint(const Write &write, LensOptions options = {}) {
    Imf::Header header(64, 36);
    write(header, Pose());
    try {
        resolve_lens(options, camera_with_options(options, read_camera(header)), windows);
        return "";
    } catch (const UsageError &error) {
        return error.what();
    }
}

// `write` with one attribute spoilt, or taken away.
Write spoilt(const char *renderer, const char *attribute, std::optional<double> value) {
    const auto *found = std::find_if(std::begin(renderers), std::end(renderers),
                                     [&](const Renderer &r) { return std::string(r.name) == renderer; });
    return [=](Imf::Header &h, const Pose &p) {
        found->write(h, p);
        h.erase(attribute);
        if (value) put(h, attribute, *value);
    };
}

TEST(CameraErrors, NameTheOptionThatIsMissing) {
    EXPECT_EQ(complaint(spoilt("standard", "focus", {})),
              "the focus distance is unknown: give --focus-distance");
    EXPECT_EQ(complaint(spoilt("standard", "aperture", {})),
              "the aperture is unknown: give --fstop or --lens-radius");
    EXPECT_EQ(complaint(spoilt("standard", "pinholeFocalLength", {})),
              "the focal length is unknown: give --focal-length");
    EXPECT_EQ(complaint(spoilt("standard", "worldToNDC", {})),
              "the sensor width is unknown: give --sensor-width");
    LensOptions with_focus;
    with_focus.focus_distance = focus;
    EXPECT_EQ(complaint(spoilt("V-Ray", "cameraFov", {}), with_focus), ""); // the film back is there
    EXPECT_EQ(complaint(spoilt("V-Ray", "cameraTransform", {}), with_focus), "");
    EXPECT_EQ(complaint(spoilt("Redshift", "rs/camera/aperture", {})),
              "the focal length is unknown: give --focal-length");
}

TEST(CameraErrors, NameTheAttributeThatIsWrong) {
    const auto expect = [](const char *renderer, const char *attribute, double value, const char *option) {
        LensOptions options;
        if (std::string(renderer) == "V-Ray") options.focus_distance = focus;
        const std::string text = complaint(spoilt(renderer, attribute, value), options);
        EXPECT_NE(text.find(attribute), text.npos) << attribute << ": " << text;
        EXPECT_NE(text.find(std::string("give ") + option), text.npos) << attribute << ": " << text;
    };
    expect("standard", "focus", -1, "--focus-distance");
    expect("standard", "aperture", 0, "--fstop");
    expect("standard", "pinholeFocalLength", std::nan(""), "--focal-length");
    expect("V-Ray", "cameraFov", 190, "--sensor-width");
    expect("V-Ray", "cameraFocalLength", -35, "--focal-length");
    expect("Redshift", "rs/camera/DOFFocusDistance", 0, "--focus-distance");
    expect("Unreal", "unreal/camera/FinalImage/fstop", -2, "--fstop");
    expect("RenderMan", "Exif:FocalLength", 0, "--focal-length");
}

TEST(CameraErrors, NameWhatContradicts) {
    const auto both = [](const char *name, double value) {
        return [=](Imf::Header &h, const Pose &p) {
            write_standard(h, p);
            put(h, name, value);
        };
    };
    LensOptions options;
    std::string text = complaint(both("cameraFocalLength", 50));
    EXPECT_NE(text.find("pinholeFocalLength says 35, cameraFocalLength says 50"), text.npos) << text;
    EXPECT_NE(text.find("give --focal-length"), text.npos);
    EXPECT_EQ(complaint(both("cameraFocalLength", 35.1)), ""); // rounded
    options.focal_length_mm = 50;
    EXPECT_EQ(complaint(both("cameraFocalLength", 50), options), ""); // the option settles it
    text = complaint(both("sparselens:sensorWidth", 36));
    EXPECT_NE(text.find("give --sensor-width"), text.npos) << text;
    options = {};
    options.sensor_width_mm = 36;
    EXPECT_EQ(complaint(both("sparselens:sensorWidth", 36), options), "");
    text = complaint(both("cameraFov", 90));
    EXPECT_NE(text.find("worldToNDC"), text.npos) << text;
    text = complaint(both("rs/camera/DOFFocusDistance", 7));
    EXPECT_NE(text.find("focus says 6.5"), text.npos) << text;
    EXPECT_NE(text.find("give --focus-distance"), text.npos) << text;
}

TEST(CameraErrors, OfPlacesNameView) {
    Camera centre = read_camera([] {
        Imf::Header h(64, 36);
        write_standard(h, Pose());
        return h;
    }());
    const auto why = [&](const Write &spoil) {
        Imf::Header h(64, 36);
        write_standard(h, Pose({0.25, 0}));
        spoil(h, Pose({0.25, 0}));
        const Camera view = read_camera(h);
        const std::string name = "rim.exr";
        try {
            position_on_lens({&view, 1}, {&name, 1}, centre);
            return std::string();
        } catch (const UsageError &error) {
            return std::string(error.what());
        }
    };
    const auto nothing = [](Imf::Header &, const Pose &) {};
    EXPECT_EQ(why(nothing), "");
    EXPECT_EQ(why([](Imf::Header &h, const Pose &) { h.erase("worldToCamera"); }),
              "rim.exr: its camera is unknown (no worldToCamera): give --view X,Y rim.exr");
    EXPECT_EQ(why([](Imf::Header &h, const Pose &) { put(h, "worldToCamera", Imath::M44d(0.0)); }),
              "rim.exr: its camera is unknown (worldToCamera is no placement of a camera): give --view X,Y "
              "rim.exr");
    EXPECT_EQ(why([](Imf::Header &h, const Pose &) {
                  put(h, "cameraTransform", standard_camera(Pose({5, 0})).inverse());
              }),
              "rim.exr: its camera is unknown (worldToCamera and cameraTransform place it differently): give "
              "--view "
              "X,Y rim.exr");
}

// What we write is what we read: attributes of the renderer that have come along do not speak against it.
TEST(CameraErrors, DoNotComeFromWhatTheOptionsReplaced) {
    Imf::Header header(64, 36);
    write_unreal(header, Pose(), "unreal/camera/FinalImage/", "unreal/camera/");
    LensOptions options;
    options.focal_length_mm = 50;
    const Camera changed = camera_with_options(options, read_camera(header));
    write_camera(header, changed);
    const Camera again = read_camera(header);
    EXPECT_EQ(again.focal_length_mm, 50);
    EXPECT_TRUE(again.unsure.empty());
}

} // namespace
} // namespace sparselens
