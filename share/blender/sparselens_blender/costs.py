"""Says what views cost, in renders through the camera's own lens."""

import math
import os
import struct

from .kept import header_of
from .views import counted


def seconds_of(header):
    """How long Blender rendered, such as 01:04.37."""
    parts = header.get("RenderTime", ("", b"0"))[1].decode().split(":")
    return sum(float(part) * 60 ** power
               for power, part in enumerate(reversed(parts)))


def share_in_picture(header):
    """The share of a view's pixels that are not overscan."""
    def area(name):
        x0, y0, x1, y1 = struct.unpack("<4i", header[name][1])
        return (x1 - x0 + 1) * (y1 - y0 + 1)

    return min(1, area("displayWindow") / area("dataWindow"))


def in_words(paths, gathering=None):
    """Returns a line that says what the views in these files cost, or an empty
    text if Blender has not written its times. A render through the lens counts
    as long as the centre view without overscan. If the seconds of gathering
    are given, the line also says from which focus on the views save time."""
    headers = [(path, header_of(path) or {}) for path in paths]
    total = sum(seconds_of(header) for _, header in headers)
    centers = [seconds_of(header) * share_in_picture(header)
               for path, header in headers
               if header and os.path.basename(path).startswith("center")]
    render = sum(centers)
    if not render:
        return ""
    words = "%s took %.1f s, as %.1f renders through the lens" % (
        counted(len(paths), "view"), total, total / render)
    if gathering is None:
        return words
    words += "; another focus takes %.1f s" % gathering
    if gathering >= render:
        return "%s, and a render %.1f s" % (words, render)
    return "%s instead of %.1f s, so the views save time from focus %d on" % (
        words, render, math.floor(total / (render - gathering)) + 1)
