"""Attributes and channels of EXR files, read and written without a library."""

import struct


def exr_int(value):
    return "int", struct.pack("<i", value)


def exr_text(value):
    return "string", value.encode()


def exr_float(value):
    return "float", struct.pack("<f", value)


def exr_point(x, y):
    return "v2f", struct.pack("<2f", x, y)


def exr_box(x, y, width, height):
    """A window of pixels; y points down, the last pixel is included."""
    corners = x, y, x + width - 1, y + height - 1
    return "box2i", struct.pack("<4i", *corners)


def exr_matrix(matrix):
    """EXR multiplies row vectors, Blender columns: write the transpose."""
    return "m44f", struct.pack("<16f", *[x for row in matrix.transposed()
                                         for x in row])


DEEP = 0x800  # a bit of the version


def read_header(data, deep=False):
    """The attributes of a flat or deep EXR of one part, {name: (type, bytes)},
    and the position after the header."""
    magic, version = struct.unpack_from("<2i", data)
    if magic != 20000630 or version & 0x1a00 != deep * DEEP:
        raise ValueError("not a %s scanline EXR of one part"
                         % ("deep" if deep else "flat"))
    at, attributes = 8, {}
    while data[at] != 0:
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        start = type_end + 5
        end = start + struct.unpack_from("<i", data, type_end + 1)[0]
        attributes[data[at:name_end].decode()] = (
            data[name_end + 1:type_end].decode(), data[start:end])
        at = end
    return attributes, at + 1


def header_bytes(data, attributes):
    """Magic number and version as in `data`, then the attributes."""
    parts = [data[:8]]
    for name, (kind, value) in attributes.items():
        parts += [name.encode(), b"\0", kind.encode(), b"\0",
                  struct.pack("<i", len(value)), value]
    return b"".join(parts) + b"\0"


ROWS_A_CHUNK = {0: 1, 1: 1, 2: 1, 3: 16, 4: 32, 5: 16, 6: 32, 7: 32, 8: 32,
                9: 256}  # by the number of the compression


def channel_list(header):
    """Names of the channels, and the bytes after each name: 4 of type, 4 of
    flags, 8 of sampling."""
    packed, at, found = header["channels"][1], 0, []
    while packed[at] != 0:
        name_end = packed.index(b"\0", at)
        found.append((packed[at:name_end].decode(),
                      packed[name_end + 1:name_end + 17]))
        at = name_end + 17
    return found


PLAIN_NAMES = ["A", "B", "G", "R", "Z"]


def name_plainly(header):
    """If an EXR holds only colour and depth, removes the names of the view
    layer and its passes from the channels. That leaves A, B, G, R, Z, which
    are in the same order."""
    channels = channel_list(header)
    if [name.rsplit(".", 1)[-1] for name, _ in channels] != PLAIN_NAMES:
        return
    header["channels"] = "chlist", b"".join(
        plain.encode() + b"\0" + rest
        for plain, (_, rest) in zip(PLAIN_NAMES, channels)) + b"\0"
    header.pop("BlenderMultiChannel", None)


def with_attributes(data, attributes, plain=False):
    """The bytes of an EXR with these attributes added or replaced, and if
    `plain`, with plain names for its channels. The chunks are kept; their
    table of offsets moves, and their rows move with the data window."""
    header, end = read_header(data)
    if plain:
        name_plainly(header)
    _, top, _, bottom = struct.unpack("<4i", header["dataWindow"][1])
    rows = ROWS_A_CHUNK[header["compression"][1][0]]
    count = (bottom - top) // rows + 1
    header.update(attributes)
    down = struct.unpack("<4i", header["dataWindow"][1])[1] - top

    start = header_bytes(data, header)
    moved = len(start) - end
    offsets = struct.unpack_from("<%dQ" % count, data, end)
    result = bytearray(start + data[end:])
    struct.pack_into("<%dQ" % count, result, len(start),
                     *[offset + moved for offset in offsets])
    for offset in offsets:
        row = struct.unpack_from("<i", data, offset)[0]
        struct.pack_into("<i", result, offset + moved, row + down)
    return bytes(result)


def depth_rows(data):
    """The depth rows of an uncompressed EXR, from the top."""
    header, end = read_header(data)
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"][1])
    before = 0
    for name, rest in channel_list(header):
        if name == "Z" or name.endswith(".Depth.Z"):
            break
        before += 2 if struct.unpack_from("<i", rest)[0] == 1 else 4
    else:
        raise ValueError("an EXR without depth")
    width = right - left + 1
    offsets = struct.unpack_from("<%dQ" % (bottom - top + 1), data, end)
    return [struct.unpack_from("<%df" % width, data,
                               offset + 8 + before * width)
            for offset in offsets]
