"""The input for programs that make depth of field of a centre view and its depths, and the record of their results."""
import json
import pathlib
import subprocess

import numpy
import OpenEXR


class Centre:
    """The centre view in the current folder."""

    def __init__(self):
        self.camera = json.loads(pathlib.Path("camera.json").read_text())
        with OpenEXR.File("center.exr", separate_channels=True) as file:
            channels = file.channels()
            names = [*"RGB"] + ["Z" if "Z" in channels else "ViewLayer.Depth.Z"]
            *colour, depth = (channels[name].pixels.astype(numpy.float32) for name in names)
        self.rgb = numpy.stack(colour, axis=2)
        self.z = numpy.where(numpy.isfinite(depth), depth, 1e10)
        self.height, self.width = depth.shape

    def radii(self):
        """Radii of circles of confusion, in pixels, positive before the focus."""
        camera = self.camera
        focal_pixels = self.width * camera["focal_mm"] / camera["sensor_width_mm"]
        return (camera["lens_radius"] * focal_pixels * (1 / self.z - 1 / camera["focus_distance"])).astype(numpy.float32)


def write(path, rgb):
    channels = {name: numpy.ascontiguousarray(rgb[..., c], dtype=numpy.float32) for c, name in enumerate("RGB")}
    channels["A"] = numpy.ones(rgb.shape[:2], numpy.float32)
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(path)


def quality(path):
    said = subprocess.run(["dof-compare", path, "reference.exr", "--json"], capture_output=True, text=True, check=True).stdout
    return json.loads(said)["psnr_tonemapped"]


def keep_best(name, tries):
    """Keeps, as a row, the picture nearest to the reference among the tries (what was asked, picture, seconds):
    by_NAME.exr."""
    best = None
    for asked, rgb, seconds in tries:
        write("try.exr", rgb)
        db = quality("try.exr")
        print(f"{name}, {asked}: {db:.2f} dB, {seconds:.2f} s", flush=True)
        if best is None or db > best[0]:
            best = db, asked, seconds
            pathlib.Path("try.exr").replace(f"by_{name}.exr")
    pathlib.Path("try.exr").unlink(missing_ok=True)
    db, asked, seconds = best
    camera = json.loads(pathlib.Path("camera.json").read_text())
    samples = camera["view_spp"]
    camera["seconds"][f"by_{name}.exr"] = round(camera["seconds"]["center.exr"] + seconds, 3)
    row = {"file": f"by_{name}.exr", "renderer": "one view", "processor": f"{name} ({asked})",
           "budget": f"{samples} samples", "rays": samples}
    camera["others"] = [o for o in camera.get("others", []) if o["file"] != row["file"]] + [row]
    pathlib.Path("camera.json").write_text(json.dumps(camera, indent=1) + "\n")
