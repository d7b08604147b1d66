"""Checks how share/blender/sparselens_blender reads a plan, and its messages about scenes that it cannot render
correctly, without Blender: stand-ins for its modules suffice. tests/blender/script.sh checks the same with Blender's
own scenes.

    blender-plan.py FOLDER
"""
import importlib
import re
import sys
import types


class Anything:
    """Has every member, each of which can be called."""

    def __getattr__(self, name):
        return Anything()

    def __call__(self, *arguments, **named):
        return None


def modules_of(path):
    base = type("Base", (), {})
    sys.modules["bpy"] = types.SimpleNamespace(
        types=types.SimpleNamespace(PropertyGroup=base, Operator=base, Panel=base, AddonPreferences=base), props=Anything(), app=Anything())
    sys.modules["mathutils"] = types.SimpleNamespace(Matrix=object, Vector=object)
    sys.path.insert(0, path)
    return [importlib.import_module("sparselens_blender." + name) for name in ("views", "checks", "chain", "sub_pixels")]


def plan_of(name):
    return {"views": [{"name": name, "lens_point": [1, 0], "rectangles": [[0, 0, 9, 9], [3, 3, 4, 4]]}]}


views, checks, chain, sub_pixels = modules_of(sys.argv[1])
expected = [("view_0_0", [1, 0], [0, 0, 9, 9]), ("view_0_1", [1, 0], [3, 3, 4, 4])]
if views.views_of_plan(plan_of("view_0")) != expected:
    sys.exit(f"views_of_plan: {views.views_of_plan(plan_of('view_0'))}")
for name in "../../x", "/tmp/x", "a/b", "..", ".", "", "a\\b", "a\nb", "-x", "x" * 101, 3, None, ["a"]:
    try:
        sys.exit(f"views_of_plan takes the name {name!r}: {views.views_of_plan(plan_of(name))}")
    except ValueError as error:
        if repr(name) not in str(error):
            sys.exit(f"{name!r}: {error}")


def expect_plan(pattern, plan, size=(160, 90), supersample=1):
    try:
        views.check_plan(plan, size, supersample)
        found = ""
    except ValueError as error:
        found = str(error)
    if pattern not in found or (found and not pattern):
        sys.exit(f"check_plan: {found!r} of {plan}, in place of {pattern!r}")


window = {"display_window": [0, 0, 159, 89]}
expect_plan("", window)
expect_plan("", window, supersample=2)  # from a version that did not state it
expect_plan("", {**window, "center_supersample": 2}, supersample=2)
expect_plan("--supersample 2", {**window, "center_supersample": 2})
expect_plan("--supersample 1", {**window, "center_supersample": 1}, supersample=2)
for size in (80, 45), (320, 180), (160, 91), (161, 90):
    expect_plan("window [0, 0, 159, 89]", window, size)
expect_plan("window [1, 0, 160, 89]", {"display_window": [1, 0, 160, 89]})
expect_plan("window None", {})


def things(**members):
    return types.SimpleNamespace(**members)


def collection(name, children=(), objects=(1,), exclude=False, holdout=False):
    return things(name=name, children=children, exclude=exclude, holdout=holdout,
                  collection=things(all_objects=objects))


def thing(name, hide_render=False, is_holdout=False, nodes=()):
    material = things(node_tree=things(nodes=[things(type=kind) for kind in nodes]))
    return things(name=name, hide_render=hide_render, is_holdout=is_holdout,
                  material_slots=[things(material=None), things(material=material)])


def layer(use=True, root=None, objects=()):
    return things(use=use, layer_collection=root or collection("root"), objects=objects)


def scene(layers, engine="CYCLES", **render):
    settings = dict(use_motion_blur=False, use_border=False, resolution_x=96, resolution_y=54, resolution_percentage=50,
                    border_min_x=0.25, border_max_x=0.75, border_min_y=0.2, border_max_y=0.9)
    settings.update(render)
    return things(name="Scene", view_layers=layers, render=things(engine=engine, **settings),
                  cycles=things(use_denoising=False))


def expect(found, *patterns):
    if len(found) != len(patterns) or any(pattern not in text for pattern, text in zip(patterns, found)):
        sys.exit(f"check_scene: {found} in place of {patterns}")


def expect_refusal(scene, pattern):
    try:
        sys.exit(f"check_scene takes what {pattern!r} is to be said of: {checks.check_scene(scene)}")
    except ValueError as error:
        expect([str(error)], pattern)


expect(checks.check_scene(scene([layer(objects=[thing("plain", nodes=["BSDF_PRINCIPLED"])])])))
held = collection("outer", [collection("held", holdout=True)])
none = collection("outer", [collection("empty", objects=(), holdout=True),
                            collection("excluded", [collection("within", holdout=True)], exclude=True)])
expect(checks.check_scene(scene([layer(root=none, objects=[thing("hidden", hide_render=True, is_holdout=True)])])))
expect(checks.check_scene(scene([layer(root=held)])), "collection 'held' is a holdout")
expect(checks.check_scene(scene([layer(objects=[thing("ball", is_holdout=True)])])), "object 'ball' is a holdout")
expect(checks.check_scene(scene([layer(objects=[thing("ball", nodes=["EMISSION", "HOLDOUT"])])])),
       "object 'ball' has a holdout material")
expect(checks.check_scene(scene([layer(), layer(use=False, root=held)])))
expect(checks.check_scene(scene([layer()], use_motion_blur=True, use_border=True)),
       "motion blur", "--region 12,3,35,21") # of 48x27
expect_refusal(scene([layer(use=False)]), "no view layer of scene 'Scene'")
expect_refusal(scene([layer()], "BLENDER_WORKBENCH"), "choose Cycles or EEVEE")

# A warning that each frame gives is printed once, and then its count.
said = []
once = chain.Once(said.append)
for frame in 1, 2, 3:
    once(f"views/center.{frame:04d}.exr: {frame * 37.5} pixels have the depth of the sky")
    once(f"ldi.{frame:04d}.exr: the blur reaches {frame} pixels beyond the frame")
once.end()
if len(said) != 3 or "37.5 pixels" not in said[0] or "blur" not in said[1] or said[2] != "4 more like these, of other files":
    sys.exit(f"Once: {said}")

# Where --supersample auto takes 2: the thresholds are those of ldi-plan, and so is the share of the pixels at edges.
# Posts of 5 pixels at the disparity 4, one in 72 pixels, before a wall at 2: 4 columns of 72 are at edges.
for name, path, value in ("many_edges", "src/plan/tuning.h", sub_pixels.MANY_EDGES), (
        "torn_px", "src/kernels/surface.h", sub_pixels.TORN):
    with open(path) as file:
        found = re.search(r"\b%s = ([0-9.]+);" % name, file.read())
    if found is None or float(found[1]) != value:
        sys.exit(f"{name} is {found and found[1]} in {path}, and {value} in sub_pixels.py")


def share(nearer, farther=2.0, rows=3):
    lens = things(lens_radius=0.1, focal_pixels=100)
    return sub_pixels.share_at_edges([[10 / (nearer if 10 <= x % 72 < 15 else farther) for x in range(144)]] * rows, lens)


for found, wanted in (share(4), 4 / 72), (share(2.9), 0), (sub_pixels.share_at_edges(
        [[1.0] * 4, [0] * 4, [0] * 4], things(lens_radius=0.1, focal_pixels=100)), 2 / 3):
    if abs(found - wanted) > 1e-9:
        sys.exit(f"share_at_edges: {found}, not {wanted}")
