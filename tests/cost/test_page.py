"""The page of `ballpark cost` in a real browser: it opens without complaint and without the network, its figures are
those of the JSON, its points stand where their values say, its pictures are pictures, and it is light or dark as the
reader likes. Skipped where there is no Chromium."""
import base64
import html.parser
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from cli import ProgramTest, main, scene  # noqa: E402

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
TITLE = 'Glass <b>&amp; "matte"</b>'
SCENE = scene(48, title=TITLE, spheres=[{"center": [0, 0, -1], "radius": 0.5, "material": "m"},
                                        {"center": [0, -100.5, -1], "radius": 100, "material": "ground"}],
              materials={"m": {"type": "dielectric", "refraction_index": 1.5},
                         "ground": {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]}})


class Dom(html.parser.HTMLParser):
    """Elements with data-*, each with its attributes, its text, and the element with data-* around it."""

    VOID = {"meta", "link", "img", "br"}

    def __init__(self, text):
        super().__init__()
        self.open, self.elements, self.images, self.title = [], [], [], ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "img":
            self.images.append(attributes)
        if tag in self.VOID:
            return
        element = {"tag": tag, "data": {k[5:]: v for k, v in attributes.items() if k.startswith("data-")},
                   "attributes": attributes, "text": ""}
        element["parent"] = next((e for e in reversed(self.open) if e["data"]), None)
        self.open.append(element)
        self.elements.append(element)

    def handle_endtag(self, tag):
        while self.open and self.open.pop()["tag"] != tag:
            pass

    def handle_data(self, data):
        for element in self.open:
            element["text"] += data

    def having(self, *names):
        return [e for e in self.elements if all(n in e["data"] for n in names)]


def number(text):
    return float(text) if text else None


def same(shown, value):
    return shown is None and value is None or None not in (shown, value) and math.isclose(shown, value, rel_tol=1e-9)


UNITS = {"ms": 1e-3, "s": 1, "%": 1e-2, "": 1}


def text_agrees(text, value):
    """Whether "1.23 %", "4.5 s", "−0.097 ± 0.003 %" or "-" is `value`, rounded."""
    if text in ("-", "", "none"):
        return value is None or value == 0 or text == ""
    if text == "under 0.000001 %":
        return abs(value) < 1e-8
    found = re.fullmatch(r"([+−]?)([\d.]+(?:e-?\d+)?)(?: ± [\d.]+)? ?(ms|s|%|)", text)
    if value is None or not found:
        return False
    digits = found[2].partition(".")[2].partition("e")[0]
    exponent = int(found[2].partition("e")[2] or 0)
    shown = float(found[2]) * (-1 if found[1] == "−" else 1)
    return abs(shown - value / UNITS[found[3]]) <= 0.500001 * 10 ** (exponent - len(digits))


def differences(dom, result):
    """What the page shows otherwise than the document; and how many figures were compared."""
    wrong, compared = [], 0
    series = {s["name"]: s for s in result["series"]}
    points = {(s["name"], p["samples"]): p for s in result["series"] for p in s["points"]}

    def check(what, shown, value, text=None):
        nonlocal compared
        compared += 1
        if not same(shown, value) or text is not None and not text_agrees(text, value):
            wrong.append(f"{what}: {shown} ({text}), not {value}")

    for cell in dom.having("key"):
        row, key, shown = cell["parent"]["data"], cell["data"]["key"], number(cell["data"]["value"])
        if "point" in row:
            value = points[row["point"], int(row["samples"])][key]
        else:
            way = series[row["series"]]
            if key == "pixel_bias":
                square = way["bias_square"]
                known = square["value"] is not None and (square["low"] > 0 or square["high"] == 0)
                value = math.sqrt(square["value"]) if known else None
            elif key in ("change", "bias"):
                value = way[key]["value"]
            elif key.startswith("fit_"):
                value = way["fit"][key[4:]]
            else:
                value = way[key] if key in way else way["points"][-1][key]
        root = math.sqrt(value) if key == "fit_floor" and value is not None else value
        check(f"{row} {key}", shown, value)
        if not text_agrees(cell["text"], root):
            wrong.append(f"{row} {key}: reads {cell['text']!r}, is {root}")
    for dot in dom.having("seconds", "nrmse", "samples"):
        point = points[dot["parent"]["data"]["curve"], int(dot["data"]["samples"])]
        for key in ("seconds", "nrmse"):
            check(f"dot {key}", number(dot["data"][key]), point[key])
        if ("best" in dot["attributes"]["class"]) != point["front"]:
            wrong.append(f"front: {dot['attributes']}")
    for row in dom.having("row"):
        way = series[row["data"]["row"]]
        check("bar", number(row["data"]["efficiency"]), way["efficiency"])
        for key, name in (("bias", "value"), ("low", "low"), ("high", "high")):
            check(f"bar {key}", number(row["data"][key]), way["bias"][name])
    for card, advice in zip(dom.having("target"), result["advice"]):
        check("target", number(card["data"]["target"]), advice["nrmse"])
        check("samples", number(card["data"]["samples"]), advice["samples_per_pixel"])
        check("seconds", number(card["data"]["seconds"]), advice["seconds"])
    return wrong, compared


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


