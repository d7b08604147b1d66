"""Pictures in memory, flat and deep, and their files: EXR of any shape, PNG, TIFF and PFM. All are written by hand, so that
no library decides which shapes are possible."""
import dataclasses
import struct
import zlib

import numpy

TYPES = {"<u4": 0, "<f2": 1, "<f4": 2}
SKY = 1e10


def is_depth(name):
    return name == "Z" or name.endswith(".Z") and "Depth" in name


@dataclasses.dataclass
class Picture:
    """`channels` has an array for each name, of the type it has in a file: (height, width), or, if `counts` has the
    number of samples of each pixel, all samples row by row. Windows are left, top, right, bottom, the last included."""
    channels: dict
    data: tuple
    display: tuple
    counts: numpy.ndarray = None
    attributes: dict = dataclasses.field(default_factory=dict)  # name: (type, bytes)

    def but(self, **fields):
        return dataclasses.replace(self, **fields)

    def each(self, change):
        """change(name, array) makes each channel anew."""
        return self.but(channels={name: change(name, values) for name, values in self.channels.items()})

    def only(self, names):
        return self.but(channels={name: values for name, values in self.channels.items() if name in names})

    def renamed(self, name_of):
        return self.but(channels={name_of(name): values for name, values in self.channels.items()})

    def boxes(self, change):
        """change(box) makes each window anew, in the attributes, too."""
        said = self.attributes.get("sparselens:dataWindow")
        moved = {"sparselens:dataWindow": ("box2i", struct.pack("<4i", *change(struct.unpack("<4i", said[1]))))} if said else {}
        return self.but(data=change(self.data), display=change(self.display), attributes={**self.attributes, **moved})

    def take(self, index, data):
        """The picture of these pixels of this one, counted row by row; -1 is an empty one."""
        empty, index = index < 0, index.clip(0)
        if self.counts is None:
            def nothing(name, v):
                return v.dtype.type((65504 if v.dtype == "<f2" else SKY) if is_depth(name) else 0)
            return self.each(lambda name, v: numpy.where(empty, nothing(name, v), v.reshape(-1)[index])).but(data=data)
        begin = numpy.concatenate([[0], self.counts.cumsum()])
        counts = numpy.where(empty, 0, self.counts.reshape(-1)[index])
        which = [numpy.arange(begin[i], begin[i] + n) for i, n in zip(index.flat, counts.flat)]
        which = numpy.concatenate(which).astype(int) if which else numpy.zeros(0, int)
        return self.each(lambda _, v: v[which]).but(data=data, counts=counts)

    def windowed(self, box):
        """Cut to this data window, or grown by empty pixels."""
        left, top, right, bottom = self.data
        y, x = numpy.mgrid[box[1]:box[3] + 1, box[0]:box[2] + 1]
        inside = (x >= left) & (x <= right) & (y >= top) & (y <= bottom)
        return self.take(numpy.where(inside, (y - top) * (right - left + 1) + x - left, -1), tuple(box))

    def pixels(self):
        return numpy.arange((self.data[2] - self.data[0] + 1) * (self.data[3] - self.data[1] + 1)).reshape(
            self.data[3] - self.data[1] + 1, -1)

    def mirrored(self):
        across = self.display[0] + self.display[2]
        picture = self.take(self.pixels()[:, ::-1], self.data)
        return picture.boxes(lambda b: (across - b[2], b[1], across - b[0], b[3]))

    def transposed(self):
        return self.take(self.pixels().T, self.data).boxes(lambda b: (b[1], b[0], b[3], b[2]))


def _text(text):
    return text.encode() + b"\0"


def _attribute(name, kind, value):
    return _text(name) + _text(kind) + struct.pack("<i", len(value)) + value


def _packed(raw, compression):
    """As ZIP stores it: even and odd bytes apart, then differences."""
    if compression == "none" or not raw:
        return raw
    bytes_ = numpy.frombuffer(raw[0::2] + raw[1::2], numpy.uint8).astype(int)
    packed = zlib.compress((numpy.diff(bytes_, prepend=128) + 128).astype(numpy.uint8).tobytes())
    return packed if len(packed) < len(raw) else raw


