"""Compares a finished picture with its parents, block by block: blocks.py NAME REF_1 REF_2 FINISHED PARENT...

The references share no noise, so the mean of the products of a picture's differences from both is its error without
theirs. An error counts as at least half a step of a display of 8 bits, and as the noise of the references. Prints a row
of Markdown, and adds the blocks to the file `blocks`: how many there are, and how many have more than twice the least
error of the parents.
"""
import sys

import numpy
import OpenEXR

side, half_step = 16, (0.5 / 255) ** 2


def tone_mapped(path):
    with OpenEXR.File(path, separate_channels=True) as file:
        channels, header = file.channels(), file.header()
        rgb = numpy.stack([channels[c].pixels for c in "RGB"], axis=2).astype(numpy.float64)
        (x0, y0), (x1, y1) = header["displayWindow"]
        left, top = header["dataWindow"][0]
    rgb = rgb[y0 - top : y1 - top + 1, x0 - left : x1 - left + 1].clip(0, None)
    return rgb / (1 + rgb)


def blocks(error):
    rows, columns = error.shape[0] // side, error.shape[1] // side
    return error[: rows * side, : columns * side].reshape(rows, side, columns, side, 3).mean(axis=(1, 3, 4))


name, first, second, *pictures = sys.argv[1:]
first, second = tone_mapped(first), tone_mapped(second)
errors = [(p - first) * (p - second) for p in map(tone_mapped, pictures)]
floor = numpy.maximum(blocks((first - second) ** 2) / 4, half_step)
finished, *parents = [numpy.maximum(blocks(e), floor) for e in errors]
ratio = finished / numpy.min(parents, axis=0)
whole = [-10 * numpy.log10(max(e.mean(), 1e-9)) for e in errors]
worst = numpy.unravel_index(ratio.argmax(), ratio.shape)
denoised = f"{max(whole[3:]):.2f}" if whole[3:] else ""
print(f"| {name} | {whole[1]:.2f} | {whole[2]:.2f} | {denoised} | {whole[0]:.2f} | {whole[0] - max(whole[1:]):+.2f} |"
      f" {(ratio > 2).sum()} of {ratio.size} | {ratio.max():.1f} at {worst[1] * side},{worst[0] * side} |")
with open("blocks", "a") as file:
    print(ratio.size, (ratio > 2).sum(), file=file)
