#!/usr/bin/env python3
"""Reads the cameras of a USD stage as JSON, and writes the cameras around one of them, for ldi-plan and ldi-warp.

    usd_cameras.py read STAGE [--frame N] >CAMERAS.json      then: ldi-plan --camera CAMERAS.json ...
    usd_cameras.py write STAGE <VIEWS.json >STAGE            as ldi-plan asks for it (src/io/usd/usd_views.cpp)

ldi-plan and ldi-warp run it themselves. It needs USD's library, pxr: usd-core of PyPI, or a Python that has it.

Values have USD's names and units. A frame is a time at which a camera changes, or a whole number between two such
times. An infinite number is null.
"""
import argparse
import json
import math
import pathlib
import struct
import sys
import tempfile

sys.path = [folder for folder in sys.path if folder]  # not the current folder, where anybody may have put a pxr.py
try:
    from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdRender
except ImportError:
    sys.exit(f"{sys.argv[-1]}: {sys.executable} has no pxr, the library of USD: pip install usd-core, or name another "
             "Python by SPARSELENS_USD_PYTHON")

OF_USD = ("focalLength", "focusDistance", "fStop", "horizontalAperture", "horizontalApertureOffset", "verticalAperture",
          "verticalApertureOffset", "clippingRange")
OURS = ("sparselens:fStop", "sparselens:focusDistance")  # of cameras without depth of field, whose fStop is 0
MOST_FRAMES = 100_000


class Refused(Exception):
    """A camera or a file that cannot be used."""


def words_of(error):
    """The first message of USD's library in one line."""
    return " ".join(str(error.args[0].commentary if error.args else error).split())


def shortest(value):
    """The shortest decimal number that is stored as this float: 0.36, not 0.36000001430511475."""
    if not math.isfinite(value):
        return value
    return next(short for short in (float(f"{value:.{digits}g}") for digits in range(6, 18))
                if struct.pack("f", short) == struct.pack("f", value))


def value_at(prim, name, time):
    """A number or a list of them."""
    attribute = prim.GetAttribute(name)
    if attribute.HasAuthoredConnections() and not attribute.HasAuthoredValue():
        raise Refused(f"{name} comes from a connection, which is not read: give it time samples")
    value = attribute.Get(time)
    try:
        numbers = [float(each) for each in (value if hasattr(value, "__len__") else [value])]
        if name in OF_USD:  # floats
            numbers = [shortest(each) for each in numbers]
    except (OverflowError, TypeError, ValueError):
        numbers = [math.nan]
    if any(math.isnan(each) or each == -math.inf for each in numbers):
        raise Refused(f"its {name} is not a number")
    numbers = [None if each == math.inf else each for each in numbers]
    return numbers[0] if len(numbers) == 1 else numbers


def moved_by(prim):
    """The transformations of the camera and of its parents."""
    while prim and not prim.IsPseudoRoot():
        place = UsdGeom.Xformable(prim)
        if place:
            order = [name for name in place.GetXformOpOrderAttr().Get() or [] if name != "!resetXformStack!"]
            operations = [operation.GetOpName() for operation in place.GetOrderedXformOps()]
            if missing := [name for name in order if name not in operations and not place.GetResetXformStack()]:
                raise Refused(f"xformOpOrder of {prim.GetPath()} names {missing[0]}, which is missing")
            yield from (operation.GetAttr() for operation in place.GetOrderedXformOps())
            if place.GetResetXformStack():
                return
        prim = prim.GetParent()


def times_of(attributes):
    """When they change, and the whole frames between: turns are not linear in a matrix."""
    times = set()
    for attribute in attributes:
        times.update(attribute.GetTimeSamples())
        if hasattr(attribute, "HasSpline") and attribute.HasSpline():
            times.update(attribute.GetSpline().GetKnots())
    if len(times) < 2:
        return sorted(times) or [0.0]
    first, last = min(times), max(times)
    if last - first > MOST_FRAMES:
        raise Refused(f"its keys are from {first:g} to {last:g}, over too many frames")
    return sorted(times.union(map(float, range(math.ceil(first), math.floor(last) + 1))))


