"""Tests share/python/usd_cameras.py with USD's library, by itself and from ldi-plan: usd_cameras_test.py BIN_DIR."""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from pxr import Gf, Sdf, Usd, UsdGeom, UsdRender

BIN = pathlib.Path(sys.argv.pop(1)).resolve()
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "share/python/usd_cameras.py"
os.environ["SPARSELENS_USD_PYTHON"] = sys.executable
OURS = {"focalLength", "focusDistance", "fStop", "horizontalAperture", "horizontalApertureOffset", "verticalAperture",
        "verticalApertureOffset", "clippingRange", "projection"}


def put(file, text):
    """Statements end with their line in USD's text."""
    pathlib.Path(file).write_text("#usda 1.0\n" + text.replace(" }", "\n}"))


class UsdTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        os.chdir(folder.name)

    def plan(self, *words):
        done = subprocess.run([BIN / "ldi-plan", *words], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def run_read(self, file, *words):
        return subprocess.run([sys.executable, SCRIPT, "read", *words, file], capture_output=True, text=True)

    def read(self, text, *words):
        put("shot.usda", text)
        done = self.run_read("shot.usda", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def camera(self, attributes, *words):
        return self.read(f'def Camera "c"\n{{\n{attributes}\n}}', *words)["cameras"][0]

    def refusal(self, text):
        pathlib.Path("shot.usda").write_text(text)
        done = self.run_read("shot.usda")
        self.assertNotEqual(done.returncode, 0)
        return done.stderr.splitlines()[-1]


def at(frame, point):
    return Gf.Matrix4d(*frame["to_world"]).Transform(Gf.Vec3d(*point))


class Reading(UsdTest):
    def near(self, found, expected):
        self.assertLess((Gf.Vec3d(*found) - Gf.Vec3d(*expected)).GetLength(), 1e-6, f"{found} and not {expected}")

    def test_values_are_usds_where_a_file_gives_none(self):
        camera = self.camera("")
        self.assertEqual(camera["path"], "/c")
        self.assertEqual(camera["projection"], "perspective")
        frame, = camera["frames"]
        self.assertEqual([frame[name] for name in ("focalLength", "horizontalAperture", "verticalAperture")],
                         [50, 20.955, 15.2908])  # as USD's documents have them, not rounded to float
        self.assertEqual((frame["fStop"], frame["focusDistance"], frame["clippingRange"]), (0, 0, [1, 1e6]))
        self.assertNotIn("sparselens:fStop", frame)
        stage = self.read('def Camera "c" {\n}')
        self.assertEqual((stage["metersPerUnit"], stage["upAxis"], stage["timeCodesPerSecond"]), (0.01, "Y", 24))

    def test_metadata_and_other_statements(self):
        stage = self.read('''(
    """two
lines"""
    metersPerUnit = 0.1
    upAxis = "Z"
    timeCodesPerSecond = 25
    customLayerData = { string a = ")}" }
)
# a comment
def Xform "World" ( kind = "group" )
{
    custom uniform token[] tags = ["a", 'b']
    rel material:binding = </World/m>
    def Mesh "m" { point3f[] points.timeSamples = { 0: [(1, 2, 3)], 9: [] } }
    def Camera "cam" { float focalLength = 35; float fStop.timeSamples = { 1: 2, 2.5: 4 } }
    over "Camera" { }
}
class Camera "base" { }
over Camera "changed" { }
def Camera "off" (active = false) { }''')
        self.assertEqual((stage["metersPerUnit"], stage["upAxis"], stage["timeCodesPerSecond"]), (0.1, "Z", 25))
        camera, = stage["cameras"]
        self.assertEqual(camera["path"], "/World/cam")
        self.assertEqual([(frame["time"], round(frame["fStop"], 6)) for frame in camera["frames"]],
                         [(1, 2), (2, 3.333333), (2.5, 4)])

    def test_infinite_and_own_values(self):
        own = "custom double sparselens:fStop = 2.8\n custom double sparselens:focusDistance = inf"
        frame, = self.camera(own)["frames"]
        self.assertEqual((frame["sparselens:fStop"], frame["sparselens:focusDistance"]), (2.8, None))
        self.assertIsNone(self.camera("float verticalAperture = inf")["frames"][0]["verticalAperture"])

    def test_operations_place_cameras(self):
        back, x, y, z = (0, 0, -1), (1, 0, 0), (0, 1, 0), (0, 0, 1)
        minus_x, origin, half = (-1, 0, 0), (0, 0, 0), math.sqrt(0.5)
        for operations, order, place, forward, up in (
                ("double xformOp:rotateX = 90", ["xformOp:rotateX"], origin, y, z),  # a camera of Blender, upright
                ("double xformOp:rotateY = 90", ["xformOp:rotateY"], origin, minus_x, y),
                ("double xformOp:rotateZ = 90", ["xformOp:rotateZ"], origin, back, minus_x),
                # X first, then Z: tilted up to look along y, then turned left.
                ("double3 xformOp:rotateXYZ = (90, 0, 90)", ["xformOp:rotateXYZ"], origin, minus_x, z),
                # Z first, then X: its up is turned left, then it looks along y.
                ("double3 xformOp:rotateZYX = (90, 0, 90)", ["xformOp:rotateZYX"], origin, y, minus_x),
                (f"quatd xformOp:orient = ({half}, {half}, 0, 0)", ["xformOp:orient"], origin, y, z),
                # The last operation comes first.
                ("double3 xformOp:translate = (5, 0, 0)\n double xformOp:rotateZ = 90\n"
                 " double3 xformOp:translate:b = (0, 1, 0)", ["xformOp:translate", "xformOp:rotateZ",
                                                              "xformOp:translate:b"], (4, 0, 0), back, minus_x),
                ("double3 xformOp:translate:p = (1, 2, 3)\n double3 xformOp:scale = (2, 2, 2)",
                 ["xformOp:translate:p", "xformOp:scale", "!invert!xformOp:translate:p"], (-1, -2, -3), back, y),
                ("matrix4d xformOp:transform = ((0, 0, 1, 0), (0, 1, 0, 0), (-1, 0, 0, 0), (7, 8, 9, 1))",
                 ["xformOp:transform"], (7, 8, 9), x, y),
                ("double3 xformOp:translate = (1, 2, 3)", [], origin, back, y)):  # not in the order
            with self.subTest(operations):
                frame, = self.camera(f"{operations}\n uniform token[] xformOpOrder = {json.dumps(order)}")["frames"]
                self.near(at(frame, origin), place)
                self.near((at(frame, back) - Gf.Vec3d(*place)).GetNormalized(), forward)
                self.near((at(frame, y) - Gf.Vec3d(*place)).GetNormalized(), up)

    def test_cameras_follow_their_parents(self):
        text = '''def Xform "w"
{
    double3 xformOp:translate.timeSamples = { 1: (10, 0, 0), 3: (30, 0, 0) }
    float3 xformOp:scale = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
    def Scope "s" { def Camera "c" {
        double3 xformOp:translate = (1, 2, 3)
        uniform token[] xformOpOrder = [%s"xformOp:translate"]
    } }
}'''
        frames = self.read(text % "")["cameras"][0]["frames"]
        self.assertEqual([frame["time"] for frame in frames], [1, 2, 3])
        self.near(at(frames[0], (0, 0, 0)), (12, 4, 6))
        frame, = self.read(text % '"!resetXformStack!", ')["cameras"][0]["frames"]
        self.near(at(frame, (0, 0, 0)), (1, 2, 3))

    def test_keys_are_linear_and_constant_outside(self):
        keyed = '''double3 xformOp:translate.timeSamples = { 1: (0, 0, 0), 5: (8, 4, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    float fStop = 9
    float fStop.timeSamples = { 1: 2, 5: 4 }
    float focalLength = 35'''
        for time, share in ((-3, 0), (1, 0), (2, 0.25), (4.5, 0.875), (5, 1), (9, 1)):
            frame, = self.camera(keyed, f"--frame={time}")["frames"]
            self.near(at(frame, (0, 0, 0)), (8 * share, 4 * share, 0))
            self.assertEqual((frame["fStop"], frame["focalLength"]), (2 + 2 * share, 35))
        # Rotations in quaternions turn evenly: a third of 90 degrees.
        half = math.sqrt(0.5)
        frame, = self.camera(f'''quatd xformOp:orient.timeSamples = {{ 0: (1, 0, 0, 0), 3: ({half}, 0, {half}, 0) }}
    uniform token[] xformOpOrder = ["xformOp:orient"]''', "--frame", "1")["frames"]
        self.near(at(frame, (0, 0, -1)), (-0.5, 0, -math.sqrt(0.75)))

    def test_frames_are_the_keys_and_the_whole_numbers_between(self):
        frames = self.camera("float fStop.timeSamples = { -1: 2, 1.5: 4 }")["frames"]
        self.assertEqual([frame["time"] for frame in frames], [-1, 0, 1, 1.5])
        self.assertIn("over too many frames", self.camera("float fStop.timeSamples = { 0: 2, 100001: 4 }")["error"])

    @unittest.skipUnless(hasattr(Usd.Attribute, "HasSpline"), "this release has no splines")
    def test_splines_are_followed(self):
        camera = self.camera("float fStop.spline = {\n 1: 5; post linear,\n 3: 6; post held,\n }")
        self.assertEqual([(frame["time"], frame["fStop"]) for frame in camera["frames"]], [(1, 5), (2, 5.5), (3, 6)])

    def test_render_settings(self):
        text = '''(
    renderSettingsPrimPath = "/b"
)
def Camera "c" { }
def RenderSettings "a" {
    uniform int2 resolution = (640, 360)
}
'''
        self.assertEqual(self.read(text)["settings"], {"path": "/a", "resolution": [640, 360], "pixelAspectRatio": 1,
                                                       "aspectRatioConformPolicy": "expandAperture"})
        text += '''def RenderSettings "b" {
    uniform token aspectRatioConformPolicy = "cropAperture"
    uniform float pixelAspectRatio = 1.2
}
'''
        self.assertEqual(self.read(text)["settings"], {"path": "/b", "resolution": None, "pixelAspectRatio": 1.2,
                                                       "aspectRatioConformPolicy": "cropAperture"})
        self.assertIsNone(self.read(text.replace('"/b"', '"/c"'))["settings"])

    def test_cameras_that_cannot_be_read_say_why(self):
        for attributes, why in (
                ("float focalLength.connect = </a.b>", "focalLength comes from a connection"),
                ("float fStop = nan", "fStop is not a number"),
                ('string fStop = "wide"', "fStop is not a number"),
                ('double xformOp:spin = 1\n uniform token[] xformOpOrder = ["xformOp:spin"]',
                 "Invalid xform opType token 'spin'"),
                ('uniform token[] xformOpOrder = ["xformOp:translate"]', "names xformOp:translate, which is missing"),
                ('double xformOp:rotateXYX = 1\n uniform token[] xformOpOrder = ["xformOp:rotateXYX"]', "'rotateXYX'")):
            with self.subTest(attributes):
                self.assertIn(why, self.camera(attributes)["error"])
        singular = '''double3 xformOp:scale = (0, 1, 1)
    uniform token[] xformOpOrder = ["!invert!xformOp:scale"]'''
        self.camera(singular)
        done = subprocess.run([BIN / "ldi-plan", "--camera", "shot.usda", "--size", "64x36", "--cameras", "x.usda"],
                              capture_output=True, text=True)
        self.assertIn("shot.usda: /c: its transformation is singular", done.stderr)

    def test_broken_files_are_refused_in_a_line_that_names_them(self):
        for text, why in (("#usda 1.0\n\n\ndef Camera \"c\" {", "shot.usda:4:|line 4 in"),
                          ("#usda 1.0\ndef Camera c {}", "shot.usda:2:|line 2 in"),
                          ("{}", "not a valid"), ("PXR-USDC", "shot.usda"),
                          ("#usda 1.0\ndef Xform \"w\" { }", "has no camera"),
                          ("#usda 1.0\ndef Camera \"c\" {\n float focalLength = (1, 2)\n}", "c.focalLength")):
            with self.subTest(text):
                self.assertTrue(self.refusal(text).startswith("shot.usda: "), self.refusal(text))
                self.assertRegex(self.refusal(text), why)
        self.assertIn("cannot be read as USD", self.run_read("missing.usd").stderr)

    @unittest.skipUnless(hasattr(Usd.Stage, "GetCompositionErrors"), "this release does not say")
    def test_files_that_are_not_there_are_warned_of(self):
        stage = self.read('def Camera "c" { }\n def Xform "set" ( prepend references = @set.usda@ ) { }')
        self.assertIn("set.usda", stage["warnings"][0])
        self.assertIn("set.usda", self.refusal('#usda 1.0\ndef Xform "s" ( prepend references = @set.usda@ ) { }'))
        self.read('def Camera "c" { float fStop = 2; float focusDistance = 5 }\n'
                  'def Xform "s" ( prepend references = @set.usda@ ) { }')
        self.assertIn("set.usda", self.plan("--camera", "shot.usda", "--size", "64x36", "--cameras", "x.usda"))


def written_shot(unit):
    """A camera with every kind of transformation above it, and attributes of other programs."""
    cm = 0.01 / unit  # a centimetre in scene units; apertures count tenths of a unit, so 1 mm is 1 at a unit of 1 cm
    stage = Usd.Stage.CreateNew("shot.usda")
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    UsdGeom.SetStageUpAxis(stage, "Z")
    stage.SetTimeCodesPerSecond(25)
    world = UsdGeom.Xform.Define(stage, "/World")
    world.AddTranslateOp().Set(Gf.Vec3d(10 * cm, -20 * cm, 30 * cm))
    turn = world.AddRotateXYZOp()
    for time, angles in ((1, (10, 20, 30)), (4, (40, -10, 75))):
        turn.Set(Gf.Vec3f(*angles), time)
    world.AddScaleOp().Set(Gf.Vec3f(2, 2, 2))
    rig = UsdGeom.Xform.Define(stage, "/World/rig")
    rig.AddTranslateOp(opSuffix="pivot").Set(Gf.Vec3d(1 * cm, 2 * cm, 3 * cm))
    spin = rig.AddOrientOp()
    spin.Set(Gf.Quatf(1, 0, 0, 0), 1)
    spin.Set(Gf.Quatf(0.6, 0, 0.8, 0), 4)
    rig.AddTranslateOp(opSuffix="pivot", isInverseOp=True)
    rig.AddRotateZXYOp().Set(Gf.Vec3f(5, 50, -15))
    rig.AddRotateYOp(opSuffix="more").Set(12)
    camera = UsdGeom.Camera.Define(stage, "/World/rig/cam")
    camera.AddTransformOp().Set(Gf.Matrix4d().SetRotate(Gf.Rotation(Gf.Vec3d(1, 2, 3), 25)) *
                                Gf.Matrix4d().SetTranslate(Gf.Vec3d(-4 * cm, 5 * cm, 6 * cm)))
    camera.CreateFocalLengthAttr().Set(35 * cm)
    camera.GetFocalLengthAttr().Set(35 * cm, 1)
    camera.GetFocalLengthAttr().Set(50 * cm, 4)
    camera.CreateHorizontalApertureAttr(36 * cm)
    camera.CreateVerticalApertureAttr(20.25 * cm)
    camera.CreateHorizontalApertureOffsetAttr(2.5 * cm)
    camera.CreateVerticalApertureOffsetAttr(-1.5 * cm)
    camera.CreateFStopAttr().Set(2.0)
    for time, distance in ((1, 300), (2.5, 400), (4, 250)):
        camera.CreateFocusDistanceAttr().Set(distance * cm, time)
    camera.CreateClippingRangeAttr(Gf.Vec2f(1 * cm, 1e5 * cm))
    prim = camera.GetPrim()
    prim.ApplyAPI("ColorSpaceAPI") if hasattr(Usd, "ColorSpaceAPI") else None
    camera.CreateExposureAttr().Set(0.5, 1)
    camera.GetExposureAttr().Set(-1.25, 3.5)
    camera.CreateShutterOpenAttr(-0.25)
    camera.CreateShutterCloseAttr(0.25)
    for name, values in (("exposure:iso", {None: 800.0}), ("exposure:time", {1: 0.02, 2.25: 0.01, 4: 0.04}),
                         ("exposure:responsivity", {None: 1.5})):
        attribute = prim.CreateAttribute(name, Sdf.ValueTypeNames.Float, False)
        for time, value in values.items():
            attribute.Set(value, Usd.TimeCode.Default() if time is None else time)
    note = prim.CreateAttribute("studio:note", Sdf.ValueTypeNames.String, True, Sdf.VariabilityUniform)
    note.Set("slate 12")
    note.SetDocumentation("from the set")
    grid = prim.CreateAttribute("studio:grid", Sdf.ValueTypeNames.FloatArray, True)
    grid.Set([1, 2, 3])
    UsdRender.Settings.Define(stage, "/Render/settings").CreateResolutionAttr(Gf.Vec2i(640, 360))
    stage.GetRootLayer().Save()


def others_of(prim):
    """The attributes that are not ours, with values, time samples and metadata."""
    return {a.GetName(): (str(a.GetTypeName()), a.IsCustom(), a.GetVariability(), a.GetDocumentation(),
                          [(t, a.Get(t)) for t in a.GetTimeSamples()], a.Get())
            for a in prim.GetAuthoredAttributes()
            if a.GetName() not in OURS and not a.GetName().startswith(("xformOp", "sparselens:"))}


class Rings(UsdTest):
    def compare(self, shot, path, views, unit):
        """Frusta of the ring are those of the shot, moved by the lens; other attributes are the shot's."""
        cm = 0.01 / unit
        self.assertEqual(UsdGeom.GetStageMetersPerUnit(views), unit)
        self.assertEqual(UsdGeom.GetStageUpAxis(views), "Z")
        self.assertFalse(getattr(views, "GetCompositionErrors", list)())
        self.assertEqual(views.GetDefaultPrim().GetName(), "sparselens")
        self.assertEqual((views.GetStartTimeCode(), views.GetEndTimeCode(), views.GetTimeCodesPerSecond(),
                          views.GetFramesPerSecond()), (1, 4, 25, 25))
        model = shot.GetPrimAtPath(path)
        self.assertGreaterEqual(len(others_of(model)), 8)
        for time in (1, 2, 2.5, 3, 4):
            own = UsdGeom.Camera(model).GetCamera(time)
            frustum = own.frustum
            size = max(corner.GetLength() for corner in frustum.ComputeCorners())
            # Focal length over twice the f-number; a tenth of a unit is what focalLength counts.
            radius = own.focalLength / 10 / (2 * own.fStop)
            up = frustum.ComputeUpVector()
            right = Gf.Cross(frustum.ComputeViewDirection(), up)
            for name, x, y in (("center", 0, 0), ("view_0", radius, 0), ("view_1", 0, radius), ("view_2", -radius, 0),
                               ("view_3", 0, -radius)):
                prim = views.GetPrimAtPath(f"/sparselens/lens/{name}")
                found = UsdGeom.Camera(prim).GetCamera(time)
                self.assertEqual(found.fStop, 0)
                self.assertAlmostEqual(found.focusDistance / cm, own.focusDistance / cm, 4)
                self.assertAlmostEqual(prim.GetAttribute("sparselens:focusDistance").Get(time), own.focusDistance, 4)
                self.assertAlmostEqual(prim.GetAttribute("sparselens:fStop").Get(time), 2, 6)
                moved = right * x + up * y
                for a, b in zip(found.frustum.ComputeCorners(), frustum.ComputeCorners()):
                    self.assertLess((a - b - moved).GetLength() / size, 1e-6, (name, time))
                self.assertLess((found.frustum.position - frustum.position - moved).GetLength() / cm, 1e-6)
                for i in (0, 1):
                    self.assertAlmostEqual(found.frustum.window.min[i], frustum.window.min[i], 6)
                    self.assertAlmostEqual(found.frustum.window.max[i], frustum.window.max[i], 6)
                self.assertEqual(others_of(prim), others_of(model), name)
                self.assertEqual(prim.GetAppliedSchemas(), model.GetAppliedSchemas())
        settings = UsdRender.Settings.GetStageRenderSettings(views)
        self.assertEqual(settings.GetResolutionAttr().Get(), Gf.Vec2i(640, 360))
        products = [UsdRender.Product(views.GetPrimAtPath(p)) for p in settings.GetProductsRel().GetTargets()]
        self.assertEqual([p.GetProductNameAttr().Get(3) for p in products],
                         ["center.0003.exr"] + [f"view_{k}.0003.exr" for k in range(4)])
        for product in products:
            self.assertTrue(views.GetPrimAtPath(product.GetCameraRel().GetTargets()[0]).IsA(UsdGeom.Camera))
            variables = [UsdRender.Var(views.GetPrimAtPath(p)) for p in product.GetOrderedVarsRel().GetTargets()]
            self.assertEqual([(v.GetDataTypeAttr().Get(), v.GetSourceNameAttr().Get()) for v in variables],
                             [("color4f", "color"), ("float", "cameraDepth")])

    def test_rings_have_the_frusta_and_all_attributes_of_the_shot_at_three_scales(self):
        for unit in (0.001, 0.01, 1.0):
            with self.subTest(unit):
                os.mkdir(str(unit))
                os.chdir(str(unit))
                written_shot(unit)
                self.plan("--camera", "shot.usda", "--cameras", "views.usda")
                shot, views = Usd.Stage.Open("shot.usda"), Usd.Stage.Open("views.usda")
                self.compare(shot, "/World/rig/cam", views, unit)
                # The layer lies over the shot.
                both = Sdf.Layer.CreateAnonymous(".usda")
                both.subLayerPaths = [views.GetRootLayer().identifier, shot.GetRootLayer().identifier]
                stage = Usd.Stage.Open(both)
                self.assertTrue(stage.GetPrimAtPath("/World/rig/cam"))
                self.assertTrue(stage.GetPrimAtPath("/sparselens/lens/view_3"))
                self.assertFalse(getattr(stage, "GetCompositionErrors", list)())
                # As usdcat --flatten writes it, in USD's own order.
                UsdGeom.SetStageMetersPerUnit(stage, unit)
                UsdGeom.SetStageUpAxis(stage, "Z")
                stage.SetTimeCodesPerSecond(25)
                stage.Flatten().Export("flat.usda")
                self.plan("--camera", "flat.usda", "--camera-name", "cam", "--size", "640x360",
                          "--cameras", "again.usda")
                texts = [pathlib.Path(name).read_text().splitlines() for name in ("views.usda", "again.usda")]
                self.assertEqual(*[[line for line in text if "The views of" not in line] for text in texts])
                os.chdir("..")

    def test_binary_stages_with_references_go_there_and_back(self):
        written_shot(0.01)
        Usd.Stage.Open("shot.usda").Export("asset.usdc")
        layer = Sdf.Layer.CreateNew("show.usdc")
        stage = Usd.Stage.Open(layer)
        UsdGeom.SetStageMetersPerUnit(stage, 0.01)
        UsdGeom.SetStageUpAxis(stage, "Z")
        stage.SetTimeCodesPerSecond(25)
        stage.DefinePrim("/Show").GetReferences().AddReference("asset.usdc", "/World")
        override = stage.OverridePrim("/Show/rig/cam")
        override.CreateAttribute("exposure:iso", Sdf.ValueTypeNames.Float, False).Set(1600.0)
        layer.Save()
        self.plan("--camera", "show.usdc", "--size", "640x360", "--cameras", "ring.usdc")
        views = Usd.Stage.Open("ring.usdc")
        self.assertEqual(pathlib.Path("ring.usdc").read_bytes()[:8], b"PXR-USDC")
        self.compare(stage, "/Show/rig/cam", views, 0.01)
        self.assertEqual(views.GetPrimAtPath("/sparselens/lens/view_2").GetAttribute("exposure:iso").Get(), 1600)
        # Back: the ring's centre as the shot, at all frames and at one.
        self.plan("--camera", "ring.usdc", "--cameras", "again.usd")
        self.compare(stage, "/Show/rig/cam", Usd.Stage.Open("again.usd"), 0.01)
        self.plan("--camera", "ring.usdc", "--camera-frame", "3", "--cameras", "one.usda")
        one = Usd.Stage.Open("one.usda")
        self.assertEqual(others_of(one.GetPrimAtPath("/sparselens/lens/view_0")),
                         others_of(stage.GetPrimAtPath("/Show/rig/cam")))
        # Archives and instances.
        from pxr import UsdUtils
        UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath("show.usdc"), "show.usdz")
        self.plan("--camera", "show.usdz", "--size", "640x360", "--cameras", "zipped.usda")
        self.compare(stage, "/Show/rig/cam", Usd.Stage.Open("zipped.usda"), 0.01)
        stage.GetPrimAtPath("/Show").SetInstanceable(True)
        stage.RemovePrim("/Show/rig")
        layer.Save()
        self.plan("--camera", "show.usdc", "--size", "640x360", "--cameras", "instance.usda")
        self.compare(stage, "/Show/rig/cam", Usd.Stage.Open("instance.usda"), 0.01)

    def test_time_samples_of_a_shifted_reference_are_shifted(self):
        written_shot(0.01)
        layer = Sdf.Layer.CreateNew("later.usda")
        stage = Usd.Stage.Open(layer)
        stage.SetTimeCodesPerSecond(25)
        stage.DefinePrim("/Show").GetReferences().AddReference("shot.usda", "/World", Sdf.LayerOffset(100))
        layer.Save()
        self.plan("--camera", "later.usda", "--size", "640x360", "--cameras", "views.usda")
        views = Usd.Stage.Open("views.usda")
        camera = views.GetPrimAtPath("/sparselens/lens/view_0")
        self.assertEqual(camera.GetAttribute("exposure:time").GetTimeSamples(), [101, 102.25, 104])
        self.assertEqual(camera.GetAttribute("focusDistance").GetTimeSamples(), [101, 102, 102.5, 103, 104])

    def test_variants_payloads_and_sublayers_count(self):
        put("asset.usda", 'def Xform "A" { def Camera "c" { float fStop = 4 } }')
        for text in ('def Xform "w" ( prepend references = @asset.usda@</A> ) { }',
                     'def Xform "w" ( prepend payload = @asset.usda@</A> ) { }',
                     '(\n    subLayers = [@asset.usda@]\n)',
                     'class Xform "w" { def Camera "c" { float fStop = 4 } }\n'
                     'def Xform "v" ( prepend inherits = </w> ) { }',
                     'def Xform "w" ( variants = { string v = "a" }\n prepend variantSets = "v" ) {\n'
                     'variantSet "v" = {\n'
                     '"a" { def Camera "c" { float fStop = 4 } }\n"b" { def Camera "d" { } }\n} }'):
            with self.subTest(text):
                camera, = self.read(text)["cameras"]
                self.assertTrue(camera["path"].endswith("/c"))
                self.assertEqual(camera["frames"][0]["fStop"], 4)

    def test_a_still_picture_has_no_time_samples(self):
        put("shot.usda", 'def Camera "c" { float fStop = 4; float focusDistance = inf }')
        self.plan("--camera", "shot.usda", "--size", "64x36", "--views", "1", "--cameras", "views.usda")
        text = pathlib.Path("views.usda").read_text()
        self.assertNotIn("timeSamples", text)
        self.assertNotIn("dataWindowNDC", text)
        self.assertEqual(text.count("float fStop = 0\n"), 2)
        self.assertEqual(text.count("def RenderProduct"), 2)
        self.assertEqual(text.count('token productName = "view_0.exr"'), 1)
        self.assertIn("sparselens:focusDistance = inf", text)
        self.assertIn("float focusDistance = 0\n", text)


if __name__ == "__main__":
    unittest.main()
