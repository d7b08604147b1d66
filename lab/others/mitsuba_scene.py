"""A scene in Mitsuba 3, rendered with Mitsuba's own pinhole and thin lens. lab/mitsuba runs it in its virtual
environment.

    python mitsuba_scene.py WIDTHxHEIGHT REFERENCE_RAYS [VARIANT]      in the folder to be filled

A round table of spheres, one of them rough metal; a grille of thin rods before them, lamps behind them, a chequered
floor and wall; light comes from a square above. Colour is radiance, Z the depth of the surface at the centre of a
pixel, with a box filter.
"""
import json
import pathlib
import sys
import time


import mitsuba
import numpy
import OpenEXR

mitsuba.set_variant("scalar_rgb")  # needs only the wheel
width, height = map(int, sys.argv[1].split("x"))
reference_rays = int(sys.argv[2])
focal_mm, sensor_mm, lens_radius, focus = 50.0, 36.0, 0.05, 5.0
eye = (0.0, 1.0, 0.0)  # it looks along +z with y up: x points to the left in the picture
rim = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]  # right, above, left, below


def diffuse(colour):
    return {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(colour)}}


def chequered(first, second, times):
    return {"type": "diffuse", "reflectance": {"type": "checkerboard", "color0": {"type": "rgb", "value": list(first)},
            "color1": {"type": "rgb", "value": list(second)}, "to_uv": mitsuba.ScalarTransform4f().scale([times, times, 1])}}


def sphere(centre, radius, material=None, light=None):
    shape = {"type": "sphere", "center": list(centre), "radius": radius}
    if light:
        shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": list(light)}, "sampling_weight": 0.15}
    shape["bsdf"] = material or diffuse((0, 0, 0))
    return shape


def rod(bottom, top, radius, material):
    return {"type": "cylinder", "p0": list(bottom), "p1": list(top), "radius": radius, "bsdf": material}


