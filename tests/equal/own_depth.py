"""JPEGs with a depth inside, as phones write them: own_depth.py KIND PHOTO.jpg DEPTH OUT.jpg puts a PNG or JPEG of depth there.

KIND: gdepth (in attributes of XMP), elements (in its elements), dynamic (Dynamic Depth) or apple. Google's have black near."""
import base64
import pathlib
import struct
import sys

GDEPTH, NOTE = "http://ns.google.com/photos/1.0/depthmap/", "http://ns.adobe.com/xmp/note/"
DYNAMIC = "http://ns.google.com/photos/dd/1.0/"
NEAR, FAR = 0.5, 8


def _segment(name, data):
    data = name + b"\0" + data
    return b"\xff\xe1" + struct.pack(">H", len(data) + 2) + data


def _rdf(spaces, words, inside=""):
    spaces = "".join(f' xmlns:{prefix}="{uri}"' for prefix, uri in spaces.items())
    return (f'<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">'
            f'<rdf:Description rdf:about=""{spaces} {words}>{inside}</rdf:Description></rdf:RDF></x:xmpmeta>').encode()


def _with(photo, *segments):
    return photo[:2] + b"".join(segments) + photo[2:]


def _xmp(xml):
    return _segment(b"http://ns.adobe.com/xap/1.0/", xml)


def gdepth(photo, depth, kind="RangeInverse", elements=False, step=60000):
    """With the data in extended XMP, in pieces of so many bytes."""
    name, data = "0123456789abcdef" * 2, base64.b64encode(depth).decode()
    said = {"Format": kind, "Near": NEAR, "Far": FAR, "Mime": "image/png"}
    more = _rdf({"D": GDEPTH}, *(["", f"<D:Data>\n{data}\n</D:Data>"] if elements else [f'D:Data="{data}"']))
    attributes = "".join(f' GDepth:{key}="{value}"' for key, value in said.items() if not elements)
    inside = "".join(f"<GDepth:{key}>{value}</GDepth:{key}>" for key, value in said.items() if elements)
    first = _rdf({"GDepth": GDEPTH, "xmpNote": NOTE}, f'xmpNote:HasExtendedXMP="{name}"{attributes}', inside)
    pieces = [_segment(b"http://ns.adobe.com/xmp/extension/", name.encode() + struct.pack(">2I", len(more), at) + more[at:at + step])
              for at in range(0, len(more), step)]
    return _with(photo, _xmp(first), *pieces)


def dynamic(photo, depth, kind="RangeInverse"):
    items = "".join(f'<rdf:li rdf:parseType="Resource"><Container:Item Item:Mime="image/jpeg" Item:Length="{size}" Item:DataURI="{uri}"/></rdf:li>'
                    for size, uri in ((0, "primary"), (9, "android/original"), (len(depth), "android/depthmap")))
    words = f'DepthMap:Format="{kind}" DepthMap:Near="{NEAR}" DepthMap:Far="{FAR}" DepthMap:DepthURI="android/depthmap"'
    xml = _rdf({"Container": DYNAMIC + "container/", "Item": DYNAMIC + "item/", "DepthMap": DYNAMIC + "depthmap/"}, words,
               f"<Container:Directory><rdf:Seq>{items}</rdf:Seq></Container:Directory>")
    return _with(photo, _xmp(xml)) + b"\xff\xd8 sharp\xff" + depth


def apple(photo, depth):
    return photo + _with(depth, _xmp(_rdf({"apdi": "http://ns.apple.com/pixeldatainfo/1.0/"}, 'apdi:AuxiliaryImageType="disparity"')))


KINDS = {"gdepth": gdepth, "elements": lambda *files: gdepth(*files, elements=True), "dynamic": dynamic, "apple": apple}

if __name__ == "__main__":
    kind, photo, depth, out = sys.argv[1:]
    pathlib.Path(out).write_bytes(KINDS[kind](*(pathlib.Path(file).read_bytes() for file in (photo, depth))))
