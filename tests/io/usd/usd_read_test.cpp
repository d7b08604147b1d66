#include "base/error.h"
#include "io/usd/usd_camera.h"
#include "io/usd/usd_layer.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace sparselens {
namespace {

class UsdFiles : public testing::Test {
protected:
    ScratchFolder folder;

    std::string put(const std::string &text) {
        const std::string path = folder.file("shot.usda");
        put_contents(path, text);
        return path;
    }
    UsdLayer read(const std::string &text) { return read_usd(put("#usda 1.0\n" + text)); }
    std::string error_of(const std::string &text) {
        return what_of<Error>([&] { read(text); });
    }
    std::string camera_error(const std::string &text) {
        return what_of<Error>([&] {
            const UsdCameras usd(put("#usda 1.0\n" + text));
            film_camera(usd, usd.cameras[0], 0);
        });
    }
};

TEST_F(UsdFiles, MetadataOfTheLayerIsRead) {
    const UsdLayer layer = read(R"(( "notes" doc = """two
lines" """ metersPerUnit = 0.1 upAxis = "Z"; startTimeCode = -1 endTimeCode = 2.5 timeCodesPerSecond = 25
    customLayerData = { string a = ")}" dictionary b = { int c = 1 } } renderSettingsPrimPath = "/Render/a" ))");
    EXPECT_EQ(layer.metres_per_unit, 0.1);
    EXPECT_EQ(layer.up_axis, 'Z');
    EXPECT_EQ(layer.frames_per_second, 25);
    EXPECT_EQ(layer.render_settings, "/Render/a");
}

TEST_F(UsdFiles, WithoutMetadataTheDefaultsOfUsdHold) {
    const UsdLayer layer = read("");
    EXPECT_EQ(layer.metres_per_unit, 0.01);
    EXPECT_EQ(layer.up_axis, 'Y');
    EXPECT_EQ(layer.frames_per_second, 24);
}

TEST_F(UsdFiles, AllKindsOfStatementsAroundACameraArePassedOver) {
    const UsdLayer layer = read(R"(
# a comment, // and
/* another { */
def Xform "World" ( kind = "group" prepend apiSchemas = ["A", "B"] assetInfo = { asset identifier = @a)@ } )
{
    custom uniform token[] tags = ["a", 'b "quoted" \' '] ( doc = "x" )
    double3 xformOp:translate
    uniform token[] xformOpOrder = ["xformOp:translate"]
    rel material:binding = </World/m> (bindMaterialAs = "x")
    prepend rel other = [</a>, </b>]
    float noise.timeSamples = { 0: None, 1: 2, }
    point3f[] points.timeSamples = { 0: [(1, 2, 3), (4, 5, 6)], 1: [] }
    float spline.spline = { bezier, 1: 5; post held, 2: 6 }
    token outputs:out.connect = </World/m.outputs:x>
    reorder nameChildren = ["cam", "m"]
    def Mesh "m" { int[] n = [1, 2, 3]; asset file = @@@a@b@@@ }
    def Camera "cam" { float focalLength = 35; float fStop.timeSamples = { 1: 2, 2.5: 4 } }
    over "Camera" { }
}
class Camera "base" { }
def Camera "off" (active = false) { })");
    const auto cameras = prims_of_type(layer, "Camera");
    ASSERT_EQ(cameras.size(), 1u);
    EXPECT_EQ(text_of(cameras[0]), "/World/cam");
    const UsdPrim &camera = *cameras[0].back();
    ASSERT_TRUE(find_attribute(camera, "focalLength"));
    EXPECT_EQ(find_attribute(camera, "focalLength")->value->numbers, std::vector{35.0});
    ASSERT_TRUE(find_attribute(camera, "fStop"));
    EXPECT_EQ(find_attribute(camera, "fStop")->samples.at(2.5).numbers, std::vector{4.0});
    EXPECT_EQ(layer.root.children[0].children.size(), 1u); // the mesh is left out
    EXPECT_TRUE(find_attribute(*cameras[0][0], "xformOp:translate"));
    EXPECT_FALSE(find_attribute(*cameras[0][0], "xformOp:translate")->value);
}

TEST_F(UsdFiles, WhatIsNotTextualUsdIsRefusedWithTheWayOut) {
    const auto error = [&](const std::string &bytes) {
        return what_of<Error>([&] { read_usd(put(bytes)); });
    };
    EXPECT_TRUE(error("PXR-USDC\0\0")
                    .ends_with("shot.usda: is binary USD; convert it to text: usdcat --flatten IN "
                               "-o OUT.usda"));
    EXPECT_NE(error("PK\3\4....").find("usdcat"), std::string::npos);
    EXPECT_NE(error("{\"a\": 1}").find("is not textual USD"), std::string::npos);
}

