"""What share/blender/sparselens_views.py takes from a plan, without Blender: a stand-in for its modules is enough.

    blender-plan.py SCRIPT
"""
import importlib.util
import sys
import types


class Anything:
    """Has every member, each of which can be called."""

    def __getattr__(self, name):
        return Anything()

    def __call__(self, *arguments, **named):
        return None


def module_of(path):
    base = type("Base", (), {})
    sys.modules["bpy"] = types.SimpleNamespace(
        types=types.SimpleNamespace(PropertyGroup=base, Operator=base, Panel=base), props=Anything())
    sys.modules["mathutils"] = types.SimpleNamespace(Matrix=object)
    spec = importlib.util.spec_from_file_location("sparselens_views", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["sparselens_views"] = module
    spec.loader.exec_module(module)
    return module


def plan_of(name):
    return {"views": [{"name": name, "lens_point": [1, 0], "rectangles": [[0, 0, 9, 9], [3, 3, 4, 4]]}]}


script = module_of(sys.argv[1])
expected = [("view_0_0", [1, 0], [0, 0, 9, 9]), ("view_0_1", [1, 0], [3, 3, 4, 4])]
if script.views_of_plan(plan_of("view_0")) != expected:
    sys.exit(f"views_of_plan: {script.views_of_plan(plan_of('view_0'))}")
for name in "../../x", "/tmp/x", "a/b", "..", ".", "", "a\\b", "a\nb", "-x", "x" * 101, 3, None, ["a"]:
    try:
        sys.exit(f"views_of_plan takes the name {name!r}: {script.views_of_plan(plan_of(name))}")
    except ValueError as error:
        if repr(name) not in str(error):
            sys.exit(f"{name!r}: {error}")