class Page(ProgramTest):
    @classmethod
    def setUpClass(cls):
        if BROWSER is None:
            print("no Chromium here: the page is not opened (scripts/setup --test installs it on Debian)")
            sys.exit(77)

    def browse(self, name, *options):
        """Lets the browser open a file; what it says about the page goes to .complaints."""
        done = subprocess.run([BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                               "--hide-scrollbars", f"--user-data-dir={self.path('profile')}", "--no-first-run",
                               "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr", *options,
                               f"file://{self.path(name)}"], capture_output=True, timeout=120, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        self.complaints = [line for line in done.stderr.decode(errors="replace").splitlines() if "CONSOLE" in line]
        return done.stdout.decode()

    def study(self, document, seconds):
        self.write("s.json", document)
        self.succeed("cost", "s.json", "--time", seconds, "-o", "page.html", "--json", "cost.json", "-q")
        return json.loads(self.read("cost.json"))

    def test_in_the_browser(self):
        result = self.study(SCENE, 4)
        source = self.read("page.html").decode()
        self.assertNotRegex(source, r"""(?i)https?:|<script|@import|url\(|(?:src|href)="(?!data:)""")
        dom = Dom(self.browse("page.html", "--dump-dom"))
        self.assertEqual(self.complaints, [])

        wrong, compared = differences(dom, result)
        self.assertEqual(wrong, [])
        ways = len(result["series"])
        counts = len(result["series"][0]["points"])
        self.assertEqual(len(dom.having("series")), ways)
        self.assertEqual(len(dom.having("row")), ways)
        self.assertEqual(len(dom.having("point", "samples")), ways * counts)
        self.assertEqual(len(dom.having("target")), 3)
        self.assertGreater(compared, ways * (9 + 6 * counts + counts))
        self.assertEqual([e["text"] for e in dom.elements if e["attributes"].get("class") == "lead"], [TITLE])

        self.check_dots(dom)
        self.check_pictures(dom, result)
        self.check_schemes()
        self.check_the_checks(source, result)

    def check_dots(self, dom):
        """Positions are linear in the logarithms of what they stand for."""
        dots = dom.having("seconds", "nrmse", "samples")
        for value, place in (("seconds", "cx"), ("nrmse", "cy")):
            known = sorted((math.log(float(d["data"][value])), float(d["attributes"][place])) for d in dots)
            (low, first), (high, last) = known[0], known[-1]
            self.assertGreater(abs(last - first), 100)
            self.assertEqual(last > first, place == "cx")
            for at, pixels in known:
                self.assertAlmostEqual(pixels, first + (last - first) * (at - low) / (high - low), delta=0.05)

    def check_pictures(self, dom, result):
        """A crop and a map of every count, of the truth, and of every other way."""
        counts = [point["samples"] for point in result["series"][0]["points"]]
        names = ["base"] * len(counts) + ["truth"] + [way["name"] for way in result["series"][1:]]
        self.assertEqual(len(dom.images), 2 * len(names))
        crops = []
        for number, image in enumerate(dom.images):
            kind, _, data = image["src"].partition(",")
            self.assertEqual(kind, "data:image/png;base64")
            width, height, channels, rows = decode_png(base64.b64decode(data, validate=True))
            self.assertEqual((width, height, channels), (48, 48, 3))
            self.assertEqual((image["width"], image["height"]), ("48", "48"))
            # Where nothing but noise is wrong, a fast machine's map is nearly black: few shades are left.
            name, is_map = names[number // 2], number % 2 == 1
            noise_alone = is_map and name in ("truth", "everything right", "exact Fresnel")
            shades = len({row[i:i + 3] for row in rows for i in range(0, len(row), 3)})
            self.assertGreater(shades, 3 if noise_alone else 50, name)
            crops.append(sum(map(sum, rows)) / (3 * width * height))
        # Maps of more samples are darker: the error falls, until Schlick's is all that is left. How many counts
        # there are is a matter of the machine's speed and of what its kernel cache holds; two there are in any case.
        maps = dict(zip(counts, crops[1::2]))
        for count, next_count in zip(counts, counts[1:]):
            self.assertLess(maps[next_count], (0.97 if count < 64 else 1.01) * maps[count], (count, maps))
        if 64 in maps:
            self.assertLess(maps[64], 0.8 * maps[4])

    def check_schemes(self):
        shades = {}
        for scheme, number_of_it in (("dark", 0), ("light", 1)):
            self.browse("page.html", f"--blink-settings=preferredColorScheme={number_of_it}", "--window-size=500,300",
                        f"--screenshot={self.path(scheme + '.png')}")
            self.assertEqual(self.complaints, [])
            rows = decode_png(self.read(scheme + ".png"))[3]
            shades[scheme] = rows[2][0]
            self.assertGreater(len({bytes(row) for row in rows}), 50, "the page shows nothing")
        self.assertLess(shades["dark"], 60)
        self.assertGreater(shades["light"], 200)

    def check_the_checks(self, source, result):
        """A page that is wrong is found to be."""
        self.write("bad.html", source.replace("</main>", "<script>no_such_function()</script></main>"))
        self.browse("bad.html", "--dump-dom")
        self.assertNotEqual(self.complaints, [])
        for pattern, instead in ((r'(data-key="nrmse" data-value=")[^"]+', r"\g<1>0.5"),
                                 (r'(data-key="efficiency"[^>]*>)[^<]+', r"\g<1>1.11"),
                                 (r'(data-row="depth 5" data-efficiency=")[^"]+', r"\g<1>2")):
            changed, count = re.subn(pattern, instead, source, count=1)
            self.assertEqual(count, 1)
            self.assertEqual(len(differences(Dom(changed), result)[0]), 1, pattern)

    def test_picture_without_noise(self):
        self.study(scene(8, spheres=0, camera={"pixel_sampling": "center"}), 1)
        dom = Dom(self.browse("page.html", "--dump-dom"))
        self.assertEqual(self.complaints, [])
        self.assertEqual(len(dom.having("target")), 3)
        self.assertNotRegex(self.read("page.html").decode(), r"(?<![a-z])-?(nan|inf)(?![a-z])")


if __name__ == "__main__":
    main()