def scene_objects():
    turn = mitsuba.ScalarTransform4f()
    objects = {
        "floor": {"type": "rectangle", "to_world": turn.translate([0, 0, 10]) @ turn.rotate([1, 0, 0], -90) @ turn.scale([12, 12, 1]),
                  "bsdf": chequered((0.75, 0.7, 0.62), (0.16, 0.2, 0.26), 12)},
        "wall": {"type": "rectangle", "to_world": turn.translate([0, 4, 16]) @ turn.rotate([0, 1, 0], 180) @ turn.scale([14, 6, 1]),
                 "bsdf": chequered((0.2, 0.42, 0.6), (0.82, 0.66, 0.3), 10)},
        "square": {"type": "rectangle", "to_world": turn.translate([-2, 7, 4]) @ turn.rotate([1, 0, 0], 90) @ turn.scale([2, 2, 1]),
                   "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [14, 13, 12]}}},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.25, 0.28, 0.34]}, "sampling_weight": 0.5},
        "metal": sphere((0.15, 0.75, 5.0), 0.62, {"type": "roughconductor", "material": "Cu", "alpha": 0.12}),
        "red": sphere((-1.25, 0.5, 6.6), 0.5, diffuse((0.75, 0.12, 0.1))),
        "green": sphere((1.45, 0.42, 3.9), 0.42, chequered((0.1, 0.55, 0.2), (0.7, 0.85, 0.4), 8)),
        "far": sphere((-2.6, 1.3, 11.0), 1.3, chequered((0.9, 0.9, 0.85), (0.6, 0.15, 0.3), 6)),
    }
    iron = diffuse((0.06, 0.06, 0.07))
    for i in range(9):  # a grille near the camera, in the left half
        x = 0.08 + 0.09 * i
        objects[f"bar{i}"] = rod((x, 0, 2.3), (x + 0.02, 2, 2.3), 0.007, iron)
    for i in range(3):
        objects[f"rail{i}"] = rod((0.0, 0.7 + 0.25 * i, 2.3), (0.9, 0.7 + 0.25 * i, 2.3), 0.007, iron)
    for i in range(14):  # stalks about the focus, in the right half
        x, z = -0.5 - 0.11 * i, 4.2 + 0.9 * ((7 * i) % 5) / 2
        objects[f"stalk{i}"] = rod((x, 0, z), (x + 0.15 * ((3 * i) % 7 - 3) / 3, 1.5, z), 0.012, diffuse((0.3, 0.5, 0.15)))
    for i in range(7):  # small lamps before the wall
        objects[f"lamp{i}"] = sphere((-4.3 + 1.4 * i, 1.5 + 0.5 * ((3 * i) % 7), 14.5), 0.045, light=(60, 48, 26))
    return objects


def camera(samples, seed, offset=(0.0, 0.0), lens=False, size=None):
    origin = numpy.array(eye) + lens_radius * numpy.array([-offset[0], offset[1], 0])
    w, h = size or (width, height)
    sensor = {
        "type": "thinlens" if lens else "perspective",
        "fov": float(2 * numpy.degrees(numpy.arctan(sensor_mm / 2 / focal_mm))), "fov_axis": "x",
        "near_clip": 0.05, "far_clip": 100.0,
        "to_world": mitsuba.ScalarTransform4f().look_at(mitsuba.ScalarPoint3f(*origin), mitsuba.ScalarPoint3f(*(origin + [0, 0, 1])), mitsuba.ScalarVector3f(0, 1, 0)),
        "film": {"type": "hdrfilm", "width": w, "height": h, "pixel_format": "rgb", "component_format": "float32",
                 "rfilter": {"type": "box"}},
        "sampler": {"type": "independent", "sample_count": samples, "seed": seed},
    }
    if lens:
        sensor.update(aperture_radius=lens_radius, focus_distance=focus)
    return mitsuba.load_dict(sensor)


def guides_of(light):
    return mitsuba.load_dict({"type": "aov", "aovs": "albedo:albedo,normal:sh_normal", "light": light})


def load_scene():
    return mitsuba.load_dict({"type": "scene", **scene_objects()})


def depths(scene, sensor):
    """The Z of the surface at the centre of each pixel: unjittered rays, one by one, in the scalar variant."""
    z = numpy.full((height, width), 1e10, numpy.float32)
    for y in range(height):
        for x in range(width):
            ray, _ = sensor.sample_ray(0, 0.5, mitsuba.ScalarPoint2f((x + 0.5) / width, (y + 0.5) / height), mitsuba.ScalarPoint2f(0.5, 0.5))
            hit = scene.ray_intersect_preliminary(ray)
            if hit.is_valid():
                z[y, x] = ray.o.z + hit.t * ray.d.z - eye[2]
    return z


def write(file, pixels, z=None):
    half = numpy.clip(pixels, 0, 65000).astype(numpy.float32)
    channels = {name: numpy.ascontiguousarray(half[..., c]) for c, name in enumerate("RGB")}
    channels["A"] = numpy.ones((height, width), numpy.float32)
    if z is not None:
        channels["Z"] = z
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(str(file))


def picture(folder, name, samples, seed, offset=(0.0, 0.0), lens=False, guides=None, z=None, alone=False):
    """Renders; returns the seconds. Albedo and normals of the same rays go into folders named with `guides`."""
    sensor = camera(samples, seed, offset, lens)
    start = time.perf_counter()
    result = numpy.array(mitsuba.render(scene, sensor=sensor, integrator=guides_alone if alone else guided if guides else plain, spp=samples, seed=seed))
    seconds = time.perf_counter() - start
    pathlib.Path(folder).mkdir(exist_ok=True, parents=True)
    write(f"{folder}/{name}", result[..., :3], z)
    for first, guide in (3, "albedo"), (6, "normal"):
        if guides:
            to = pathlib.Path(guides.format(guide))
            to.mkdir(exist_ok=True, parents=True)
            kept = result[..., first:first + 3]
            # In camera axes.
            signed = kept if guide == "albedo" else numpy.stack([-kept[..., 0], kept[..., 1], -kept[..., 2]], 2)
            channels = {c: numpy.ascontiguousarray(signed[..., i].astype(numpy.float32)) for i, c in enumerate("RGB")}
            OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(str(to / name))
    return round(seconds, 3)


def note(folder, samples, seconds):
    pathlib.Path(folder, "camera.json").write_text(json.dumps({
        "renderer": "mitsuba " + mitsuba.__version__, "width": width, "height": height, "focal_mm": focal_mm, "sensor_width_mm": sensor_mm,
        "focus_distance": focus, "lens_radius": lens_radius, "views": rim, "view_spp": samples, "seconds": seconds}, indent=1) + "\n")


jobs = []
places = {"center.exr": (0.0, 0.0)} | {f"view_{k}.exr": point for k, point in enumerate(rim)}
scene = load_scene()
z_of = {name: depths(scene, camera(1, 0, place)) for name, place in places.items()}
if len(sys.argv) > 3:  # a faster variant, if a suitable LLVM is installed
    mitsuba.set_variant(sys.argv[3])
    scene = load_scene()
path = {"type": "path", "max_depth": 4}
plain = mitsuba.load_dict(path)
guided, guides_alone = guides_of(path), guides_of({"type": "path", "max_depth": 1})
for lens, guides in (False, None), (False, "warm"), (True, None), (True, "warm"):  # compiles, if the variant does
    picture("warm", "up.exr", 1, 1, lens=lens, guides=guides)
for name, place in places.items():  # noise-free albedo and normals of a pinhole
    picture("clean", name, 64, 77, place, guides="{}", alone=True)
seed = 100
for samples, folder in (16, "."), (1, "1"), (4, "4"), (64, "64"):
    seconds = {}
    for name, place in places.items():
        seed += 1
        seconds[name] = picture(folder, name, samples, seed, place, z=z_of[name])
        jobs.append(f"{folder}/{name} albedo/{name} normal/{name} clean")
    if folder == ".":
        for rays in 5, 20, 80, 320:
            file = f"drt_{rays}.exr"
            seconds[file] = picture(".", file, rays, 1000 + rays, lens=True, guides=f"traced-{rays}-{{}}")
            jobs.append(f"{file} traced-{rays}-albedo/{file} traced-{rays}-normal/{file} noisy")
            jobs.append(f"{file} albedo/center.exr normal/center.exr pinhole")
        seconds["reference.exr"] = picture(".", "reference.exr", reference_rays, 1, lens=True)
    note(folder, samples, seconds)
for rays in 60, 300:  # as two renders, to finish the views of 4 samples
    folder, seconds = f"halves-{rays}", {}
    for file in "rays_1.exr", "rays_2.exr":
        seed += 1
        seconds[file] = picture(folder, file, rays // 2, seed, lens=True, guides=folder + "/{}")
        jobs.append(f"{folder}/{file} {folder}/albedo/{file} {folder}/normal/{file} noisy")
    pathlib.Path(folder, "cost.json").write_text(json.dumps({"seconds": seconds}))
pathlib.Path("jobs").write_text("\n".join(jobs) + "\n")