def _unpacked(data, size):
    if len(data) == size:
        return data
    differences = numpy.frombuffer(zlib.decompress(data), numpy.uint8).astype(int)
    bytes_ = (numpy.cumsum(differences - 128) + 128 & 255).astype(numpy.uint8)
    raw = numpy.empty(size, numpy.uint8)
    raw[0::2], raw[1::2] = bytes_[:(size + 1) // 2], bytes_[(size + 1) // 2:]
    return raw.tobytes()


def _chunks(picture, compression, tile, decreasing):
    """(key, bytes) of each chunk, in the order of the file's table: the key says which rows or which tile it is."""
    left, top, right, bottom = picture.data
    height, width = bottom - top + 1, right - left + 1
    tall = tile[1] if tile else 16 if compression == "zip" and picture.counts is None else 1
    begin = None if picture.counts is None else numpy.concatenate([[0], picture.counts.cumsum()])
    for y in range(0, height, tall):
        for x in range(0, width, tile[0] if tile else width):
            rows, columns = range(y, min(y + tall, height)), slice(x, min(x + (tile[0] if tile else width), width))
            key = struct.pack("<4i", x // tile[0], y // tile[1], 0, 0) if tile else struct.pack("<i", top + y)
            if begin is None:
                raw = b"".join(values[row, columns].tobytes() for row in rows for _, values in sorted(picture.channels.items()))
                packed = _packed(raw, compression)
                yield key + struct.pack("<i", len(packed)) + packed
                continue
            table = b"".join(picture.counts[row, columns].cumsum().astype("<i4").tobytes() for row in rows)
            part = {row: slice(begin[row * width + columns.start], begin[row * width + columns.stop]) for row in rows}
            raw = b"".join(values[part[row]].tobytes() for row in rows for _, values in sorted(picture.channels.items()))
            packed = [_packed(table, compression), _packed(raw, compression)]
            yield key + struct.pack("<3Q", len(packed[0]), len(packed[1]), len(raw)) + b"".join(packed)


def exr(path, *parts, names=None, compression="zip", tile=None, decreasing=False):
    """Writes pictures as the parts of an EXR file; deep ones have ZIPS in place of ZIP. `tile`: its width and height."""
    flags, headers, chunks = 2, [], []
    for number, picture in enumerate(parts):
        deep = picture.counts is not None
        made = list(_chunks(picture, compression, tile, decreasing))
        method = {"none": 0, "zips": 2, "zip": 2 if deep else 3}[compression]
        listed = b"".join(_text(name) + struct.pack("<iB3xii", TYPES[values.dtype.str], 0, 1, 1)
                          for name, values in sorted(picture.channels.items())) + b"\0"
        header = {"channels": ("chlist", listed), "compression": ("compression", bytes([method])),
                  "dataWindow": ("box2i", struct.pack("<4i", *picture.data)),
                  "displayWindow": ("box2i", struct.pack("<4i", *picture.display)),
                  "lineOrder": ("lineOrder", bytes([decreasing])), "pixelAspectRatio": ("float", struct.pack("<f", 1)),
                  "screenWindowCenter": ("v2f", bytes(8)), "screenWindowWidth": ("float", struct.pack("<f", 1)), **picture.attributes}
        if tile:
            header["tiles"] = ("tiledesc", struct.pack("<2IB", *tile, 0))
        if deep:
            header.update(version=("int", struct.pack("<i", 1)), maxSamplesPerPixel=("int", struct.pack("<i", -1)))
        if deep or len(parts) > 1:
            kind = ("deeptile" if tile else "deepscanline") if deep else "tiledimage" if tile else "scanlineimage"
            header.update(type=("string", kind.encode()), chunkCount=("int", struct.pack("<i", len(made))))
        if len(parts) > 1:
            header["name"] = ("string", names[number].encode())
            made = [struct.pack("<i", number) + chunk for chunk in made]
        flags |= (0x800 if deep else 0) | (0x200 if tile and not deep and len(parts) == 1 else 0) | (0x1000 if len(parts) > 1 else 0)
        flags |= 0x400 if max(map(len, [*header, *picture.channels])) > 31 else 0
        headers.append(b"".join(_attribute(name, *value) for name, value in header.items()) + b"\0")
        chunks.append(made)
    start = struct.pack("<2I", 20000630, flags) + b"".join(headers) + (b"\0" if len(parts) > 1 else b"")
    at = len(start) + 8 * sum(map(len, chunks))
    table, body = [], []
    for made in chunks:
        places = {}
        for i in reversed(range(len(made))) if decreasing else range(len(made)):
            places[i] = at
            at += len(made[i])
            body.append(made[i])
        table += [places[i] for i in range(len(made))]
    path.write_bytes(start + struct.pack(f"<{len(table)}Q", *table) + b"".join(body))


def read_exr(path):
    """Reads what the tools write: one part of scan lines, with no compression, ZIPS or ZIP."""
    file, at, header = path.read_bytes(), 8, {}

    def text():
        nonlocal at
        end = file.index(b"\0", at)
        word, at = file[at:end].decode(), end + 1
        return word
    while name := text():
        kind, size = text(), struct.unpack_from("<i", file, at)[0]
        header[name] = (kind, file[at + 4:at + 4 + size])
        at += 4 + size
    listed, channels = header["channels"][1], []
    while len(listed) > 1:
        name, _, listed = listed.partition(b"\0")
        channels.append((name.decode(), list(TYPES)[struct.unpack_from("<i", listed)[0]]))
        listed = listed[16:]
    left, top, right, bottom = data = struct.unpack("<4i", header["dataWindow"][1])
    width, height = right - left + 1, bottom - top + 1
    deep, tall = "version" in header and header["type"][1].startswith(b"deep"), {0: 1, 2: 1, 3: 16}[header["compression"][1][0]]
    values, counts = {name: [b""] * height for name, _ in channels}, numpy.zeros((height, width), int)
    for place in struct.unpack_from(f"<{-(-height // tall)}Q", file, at):
        y = struct.unpack_from("<i", file, place)[0] - top
        rows = range(y, min(y + tall, height))
        if deep:
            sizes = struct.unpack_from("<3Q", file, place + 4)
            place += 28
            table = numpy.frombuffer(_unpacked(file[place:place + sizes[0]], 4 * width), "<i4")
            counts[y] = numpy.diff(table, prepend=0)
            raw = _unpacked(file[place + sizes[0]:place + sizes[0] + sizes[1]], sizes[2])
        else:
            counts[:] = 1
            size = struct.unpack_from("<i", file, place + 4)[0]
            raw = _unpacked(file[place + 8:place + 8 + size], len(rows) * width * sum(int(kind[2]) for _, kind in channels))
        for row in rows:
            for name, kind in channels:
                size = int(kind[2]) * int(counts[row].sum())
                values[name][row], raw = raw[:size], raw[size:]
    arrays = {name: numpy.frombuffer(b"".join(values[name]), kind) for name, kind in channels}
    if not deep:
        arrays = {name: v.reshape(height, width) for name, v in arrays.items()}
    structure = ("channels compression dataWindow displayWindow lineOrder type version chunkCount maxSamplesPerPixel "
                 "pixelAspectRatio screenWindowCenter screenWindowWidth").split()
    return Picture(arrays, data, struct.unpack("<4i", header["displayWindow"][1]), counts if deep else None,
                   {name: value for name, value in header.items() if name not in structure})


@dataclasses.dataclass
class Photo:
    """A picture of integers, (height, width) or (height, width, 3), or of 32-bit floats; `own`: the depth in its file."""
    values: numpy.ndarray
    own: numpy.ndarray = None

    def stored(self, orientation):
        """The pixels as a camera stores them that was turned like this (Exif)."""
        v = self.values
        return [v, v[:, ::-1], v[::-1, ::-1], v[::-1], v.swapaxes(0, 1), numpy.rot90(v), v[::-1, ::-1].swapaxes(0, 1), numpy.rot90(v, -1)][orientation - 1]


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(path, photo, orientation=1):
    v = photo.stored(orientation)
    big = v.astype(v.dtype.newbyteorder(">"))
    rows = b"".join(b"\0" + row.tobytes() for row in big)
    head = struct.pack(">2I5B", v.shape[1], v.shape[0], 8 * v.dtype.itemsize, 2 if v.ndim == 3 else 0, 0, 0, 0)
    exif = struct.pack(">2sHIHHHIHHI", b"MM", 42, 8, 1, 0x112, 3, 1, orientation, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", head) + (_chunk(b"eXIf", exif) if orientation > 1 else b"") +
                     _chunk(b"IDAT", zlib.compress(rows)) + _chunk(b"IEND", b""))


def tiff(path, photo, orientation=1, order="<"):
    v = photo.stored(orientation)
    data, colours = v.astype(v.dtype.newbyteorder(order)).tobytes(), 3 if v.ndim == 3 else 1
    entries = [(256, v.shape[1]), (257, v.shape[0]), (258, 8 * v.dtype.itemsize), (259, 1), (262, 2 if colours == 3 else 1), (273, 0),
               (274, orientation), (277, colours), (278, v.shape[0]), (279, len(data)), (339, 3 if v.dtype.kind == "f" else 1)]
    at = 8 + 2 + 12 * len(entries) + 4
    ifd = struct.pack(order + "H", len(entries))
    for tag, value in entries:
        if tag in (258, 339) and colours == 3:  # three shorts do not fit into the entry
            ifd += struct.pack(order + "HHII", tag, 3, 3, at + (6 if tag == 339 else 0))
        else:
            ifd += struct.pack(order + "HHII", tag, 4, 1, at + 12 if tag == 273 else value) if tag not in (258, 259, 262, 274, 277, 339) else \
                struct.pack(order + "HHIHH", tag, 3, 1, value, 0)
    three = struct.pack(order + "6H", *[8 * v.dtype.itemsize] * 3, *[3 if v.dtype.kind == "f" else 1] * 3)
    path.write_bytes((b"II*\0" if order == "<" else b"MM\0*") + struct.pack(order + "I", 8) + ifd + bytes(4) + three + data)


def pfm(path, photo, order="<"):
    v = photo.values.astype(order + "f4")
    kind, scale = "PF" if v.ndim == 3 else "Pf", "-1.0" if order == "<" else "1.0"
    path.write_bytes(f"{kind}\n{v.shape[1]} {v.shape[0]}\n{scale}\n".encode() + v[::-1].tobytes())