TEST_F(UsdFiles, BrokenTextIsRefusedWithTheLine) {
    EXPECT_NE(error_of("\n\ndef Camera \"c\" {").find("shot.usda: line 4: "), std::string::npos);
    EXPECT_NE(error_of("def Camera \"c").find("a string has no end"), std::string::npos);
    EXPECT_NE(error_of("def Camera c {}").find("the name of a prim in quotes"), std::string::npos);
    EXPECT_NE(error_of("float x = 1").find("expected def, over or class"), std::string::npos);
    EXPECT_NE(error_of("def Camera \"c\" { float a = (1, 2 }").find("expected ',' or ')'"),
              std::string::npos);
    EXPECT_NE(error_of("def Camera \"c\" { float a = $ }").find("unexpected character"), std::string::npos);
    EXPECT_NE(error_of("def Camera \"c\" { float a = 1e999 }").find("out of range"), std::string::npos);
    EXPECT_NE(error_of("def Camera \"c\" { float fStop.timeSamples = { nan: 1 } }").find("a time"),
              std::string::npos);
    EXPECT_NE(error_of("def Camera \"c\" {} def Camera \"c\" {}").find("are called 'c'"), std::string::npos);
    EXPECT_NE(error_of("( metersPerUnit = 0 )").find("metersPerUnit must be above 0"), std::string::npos);
    EXPECT_NE(error_of("( upAxis = \"X\" )").find("upAxis"), std::string::npos);
    EXPECT_NE(error_of("/* ").find("a comment has no end"), std::string::npos);
}

TEST_F(UsdFiles, HaveLimits) {
    const auto nested = [](int levels, const std::string &open, const std::string &close) {
        std::string text;
        for (int i = 0; i < levels; ++i) text += open;
        for (int i = 0; i < levels; ++i) text += close;
        return text;
    };
    EXPECT_NO_THROW(read(nested(60, "def \"a\" {", "}")));
    EXPECT_NE(error_of(nested(100'000, "def \"a\" {", "}")).find("deeper than 64"), std::string::npos);
    EXPECT_NE(error_of("( a = " + nested(100'000, "[", "]")).find("deeper than 64"), std::string::npos);
    EXPECT_NE(error_of("( a = " + nested(100'000, "{", "}")).find("deeper than 64"), std::string::npos);
    std::string many;
    for (int i = 0; i <= 10'000; ++i) many += "def Camera \"c" + std::to_string(i) + "\" { }\n";
    EXPECT_NE(error_of(many).find("more than 10000"), std::string::npos);
    std::string order = "def Camera \"c\" { uniform token[] xformOpOrder = [";
    for (int i = 0; i < 17; ++i) order += "\"xformOp:scale:a\", ";
    EXPECT_NE(camera_error(order + "] float xformOp:scale:a = 1 }").find("more than 16"), std::string::npos);
}

TEST_F(UsdFiles, CompositionIsRefusedWhereItMatters) {
    const std::string camera = "{ def Camera \"c\" { } }";
    for (const char *arc : {"references = @a.usd@</b>", "payload = @a.usd@", "inherits = </b>",
                            "specializes = </b>", "variants = { string v = \"a\" }", "variantSets = \"v\""}) {
        const std::string on_parent = std::string("def Xform \"w\" ( prepend ") + arc + " ) " + camera;
        EXPECT_NE(camera_error(on_parent).find("usdcat --flatten"), std::string::npos) << arc;
        const std::string elsewhere =
            std::string("def Xform \"m\" ( ") + arc + " ) { } def Xform \"w\" " + camera;
        EXPECT_EQ(camera_error(elsewhere), "(nothing was thrown)") << arc;
        const std::string alone = std::string("def Xform \"m\" ( ") + arc + " ) { }";
        EXPECT_NE(camera_error(alone).find("has no camera of its own"), std::string::npos) << arc;
    }
    EXPECT_NE(camera_error("( subLayers = [ @a.usda@ ] ) def Xform \"w\" " + camera)
                  .find("its subLayers are not read"),
              std::string::npos);
    EXPECT_NE(
        camera_error("def Xform \"w\" { variantSet \"v\" = { \"a\" " + camera + " } }").find("variantSets"),
        std::string::npos);
    EXPECT_NE(camera_error("def Xform \"w\" { }").find("has no camera"), std::string::npos);
}

} // namespace
} // namespace sparselens
