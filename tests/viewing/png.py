"""Reads a PNG file of 8 bits, RGB or RGBA, with only the rules of its specification and zlib."""
import struct
import zlib


def read_png(path):
    """Returns width, height, channels, bytes."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", body[:10])
            assert bits == 8 and colour in (2, 6) and body[12] == 0, path
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    channels = 3 if colour == 2 else 4
    return width, height, channels, unfiltered(zlib.decompress(packed), width * channels, height, channels)


def unfiltered(data, in_row, height, channels):
    out, above = bytearray(), bytearray(in_row)
    for y in range(height):
        kind, row = data[y * (in_row + 1)], bytearray(data[y * (in_row + 1) + 1:(y + 1) * (in_row + 1)])
        for i in range(in_row):
            left = row[i - channels] if i >= channels else 0
            corner = above[i - channels] if i >= channels else 0
            guess = {0: 0, 1: left, 2: above[i], 3: (left + above[i]) // 2, 4: paeth(left, above[i], corner)}[kind]
            row[i] = (row[i] + guess) & 255
        out += row
        above = row
    return bytes(out)


def paeth(left, above, corner):
    guess = left + above - corner
    return min((left, above, corner), key=lambda value: abs(guess - value))
