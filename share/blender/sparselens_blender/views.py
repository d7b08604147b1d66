"""The views of a frame: names, points of the lens, and boxes of pixels."""

import math
import os
import re


def rim_points(count):
    angles = [2 * math.pi * k / count for k in range(count)]
    return [(math.cos(angle), math.sin(angle)) for angle in angles]


def spiral_points(count):
    """Points spread evenly over the lens, in the pattern of sunflower
    seeds."""
    golden = math.pi * (3 - math.sqrt(5))
    polar = [(math.sqrt((k + 0.5) / count), k * golden) for k in range(count)]
    return [(radius * math.cos(angle), radius * math.sin(angle))
            for radius, angle in polar]


def plain_name(name):
    """Checks a plan's name for a view. It becomes a file name in the output
    folder, and must not lead out of it."""
    if not isinstance(name, str) or not re.fullmatch(r"\w[\w.-]{0,99}", name):
        raise ValueError("--plan: the view %r has no plain name, such as "
                         "view_0" % (name,))
    return name


def check_plan(plan, size, supersample):
    """Refuses a plan for a picture of another size or with other sub-pixels,
    because its boxes would be misplaced."""
    window = plan.get("display_window")
    if window != [0, 0, size[0] - 1, size[1] - 1]:
        raise ValueError(
            "--plan: it was made for a picture with the window %s, and this "
            "one has %dx%d pixels: give the resolution and --supersample of "
            "its centre view" % (window, size[0], size[1]))
    of_plan = plan.get("center_supersample", supersample)
    if of_plan != supersample:
        raise ValueError("--plan: its centre view was rendered with "
                         "--supersample %s: give it here, too" % (of_plan,))


def views_of_plan(plan):
    """Names, lens points and boxes of the views in a plan of ldi-plan. The
    centre view, which the plan was made from, exists already."""
    return [("%s_%d" % (plain_name(view["name"]), number),
             view["lens_point"], box)
            for view in plan["views"]
            for number, box in enumerate(view["rectangles"])]


def views_of_lens(rim, spread):
    """The centre view, `rim` views from the rim and `spread` all over the
    lens."""
    return ([("center", (0, 0), None)]
            + [("view_%d" % k, u, None)
               for k, u in enumerate(rim_points(rim))]
            + [("lens_%04d" % k, u, None)
               for k, u in enumerate(spiral_points(spread))])


def numbered(name, frame):
    """The name with the frame's number for each run of #, but not in folders
    that exist, as the tools have it."""
    folder = os.path.dirname(name)
    while folder and not os.path.isdir(folder):
        folder = os.path.dirname(folder)
    return folder + re.sub("#+", lambda run: "%0*d" % (
        4 if len(run[0]) == 1 else len(run[0]), frame), name[len(folder):])


def counted(number, word):
    return "%d %s%s" % (number, word, "" if number == 1 else "s")
