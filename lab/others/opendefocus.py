"""Runs OpenDefocus on the CPU on the centre view in the current folder: python opendefocus.py PROGRAM (built from
lab/others/opendefocus)."""
import subprocess
import sys

import numpy
from common import Centre, keep_best

centre = Centre()
colour = numpy.concatenate([centre.rgb, numpy.ones((centre.height, centre.width, 1), numpy.float32)], axis=2)
colour.astype("<f4").tofile("colour.raw")


def tried(rings, larger):
    (larger * centre.radii()).astype("<f4").tofile("radii.raw")
    words = [sys.argv[1], "colour.raw", "radii.raw", "made.raw", str(centre.width), str(centre.height), str(rings)]
    seconds = float(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    made = numpy.fromfile("made.raw", "<f4").reshape(centre.height, centre.width, 4)
    return f"{rings} rings, radii x {larger}", made[..., :3], seconds


keep_best("OpenDefocus", (tried(*way) for way in ((20, 1), (20, 1.15))))