def read_camera(prim, frame):
    names = [name for name in OF_USD + OURS if name in OF_USD or prim.GetAttribute(name).HasAuthoredValue()]
    attributes = [prim.GetAttribute(name) for name in names] + list(moved_by(prim))
    camera = UsdGeom.Camera(prim)
    frames = []
    for time in times_of(attributes) if frame is None else [frame]:
        to_world = [value for row in camera.ComputeLocalToWorldTransform(time) for value in row]
        if not all(map(math.isfinite, to_world)):
            raise Refused("its transformation is singular")
        frames.append({"time": time, "to_world": to_world, **{name: value_at(prim, name, time) for name in names}})
    return {"projection": camera.GetProjectionAttr().Get(), "frames": frames}


def read_settings(stage):
    """The only render settings, or those of several that the stage names."""
    found = [UsdRender.Settings(prim) for prim in stage.Traverse() if prim.IsA(UsdRender.Settings)]
    named = stage.GetMetadata("renderSettingsPrimPath") if stage.HasAuthoredMetadata("renderSettingsPrimPath") else ""
    for settings in found:
        if len(found) == 1 or str(settings.GetPath()) == named:
            size = settings.GetResolutionAttr()
            return {"path": str(settings.GetPath()),
                    "resolution": list(size.Get()) if size.HasAuthoredValue() else None,
                    "pixelAspectRatio": shortest(settings.GetPixelAspectRatioAttr().Get()),
                    "aspectRatioConformPolicy": settings.GetAspectRatioConformPolicyAttr().Get()}
    return None


def opened(file):
    try:
        return Usd.Stage.Open(file)
    except Tf.ErrorException as error:
        raise Refused(f"cannot be read as USD: {words_of(error)}") from None


def read(file, frame):
    """Also cameras that cannot be used, as another may be asked for."""
    stage = opened(file)
    cameras = []
    for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()):
        if not prim.IsA(UsdGeom.Camera):
            continue
        try:
            values = read_camera(prim, frame)
        except Tf.ErrorException as error:
            values = {"error": words_of(error)}
        except Refused as error:
            values = {"error": str(error)}
        cameras.append({"path": str(prim.GetPath()), **values})
    lacks = [" ".join(str(error).split()) for error in getattr(stage, "GetCompositionErrors", list)()]
    if not cameras:
        raise Refused("; ".join(["has no camera", *lacks[:1]]))
    return {"metersPerUnit": UsdGeom.GetStageMetersPerUnit(stage), "upAxis": UsdGeom.GetStageUpAxis(stage),
            "timeCodesPerSecond": stage.GetTimeCodesPerSecond(), "settings": read_settings(stage),
            "warnings": lacks, "cameras": cameras}


def keyed(attribute, values):
    """One value if it never changes; otherwise one for each time."""
    if all(value == values[0][1] for _, value in values):
        attribute.Set(values[0][1])
    else:
        for time, value in values:
            attribute.Set(value, time)


def usd_value(value):
    return Gf.Vec2f(value) if isinstance(value, list) else math.inf if value is None else value


def write_cameras(stage, views):
    frames = [(frame["time"], frame) for frame in views["frames"]]
    UsdGeom.Xform.Define(stage, "/sparselens")
    lens = UsdGeom.Xform.Define(stage, "/sparselens/lens")
    rows = [(time, Gf.Matrix4d(*frame["to_world"])) for time, frame in frames]
    keyed(lens.AddTransformOp().GetAttr(), rows)
    shot = opened(views["stage"]) if views["stage"] else None
    model = shot.GetPrimAtPath(views["camera"]) if shot else None
    for name, point in views["points"].items():
        camera = UsdGeom.Camera.Define(stage, f"/sparselens/lens/{name}")
        prim = camera.GetPrim()
        if model:
            copy(model, prim)
        camera.CreateProjectionAttr("perspective")
        camera.CreateFStopAttr(0.0)
        for value in frames[0][1]["camera"]:
            attribute = prim.GetAttribute(value) or prim.CreateAttribute(value, Sdf.ValueTypeNames.Double)
            keyed(attribute, [(time, usd_value(frame["camera"][value])) for time, frame in frames])
        if point:
            moves = [(time, Gf.Vec3d(*point, 0) * frame["radius"]) for time, frame in frames]
            keyed(camera.AddTranslateOp().GetAttr(), moves)


