"""What the tests of the page of `ballpark cost` share: the scene, what is embedded in a page, pictures."""
import base64
import json
import re
import struct
import zlib

from cli import ProgramTest, scene

# Text that would end the script element that it stands in, open a comment there, or be markup outside.
TITLE = 'Glass <b>&amp; "matte"</b></script><!-- <script> {{crops}} \u2028'
SCENE = scene(48, title=TITLE, spheres=[{"center": [0, 0, -1], "radius": 0.5, "material": "m"},
                                        {"center": [0, -100.5, -1], "radius": 100, "material": "ground"}],
              materials={"m": {"type": "dielectric", "refraction_index": 1.5},
                         "ground": {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]}})


def embedded(source, name):
    """The text of a JSON element of the page."""
    found = re.findall(rf'<script type="application/json" id="{name}">(.*?)</script>', source, re.S)
    assert len(found) == 1, f"{len(found)} elements {name}"
    return found[0]


def crop_images(crops):
    """Every picture, with what it shows: of the truth, of each count, of each other configuration."""
    return [(part, kind, base64.b64decode(crop[kind], validate=True))
            for part in ("counts", "truth", "others")
            for crop in (crops[part] if part != "truth" else [crops[part]]) for kind in ("picture", "map")]


class PageTest(ProgramTest):
    def study(self, document, seconds):
        self.write("s.json", document)
        self.succeed("cost", "s.json", "--time", seconds, "-o", "page.html", "--json", "cost.json", "-q")
        return json.loads(self.read("cost.json"))


def decode_png(data):
    """Width, height, and rows of bytes a channel, of an 8-bit RGB or RGBA picture that is not interlaced."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:8]
    width, height, depth, color = struct.unpack(">IIBB", data[16:26])
    at, packed = 8, b""
    while at < len(data):
        length, = struct.unpack(">I", data[at:at + 4])
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    channels = {2: 3, 6: 4}[color]
    assert depth == 8
    raw, rows, before = zlib.decompress(packed), [], bytes(width * channels)
    for y in range(height):
        kind, line = raw[y * (width * channels + 1)], bytearray(raw[y * (width * channels + 1) + 1:][:width * channels])
        for i, byte in enumerate(line):
            a = line[i - channels] if i >= channels else 0
            b, c = before[i], before[i - channels] if i >= channels else 0
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[i] = byte + (0, a, b, (a + b) // 2, nearest)[kind] & 255
        rows.append(bytes(line))
        before = line
    return width, height, channels, rows
