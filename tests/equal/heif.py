"""HEIC and AVIF with a depth beside the colours, as phones write them: libheif encodes each picture, and the container, which
it cannot make, is written by hand. heif.py OUT.heic|OUT.avif PHOTO.ppm [DEPTH.pgm [TURN]]: TURN quarters to the left."""
import ctypes
import pathlib
import struct
import sys
import tempfile

DEPTH = {".heic": b"urn:mpeg:hevc:2015:auxid:2", ".avif": b"urn:mpeg:mpegB:cicp:systems:auxiliary:depth"}


class _Error(ctypes.Structure):
    _fields_ = [("code", ctypes.c_int), ("more", ctypes.c_int), ("why", ctypes.c_char_p)]


def _libheif():
    """Its functions; None without it."""
    try:
        library = ctypes.CDLL("libheif.so.1")
    except OSError:
        return None
    library.heif_context_alloc.restype = ctypes.c_void_p
    library.heif_image_get_plane.restype = ctypes.c_void_p

    def call(name, *arguments):
        function = getattr(library, name)
        function.restype = _Error
        error = function(*arguments)
        if error.code:
            raise RuntimeError(f"{name}: {error.why.decode()}")
    return library, call


def can_write(ending):
    found = _libheif()
    return bool(found and found[0].heif_have_encoder_for_format({".heic": 1, ".avif": 4}[ending]))


def _encoded(picture, ending):
    """A file of that picture alone: (width, height, bytes of R, G and B)."""
    library, call = _libheif()
    context, image, encoder, stride = ctypes.c_void_p(library.heif_context_alloc()), ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_int()
    width, height, values = picture
    call("heif_image_create", width, height, 1, 10, ctypes.byref(image))
    call("heif_image_add_plane", image, 10, width, height, 8)
    plane = library.heif_image_get_plane(image, 10, ctypes.byref(stride))
    for y in range(height):
        ctypes.memmove(plane + y * stride.value, values[3 * width * y:3 * width * (y + 1)], 3 * width)
    call("heif_context_get_encoder_for_format", context, {".heic": 1, ".avif": 4}[ending], ctypes.byref(encoder))
    call("heif_encoder_set_lossy_quality", encoder, 100)
    call("heif_encoder_set_parameter_string", encoder, b"chroma", b"444")
    call("heif_context_encode_image", context, image, encoder, None, None)
    with tempfile.NamedTemporaryFile() as file:
        call("heif_context_write_to_file", context, file.name.encode())
        return pathlib.Path(file.name).read_bytes()


def _box(kind, *data):
    data = b"".join(data)
    return struct.pack(">I", 8 + len(data)) + kind + data


def _full(kind, *data, version=0):
    return _box(kind, struct.pack(">I", version << 24), *data)


def _boxes(data):
    found = {}
    while len(data) >= 8:
        size = struct.unpack(">I", data[:4])[0]
        found[data[4:8]], data = data[8:size], data[size:]
    return found


def _item(file):
    """(kind, properties, coded bytes) of a file with one picture."""
    meta = _boxes(_boxes(file)[b"meta"][4:])
    kind = _boxes(meta[b"iinf"][6:])[b"infe"][8:12]
    properties = _boxes(_boxes(meta[b"iprp"])[b"ipco"])
    assert meta[b"iloc"][4:6] == b"\x44\x40", "another form of iloc"
    base, _, offset, size = struct.unpack(">IH2I", meta[b"iloc"][-14:])
    offset += base
    return kind, [_box(name, properties[name]) for name in (b"hvcC", b"av1C", b"ispe", b"pixi", b"colr") if name in properties], file[offset:offset + size]


def write(path, photo, depth=None, turn=0):
    """HEIC of at least 64 pixels on a side: libheif makes several items of smaller ones."""
    ending = path.suffix
    pictures = [photo] if depth is None else [photo, depth]
    items = [_item(_encoded(picture, ending)) for picture in pictures]
    turned = [_box(b"irot", bytes([turn]))] if turn else []
    properties = [own + turned for _, own, _ in items]
    if depth is not None:
        properties[1] = properties[1] + [_full(b"auxC", DEPTH[ending] + b"\0")]
    numbered, number = [], 1
    for own in properties:
        numbered.append(bytes([len(own)]) + bytes(0x80 | n if box[4:8] in (b"hvcC", b"av1C", b"irot", b"auxC") else n for n, box in enumerate(own, number)))
        number += len(own)
    head = _box(b"ftyp", b"heic" if ending == ".heic" else b"avif", bytes(4), b"mif1heicavif")

    def meta(at):
        infes = b"".join(_full(b"infe", struct.pack(">2H4s", i, 0, kind), b"\0", version=2) for i, (kind, _, _) in enumerate(items, 1))
        places, begin = b"", at
        for i, (_, _, coded) in enumerate(items, 1):
            places += struct.pack(">3H2I", i, 0, 1, begin, len(coded))
            begin += len(coded)
        refers = [_full(b"iref", _box(b"auxl", struct.pack(">3H", 2, 1, 1)))] if depth is not None else []
        associated = b"".join(struct.pack(">H", i) + own for i, own in enumerate(numbered, 1))
        return _full(b"meta", _full(b"hdlr", bytes(4), b"pict", bytes(13)), _full(b"pitm", struct.pack(">H", 1)),
                     _full(b"iinf", struct.pack(">H", len(items)), infes), *refers,
                     _box(b"iprp", _box(b"ipco", *sum(properties, [])), _full(b"ipma", struct.pack(">I", len(items)), associated)),
                     _full(b"iloc", b"\x44\0", struct.pack(">H", len(items)), places))
    path.write_bytes(head + meta(len(head) + len(meta(0)) + 8) + _box(b"mdat", *(coded for _, _, coded in items)))


def _read(path):
    """A PPM or PGM of bytes."""
    kind, size, _, values = pathlib.Path(path).read_bytes().split(b"\n", 3)
    return *map(int, size.split()), values if kind == b"P6" else bytes(v for v in values for _ in "RGB")


if __name__ == "__main__":
    out, photo, *more = sys.argv[1:]
    if not can_write(pathlib.Path(out).suffix):
        sys.exit("libheif or its encoder is missing")
    write(pathlib.Path(out), _read(photo), *map(_read, more[:1]), *map(int, more[1:]))
