// Missing, wrong or contradictory attributes of a header give an error that names the option to use.
#include "base/error.h"
#include "io/camera/camera_header.h"
#include "io/camera/camera_headers.h"
#include "view/lens_views.h"
#include "view/resolve_lens.h"

#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sparselens {
namespace {

using namespace camera_headers;

// The error message when the lens of a header is resolved with these options.
std::string complaint(const Write &write, LensValues options = {}) {
    Imf::Header header(64, 36);
    write(header, Pose());
    try {
        resolve_lens(camera_with_options(options, read_camera(header)), windows);
        return "";
    } catch (const UsageError &error) {
        return error.what();
    }
}

// `write` with one attribute changed to a wrong value, or removed.
Write spoilt(const char *renderer, const char *attribute, std::optional<double> value) {
    const auto found =
        std::ranges::find_if(renderers(), [&](const Renderer &r) { return std::string(r.name) == renderer; });
    return [=](Imf::Header &h, const Pose &p) {
        found->write(h, p);
        h.erase(attribute);
        if (value) put(h, attribute, *value);
    };
}

TEST(CameraErrors, NameTheOptionThatIsMissing) {
    EXPECT_EQ(complaint(spoilt("standard", "focus", {})),
              "the focus distance is unknown: give `focus_distance`");
    EXPECT_EQ(complaint(spoilt("standard", "aperture", {})),
              "the aperture is unknown: give `fstop` or `lens_radius`");
    EXPECT_EQ(complaint(spoilt("standard", "pinholeFocalLength", {})),
              "the focal length is unknown: give `focal_length`");
    EXPECT_EQ(complaint(spoilt("standard", "worldToNDC", {})),
              "the sensor width is unknown: give `sensor_width`");
    LensValues with_focus;
    with_focus.focus_distance = focus;
    EXPECT_EQ(complaint(spoilt("V-Ray", "cameraFov", {}), with_focus), ""); // the film back is known
    EXPECT_EQ(complaint(spoilt("V-Ray", "cameraTransform", {}), with_focus), "");
    EXPECT_EQ(complaint(spoilt("Redshift", "rs/camera/aperture", {})),
              "the focal length is unknown: give `focal_length`");
}

// The error message about the header's projection; "" if it may be a perspective.
std::string projection_complaint(const Write &write) {
    Imf::Header header(64, 36);
    write(header, Pose());
    try {
        read_perspective_camera(header, "x.exr");
        return "";
    } catch (const Error &error) {
        return error.what();
    }
}

// No lens option makes a perspective of them.
TEST(CameraErrors, OtherProjectionsAreRefused) {
    const std::string why = "x.exr: its camera has no perspective (",
                      what_to_do =
                          "): render it with a perspective camera, or remove the attribute if it is wrong";
    for (const Renderer &renderer : renderers())
        EXPECT_EQ(projection_complaint(renderer.write), "") << renderer.name;
    // An orthographic picture 4 wide and 2.25 high: x right, y up, z forward.
    const Imath::M44d flat(0.25, 0, 0, 0, 0, -1 / 2.25, 0, 0, 0, 0, 0.01, 0, 0.5, 0.5, 0, 1);
    for (const char *name : {"worldToNDC", "NP", "dtex/np"})
        for (const bool placed : {true, false})
            for (const bool transposed : {true, false}) {
                if (transposed && !placed) continue; // undecidable without the camera's position
                EXPECT_EQ(projection_complaint([&](Imf::Header &h, const Pose &p) {
                              write_standard(h, p);
                              const Imath::M44d world_to_ndc = standard_camera(p).inverse() * flat;
                              h.erase("worldToNDC");
                              if (!placed) h.erase("worldToCamera");
                              put(h, name, transposed ? world_to_ndc.transposed() : world_to_ndc);
                          }),
                          why + name + " is orthographic" + what_to_do);
            }
    EXPECT_EQ(projection_complaint([](Imf::Header &h, const Pose &p) {
                  write_standard(h, p);
                  put(h, "worldToNDC", Imath::M44d()); // an identity matrix says nothing
              }),
              "");
    const auto vray = [](double kind) { return spoilt("V-Ray", "cameraProjection", kind); };
    EXPECT_EQ(projection_complaint(vray(0)), "");
    EXPECT_EQ(projection_complaint(vray(2)),
              why + "cameraProjection is 2, and perspective is 0" + what_to_do);
    EXPECT_EQ(projection_complaint([](Imf::Header &h, const Pose &p) {
                  write_standard(h, p);
                  Imf::addEnvmap(h, Imf::ENVMAP_LATLONG);
              }),
              why + "envmap says that it is a panorama" + what_to_do);
}

TEST(CameraErrors, NameTheAttributeThatIsWrong) {
    const auto expect = [](const char *renderer, const char *attribute, double value, const char *option) {
        LensValues options;
        if (std::string(renderer) == "V-Ray") options.focus_distance = focus;
        const std::string text = complaint(spoilt(renderer, attribute, value), options);
        EXPECT_NE(text.find(attribute), text.npos) << attribute << ": " << text;
        EXPECT_NE(text.find(std::string("give ") + option), text.npos) << attribute << ": " << text;
    };
    expect("standard", "focus", -1, "`focus_distance`");
    expect("standard", "aperture", 0, "`fstop`");
    expect("standard", "pinholeFocalLength", std::nan(""), "`focal_length`");
    expect("V-Ray", "cameraFov", 190, "`sensor_width`");
    expect("V-Ray", "cameraFocalLength", -35, "`focal_length`");
    expect("Redshift", "rs/camera/DOFFocusDistance", 0, "`focus_distance`");
    expect("Unreal", "unreal/camera/FinalImage/fstop", -2, "`fstop`");
    expect("RenderMan", "Exif:FocalLength", 0, "`focal_length`");
}

TEST(CameraErrors, NameWhatContradicts) {
    const auto both = [](const char *name, double value) {
        return [=](Imf::Header &h, const Pose &p) {
            write_standard(h, p);
            put(h, name, value);
        };
    };
    LensValues options;
    std::string text = complaint(both("cameraFocalLength", 50));
    EXPECT_NE(text.find("pinholeFocalLength says 35, cameraFocalLength says 50"), text.npos) << text;
    EXPECT_NE(text.find("give `focal_length`"), text.npos);
    EXPECT_EQ(complaint(both("cameraFocalLength", 35.1)), ""); // rounded
    options.focal_length_mm = 50;
    EXPECT_EQ(complaint(both("cameraFocalLength", 50), options), ""); // the option decides
    text = complaint(both("sparselens:sensorWidth", 36));
    EXPECT_NE(text.find("give `sensor_width`"), text.npos) << text;
    options = {};
    options.sensor_width_mm = 36;
    EXPECT_EQ(complaint(both("sparselens:sensorWidth", 36), options), "");
    text = complaint(both("cameraFov", 90));
    EXPECT_NE(text.find("worldToNDC"), text.npos) << text;
    text = complaint(both("rs/camera/DOFFocusDistance", 7));
    EXPECT_NE(text.find("focus says 6.5"), text.npos) << text;
    EXPECT_NE(text.find("give `focus_distance`"), text.npos) << text;
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
              "rim.exr: its camera is unknown (no worldToCamera): give `view=X,Y rim.exr`");
    EXPECT_EQ(why([](Imf::Header &h, const Pose &) { put(h, "worldToCamera", Imath::M44d(0.0)); }),
              "rim.exr: its camera is unknown (worldToCamera is not a valid camera position): give "
              "`view=X,Y rim.exr`");
    EXPECT_EQ(
        why([](Imf::Header &h, const Pose &) {
            put(h, "cameraTransform", standard_camera(Pose({5, 0})).inverse());
        }),
        "rim.exr: its camera is unknown (worldToCamera and cameraTransform give different positions): give "
        "`view=X,Y rim.exr`");
}

// Files that we write can be read: attributes copied from the renderer do not contradict ours.
TEST(CameraErrors, DoNotComeFromWhatTheOptionsReplaced) {
    Imf::Header header(64, 36);
    write_unreal(header, Pose(), "unreal/camera/FinalImage/", "unreal/camera/");
    LensValues options;
    options.focal_length_mm = 50;
    const Camera changed = camera_with_options(options, read_camera(header));
    write_camera(header, changed);
    const Camera again = read_camera(header);
    EXPECT_EQ(again.focal_length_mm, 50);
    EXPECT_TRUE(again.unsure.empty());
}

} // namespace
} // namespace sparselens
