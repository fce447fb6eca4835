"""The page of `ballpark cost` in a real browser: it opens without complaint and without the network, its figures are
those of the JSON, its points stand where their values say, its pictures are pictures, and it is light or dark as the
reader likes. Skipped where there is no Chromium."""
import html.parser
import json
import math
import re
import shutil
import subprocess
import unittest

from page import SCENE, TITLE, PageTest, decode_png, embedded
from cli import main, scene

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
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
    """Whether "1.23 %", "4.5 s", "−0.097 ± 0.003 %" or "–" is `value`, rounded."""
    if text in ("–", "", "none"):
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


class PageInBrowser(PageTest):
    @classmethod
    def setUpClass(cls):
        if BROWSER is None:
            raise unittest.SkipTest("Chromium is not installed, so the page is not opened")

    def browse(self, name, *options):
        """Lets the browser open a file; what it says about the page goes to .complaints."""
        done = subprocess.run([BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                               "--hide-scrollbars", f"--user-data-dir={self.path('profile')}", "--no-first-run",
                               "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr", *options,
                               f"file://{self.path(name)}"], capture_output=True, timeout=120, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        self.complaints = [line for line in done.stderr.decode(errors="replace").splitlines() if "CONSOLE" in line]
        return done.stdout.decode()

    def test_in_the_browser(self):
        result = self.study(SCENE, 4)
        source = self.read("page.html").decode()
        drawn = self.browse("page.html", "--dump-dom")
        dom = Dom(drawn)
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
        self.assertEqual([e["text"] for e in dom.elements if "f-title" in e["attributes"].get("class", "")], [TITLE])
        self.assertEqual([e["text"] for e in dom.elements if e["attributes"].get("id") == "warning"], [result["warning"] or ""])
        self.assertEqual([e["text"] for e in dom.elements if e["tag"] == "title"][0], f"What accuracy costs: {TITLE}")
        self.assertFalse([e for e in dom.elements if e["tag"] == "b" and "matte" in e["text"]])
        self.assertEqual(len([e for e in dom.elements if e["tag"] == "script"]), 3)

        self.check_dots(dom)
        self.check_images(dom, json.loads(embedded(source, "crops")))
        self.check_schemes()
        self.check_curves(dom, result["series"])
        self.check_the_checks(drawn, result)

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

    def check_images(self, dom, crops):
        """Every picture that is embedded is shown, in its order and at its size."""
        shown = [image["src"].partition(",") for image in dom.images]
        self.assertEqual({kind for kind, _, _ in shown}, {"data:image/png;base64"})
        order = [crop[kind] for crop in crops["counts"] + [crops["truth"]] + crops["others"] for kind in ("picture", "map")]
        self.assertTrue([data for _, _, data in shown] == order, "other pictures than those embedded")
        self.assertEqual({(i["width"], i["height"]) for i in dom.images}, {(str(crops["width"]), str(crops["height"]))})

    def check_curves(self, dom, series):
        """Each curve has a label, and no two have the same colour and the same dashes. Those that would hide the base
        configuration's are named instead."""
        groups = [e for e in dom.elements if "curve" in e["data"]]
        drawn = [group["data"]["curve"] for group in groups]
        note = next(e["text"] for e in dom.elements if e["attributes"].get("id") == "front-same")
        named = note.partition("Not drawn: ")[2].partition(". Their")[0].split(", ")
        base = series[0]
        for one in series:
            same = (one is not base and one["time_ratio"]["value"] is not None
                    and abs(one["time_ratio"]["value"] - 1) < 0.05
                    and all(p["nrmse"] and q["nrmse"] and abs(p["nrmse"] / q["nrmse"] - 1) < 0.03
                            for p, q in zip(one["points"], base["points"])))
            self.assertEqual((one["name"] in drawn, one["name"] in named), (not same, same), one["name"])
        self.assertGreater(len(groups), 4)
        looks = []
        for group in groups:
            lines = [e["attributes"]["stroke-dasharray"] for e in dom.elements
                     if e["parent"] is group and e["attributes"].get("class") == "curve"]
            self.assertEqual((len(lines), len(set(lines))), (2, 1))  # the curve, and its piece beside the label
            looks.append((group["attributes"]["class"], lines[0]))
            self.assertIn(group["data"]["curve"], [e["text"] for e in dom.elements
                                                   if e["parent"] is group and e["attributes"].get("class") == "label"])
        self.assertEqual(len(set(looks)), len(looks))

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
        self.write("bad.html", source.replace("</body>", "<script>no_such_function()</script></body>"))
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
        text = "".join(e["text"] for e in dom.elements if e["tag"] == "main")
        self.assertNotRegex(text, r"NaN|Infinity|undefined|null")

    def test_narrow(self):
        """On a telephone nothing but plots and tables, which scroll in their frames, is wider than the screen."""
        self.study(SCENE, 1)
        page = self.read("page.html").decode()
        probe = ("<script>const d = document.documentElement; document.title = `${d.clientWidth} ${d.scrollWidth}`;"
                 "</script>")
        self.write("narrow.html", page.replace("</body>", probe + "</body>"))
        self.write("frame.html", '<iframe id="f" src="narrow.html" style="width: 400px; height: 900px; border: 0">'
                   "</iframe><script>onload = () => { document.title = document.getElementById('f')"
                   ".contentDocument.title; };</script>")
        dom = Dom(self.browse("frame.html", "--dump-dom", "--allow-file-access-from-files"))
        self.assertEqual(self.complaints, [])
        self.assertEqual([e["text"] for e in dom.elements if e["tag"] == "title"], ["400 400"])


if __name__ == "__main__":
    main()
