"""Planes of flat EXR files as Blender writes them, and deep EXR files, read
and written by NumPy, which is part of Blender.
"""

import os
import struct
import zlib

import numpy

from .exr import (
    DEEP, ROWS_A_CHUNK, channel_list, header_bytes, read_header)

HALF, FLOAT = 1, 2  # types of channels
DEPTHS = {HALF: "<f2", FLOAT: "<f4"}
ZIPS = 2


def unpacked(packed, size):
    """The bytes of a chunk of ZIP compression: differences of bytes, first
    the even ones and then the odd ones."""
    if len(packed) == size:
        return packed
    steps = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).copy()
    steps[1:] += 128
    whole = numpy.cumsum(steps, dtype=numpy.uint8)
    result = numpy.empty(size, numpy.uint8)
    result[0::2], result[1::2] = numpy.split(whole, [(size + 1) // 2])
    return result.tobytes()


def packed(data):
    """The opposite of unpacked(), or the data if that is not shorter."""
    data = numpy.frombuffer(data, numpy.uint8)
    steps = numpy.concatenate([data[0::2], data[1::2]])
    steps[1:] -= steps[:-1].copy() + numpy.uint8(128)
    result = zlib.compress(steps.tobytes(), 4)
    return result if len(result) < len(data) else data.tobytes()


LONG_NAMES = {"Z": ".Depth.Z"} | {of: ".Combined." + of for of in "RGBA"}


def read_planes(path, wanted):
    """The attributes of a flat EXR without compression or with that of ZIP,
    and the planes of these channels, of R, G, B, A and Z, under their plain
    names or those of multilayer files."""
    with open(path, "rb") as file:
        data = file.read()
    header, end = read_header(data)
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"][1])
    compression = header["compression"][1][0]
    if compression not in (0, 2, 3):
        raise ValueError("%s: its compression is not ZIP" % path)
    width, rows = right - left + 1, ROWS_A_CHUNK[compression]
    row = numpy.dtype([(name, DEPTHS[struct.unpack_from("<i", rest)[0]],
                        (width,)) for name, rest in channel_list(header)])
    names = [next((name for name in row.names
                   if name == plain or name.endswith(LONG_NAMES[plain])), None)
             for plain in wanted]
    if None in names:
        raise ValueError("%s: it has no channel %s" % (
            path, wanted[names.index(None)]))
    planes = [numpy.empty((bottom - top + 1, width), numpy.float32)
              for _ in names]
    for offset in struct.unpack_from(
            "<%dQ" % ((bottom - top) // rows + 1), data, end):
        y, size = struct.unpack_from("<2i", data, offset)
        count = min(rows, bottom - y + 1)
        chunk = numpy.frombuffer(unpacked(
            data[offset + 8:offset + 8 + size], count * row.itemsize), row)
        for plane, name in zip(planes, names):
            plane[y - top:y - top + count] = chunk[name]
    return header, planes


CHANNELS = (("A", HALF), ("B", HALF), ("G", HALF), ("R", HALF), ("Z", FLOAT),
            ("ZBack", FLOAT))


def deep_header(attributes, rows, most):
    """The attributes of a deep EXR of such rows, at most `most` samples in
    each pixel."""
    return attributes | {
        "channels": ("chlist", b"".join(
            name.encode() + b"\0" + struct.pack("<4i", kind, 0, 1, 1)
            for name, kind in CHANNELS) + b"\0"),
        "compression": ("compression", bytes([ZIPS])),
        "lineOrder": ("lineOrder", b"\0"),
        "type": ("string", b"deepscanline"),
        "version": ("int", struct.pack("<i", 1)),
        "chunkCount": ("int", struct.pack("<i", rows)),
        "maxSamplesPerPixel": ("int", struct.pack("<i", most))}


def write_deep(path, attributes, planes):
    """Writes a deep EXR. `planes`: for each channel of CHANNELS an array of
    [sample, y, x], the samples from front to back; those without coverage and
    light are left out. The attributes have the windows."""
    shown = numpy.logical_or.reduce([planes[name] > 0 for name in "RGBA"])
    _, rows, _ = shown.shape
    _, top, _, _ = struct.unpack("<4i", attributes["dataWindow"][1])
    header = deep_header(attributes, rows, int(shown.sum(axis=0).max()))
    start = header_bytes(struct.pack("<2i", 20000630, 2 | DEEP), header)
    at, offsets, chunks = len(start) + 8 * rows, [], []
    for y in range(rows):
        of_row = shown[:, y].T  # [x, sample]
        counts = packed(numpy.cumsum(of_row.sum(axis=1), dtype="<i4")
                        .tobytes())
        raw = b"".join(planes[name][:, y].T[of_row].astype(DEPTHS[kind])
                       .tobytes() for name, kind in CHANNELS)
        samples = packed(raw) if raw else b""
        chunk = struct.pack("<i3Q", top + y, len(counts), len(samples),
                            len(raw)) + counts + samples
        offsets.append(at)
        chunks.append(chunk)
        at += len(chunk)
    partial = path + ".partial.exr"
    try:
        with open(partial, "wb") as file:
            file.write(start + struct.pack("<%dQ" % rows, *offsets))
            file.writelines(chunks)
        os.replace(partial, path)
    finally:
        if os.path.exists(partial):
            os.remove(partial)