def copy(model, prim):
    """All of the model's attributes but those that are set here, with their time samples, splines and metadata."""
    schemas = model.GetMetadata("apiSchemas")
    if schemas:
        prim.SetMetadata("apiSchemas", schemas)
    for attribute in model.GetAuthoredAttributes():
        name = attribute.GetName()
        if name not in (*OF_USD, *OURS, "projection") and not name.startswith("xformOp"):
            attribute.FlattenTo(prim)


def write_settings(stage, views):
    UsdGeom.Scope.Define(stage, "/Render")
    settings = UsdRender.Settings.Define(stage, "/Render/sparselens")
    prim = settings.GetPrim()
    settings.CreateCameraRel().SetTargets(["/sparselens/lens/center"])
    prim.CreateAttribute("disableDepthOfField", Sdf.ValueTypeNames.Bool, False, Sdf.VariabilityUniform).Set(True)
    settings.CreatePixelAspectRatioAttr(views["pixel_aspect"])
    settings.CreateResolutionAttr(Gf.Vec2i(views["resolution"]))
    settings.CreateProductsRel().SetTargets([f"/Render/sparselens/{name}" for name in views["points"]])
    if views["data_window"]:
        settings.CreateDataWindowNDCAttr(Gf.Vec4f(views["data_window"]))
    for name, kind, source in (("rgba", "color4f", "color"), ("depth", "float", "cameraDepth")):
        variable = UsdRender.Var.Define(stage, f"/Render/sparselens/{name}")
        variable.CreateDataTypeAttr(kind)
        variable.CreateSourceNameAttr(source)
    for name in views["points"]:
        product = UsdRender.Product.Define(stage, f"/Render/sparselens/{name}")
        product.CreateCameraRel().SetTargets([f"/sparselens/lens/{name}"])
        product.CreateOrderedVarsRel().SetTargets(["/Render/sparselens/rgba", "/Render/sparselens/depth"])
        if not views["keyed"]:
            product.CreateProductNameAttr(f"{name}.exr")
            continue
        for time in (frame["time"] for frame in views["frames"] if frame["time"] == math.floor(frame["time"])):
            product.CreateProductNameAttr().Set(f"{name}.{int(time):04}.exr", time)


def write(views, file):
    stage = Usd.Stage.CreateInMemory()
    stage.GetRootLayer().documentation = f"The views of {views['source']}, written by ldi-plan of sparselens."
    UsdGeom.SetStageMetersPerUnit(stage, views["metersPerUnit"])
    UsdGeom.SetStageUpAxis(stage, views["upAxis"])
    if views["keyed"]:
        stage.SetStartTimeCode(views["frames"][0]["time"])
        stage.SetEndTimeCode(views["frames"][-1]["time"])
        stage.SetTimeCodesPerSecond(views["timeCodesPerSecond"])
        stage.SetFramesPerSecond(views["timeCodesPerSecond"])
    write_cameras(stage, views)
    write_settings(stage, views)
    stage.SetMetadata("renderSettingsPrimPath", "/Render/sparselens")
    stage.SetDefaultPrim(stage.GetPrimAtPath("/sparselens"))
    with tempfile.TemporaryDirectory() as folder:  # USD writes files only
        layer = pathlib.Path(folder, "views").with_suffix(pathlib.Path(file).suffix)
        try:
            stage.GetRootLayer().Export(str(layer))
        except Tf.ErrorException as error:
            raise Refused(f"cannot be written: {words_of(error)}") from None
        return layer.read_bytes()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verb", choices=("read", "write"))
    parser.add_argument("stage", metavar="STAGE")
    parser.add_argument("--frame", type=float, help="read the cameras at this time code alone")
    asked = parser.parse_args()
    try:
        if asked.verb == "read":
            json.dump(read(asked.stage, asked.frame), sys.stdout)
        else:
            sys.stdout.buffer.write(write(json.load(sys.stdin), asked.stage))
    except Refused as error:
        sys.exit(f"{asked.stage}: {error}")


if __name__ == "__main__":
    main()
