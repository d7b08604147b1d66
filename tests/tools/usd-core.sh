#!/bin/bash
# Layers of USD, read by USD's own library (usd-core, PyPI): it composes what ldi-plan writes, and its frusta of cameras,
# parents, rotations and keys equal ours, at three scales of the scene.
. "$(dirname "$0")/check.sh"
python3 -c 'import ensurepip' 2>/dev/null || skip "needs python3-venv"
python3 -m venv peers
peers/bin/pip -q --disable-pip-version-check install --retries 1 usd-core >installed 2>&1 ||
    skip "usd-core: PyPI cannot be reached, or has no wheel for this Python"

# A camera with every kind of transformation above it, written by USD: as text, and as the binary that is refused.
cat >shot.py <<'END'
import sys
from pxr import Gf, Usd, UsdGeom, UsdRender
unit = float(sys.argv[1])
cm = 0.01 / unit  # a centimetre in scene units; apertures count tenths of a unit, so 1 mm is 1 at a unit of 1 cm
stage = Usd.Stage.CreateNew("shot.usda")
UsdGeom.SetStageMetersPerUnit(stage, unit)
UsdGeom.SetStageUpAxis(stage, "Z")
world = UsdGeom.Xform.Define(stage, "/World")
world.AddTranslateOp().Set(Gf.Vec3d(10 * cm, -20 * cm, 30 * cm))
turn = world.AddRotateXYZOp()
for time, angles in ((1, (10, 20, 30)), (4, (40, -10, 75))):
    turn.Set(Gf.Vec3f(*angles), time)
world.AddScaleOp().Set(Gf.Vec3f(2, 2, 2))
rig = UsdGeom.Xform.Define(stage, "/World/rig")
pivot = rig.AddTranslateOp(opSuffix="pivot")
pivot.Set(Gf.Vec3d(1 * cm, 2 * cm, 3 * cm))
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
camera.CreateFocusDistanceAttr(300 * cm)
camera.CreateClippingRangeAttr(Gf.Vec2f(1 * cm, 1e5 * cm))
settings = UsdRender.Settings.Define(stage, "/Render/settings")
settings.CreateResolutionAttr(Gf.Vec2i(640, 360))
stage.GetRootLayer().Save()
stage.Export("binary.usdc")
END
cat >compare.py <<'END'
import sys
from pxr import Gf, Sdf, Usd, UsdGeom, UsdRender
shot, views = Usd.Stage.Open("shot.usda"), Usd.Stage.Open("views.usda")
cm = 0.01 / float(sys.argv[1])
assert UsdGeom.GetStageMetersPerUnit(views) == float(sys.argv[1]) and UsdGeom.GetStageUpAxis(views) == "Z"
assert not views.GetCompositionErrors() and views.GetDefaultPrim().GetName() == "sparselens"
camera = lambda stage, path, time: UsdGeom.Camera(stage.GetPrimAtPath(path)).GetCamera(time)
corners = lambda frustum: [c for c in frustum.ComputeCorners()]
worst = 0
for time in (1, 2, 3, 4):
    own = camera(shot, "/World/rig/cam", time)
    frustum = own.frustum
    size = max(c.GetLength() for c in corners(frustum))
    ours = camera(views, "/sparselens/lens/center", time)
    # Focal length over twice the f-number; a tenth of a unit is what focalLength counts.
    radius = own.focalLength / 10 / (2 * own.fStop)
    right, up = frustum.ComputeUpVector(), frustum.ComputeUpVector()
    right = Gf.Cross(frustum.ComputeViewDirection(), up)
    for name, x, y in (("center", 0, 0), ("view_0", radius, 0), ("view_1", 0, radius), ("view_2", -radius, 0), ("view_3", 0, -radius)):
        found = camera(views, f"/sparselens/lens/{name}", time)
        assert found.fStop == 0, name
        expected = [c + right * x + up * y for c in corners(frustum)]
        far = max((a - b).GetLength() for a, b in zip(corners(found.frustum), expected)) / size
        moved = (found.frustum.position - frustum.position - right * x - up * y).GetLength() / cm
        window = found.frustum.window
        apart = max(abs(window.min[i] - frustum.window.min[i]) + abs(window.max[i] - frustum.window.max[i]) for i in (0, 1))
        worst = max(worst, far, moved, apart)
print("worst", worst)
assert worst < 1e-6, worst
settings = UsdRender.Settings.GetStageRenderSettings(views)
assert settings.GetResolutionAttr().Get() == Gf.Vec2i(640, 360)
products = [UsdRender.Product(views.GetPrimAtPath(p)) for p in settings.GetProductsRel().GetTargets()]
assert [p.GetProductNameAttr().Get(3) for p in products] == ["center.0003.exr"] + [f"view_{k}.0003.exr" for k in range(4)]
for product in products:
    assert views.GetPrimAtPath(product.GetCameraRel().GetTargets()[0]).IsA(UsdGeom.Camera)
    variables = [UsdRender.Var(views.GetPrimAtPath(p)) for p in product.GetOrderedVarsRel().GetTargets()]
    assert [(v.GetDataTypeAttr().Get(), v.GetSourceNameAttr().Get()) for v in variables] == [("color4f", "color"), ("float", "cameraDepth")]
# The layer lies over the shot.
both = Sdf.Layer.CreateAnonymous(".usda")
both.subLayerPaths = [views.GetRootLayer().identifier, shot.GetRootLayer().identifier]
stage = Usd.Stage.Open(both)
UsdGeom.SetStageMetersPerUnit(stage, float(sys.argv[1]))
UsdGeom.SetStageUpAxis(stage, "Z")
assert stage.GetPrimAtPath("/World/rig/cam") and stage.GetPrimAtPath("/sparselens/lens/view_3") and not stage.GetCompositionErrors()
# As usdcat --flatten writes it, with comments and in USD's own order.
stage.Flatten().Export("flat.usda")
END
for unit in 0.001 0.01 1; do
    rm -f ./*.usda
    peers/bin/python shot.py "$unit"
    exits 0 "$bin/ldi-plan" --camera shot.usda --cameras views.usda
    peers/bin/python compare.py "$unit" || fail "unit $unit"
    exits 0 "$bin/ldi-plan" --camera flat.usda --camera-name cam --size 640x360 --cameras again.usda
    diff <(sed /doc/d views.usda) <(sed /doc/d again.usda) >differ || fail "flattened, unit $unit: $(head -n 4 differ)"
    fails_saying 1 'binary.usdc: is binary USD; .*usdcat' "$bin/ldi-plan" --camera binary.usdc --cameras x.usda
done
# A layer that refers to another is refused until USD has flattened it.
cat >composed.py <<'END'
from pxr import Sdf, Usd
layer = Sdf.Layer.CreateNew("composed.usda")
stage = Usd.Stage.Open(layer)
stage.DefinePrim("/World").GetReferences().AddReference("shot.usda", "/World")
layer.Save()
stage.Flatten().Export("flattened.usda")
END
peers/bin/python composed.py
fails_saying 1 'composed.usda: .*references are not read; .*usdcat --flatten' "$bin/ldi-plan" --camera composed.usda --cameras x.usda --size 640x360
exits 0 "$bin/ldi-plan" --camera flattened.usda --cameras x.usda --size 640x360
