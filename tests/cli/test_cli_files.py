"""Where pictures go, in which format; whole or not at all; what cannot be written is known before rendering."""

import os
import signal
import struct
import zlib

from cli import ProgramTest, main, scene
from pfm import read_pfm


def decode_png(data):
    """Width, height and RGB bytes of an 8-bit RGB PNG: enough of a decoder to see the pixels."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, at = {}, 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        chunks[kind] = chunks.get(kind, b"") + body
        at += 12 + length
    width, height, depth, color = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    assert (depth, color) == (8, 2)
    raw, stride, rows = zlib.decompress(chunks[b"IDAT"]), 3 * width, []
    before = bytes(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a = row[i - 3] if i >= 3 else 0
            b, c = before[i], before[i - 3] if i >= 3 else 0
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        before = bytes(row)
        rows.append(before)
    return width, height, b"".join(rows)


class StandardInput(ProgramTest):
    """"-" is a scene on standard input, for every command that takes a scene and reads it once."""

    def with_input(self, content, *arguments, code=0):
        with open(self.path(self.write("sent", content)), "rb") as sent:
            result = self.run_program(*arguments, stdin=sent)
        self.assertEqual(result.returncode, code, f"{arguments}: {result.errors}")
        return result

    def test_same_picture(self):
        document = scene(20, 10, spheres=3)
        self.write("s.json", document)
        self.succeed("render", "s.json", "-o", "file.pfm")
        self.with_input(document, "render", "-", "-o", "input.pfm")
        self.assert_same(self.read("file.pfm"), self.read("input.pfm"))
        self.with_input(document, "explain", "-")
        self.with_input(document, "explain", "-", "--pixel", "3,3")
        self.with_input(document, "check", "-", "--width", "4", "--spp", "4", "--margin", "50")

    def test_clouds_are_sought_here(self):
        self.write("points.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                 "property float z\nend_header\n0 0 -2\n")
        document = scene(4, spheres=0, clouds=[{"file": "points.ply", "radius": 1, "material": "m"}])
        self.assertIn(": 1 sphere,", self.with_input(document, "explain", "-").stdout.decode())

    def test_what_is_wrong(self):
        document = scene(4)
        said = self.with_input(document, "render", "-", code=2).errors
        self.assertIn("--output FILE", said)
        said = self.with_input('{ "camera": { "vfovv": 1 } }', "render", "-", "-o", "x.png", code=2).errors
        self.assertIn("standard input:1:15: camera.vfovv", said)
        self.assertIn("empty file", self.with_input("", "render", "-", "-o", "x.png", code=2).errors)
        self.assertIn("only once", self.with_input(document, "explain", "-", "-", code=2).errors)
        self.assertIn("cannot be read again", self.with_input(document, "bench", "-", code=2).errors)
        self.assertEqual(self.files(), ["sent"])


class Formats(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(20, 10))

    def test_endings(self):
        starts = {"png": b"\x89PNG", "ppm": b"P6\n20 10\n255\n", "pfm": b"PF\n20 10\n", "exr": b"\x76\x2f\x31\x01",
                  "bpa": b"{"}
        for ending, start in starts.items():
            self.succeed("render", "s.json", "-o", "a." + ending)
            self.assertTrue(self.read("a." + ending).startswith(start), ending)
            self.succeed("render", "s.json", "-o", "odd name", "--format", ending)
            self.assert_same(self.read("odd name"), self.read("a." + ending), ending)
            piped = self.succeed("render", "s.json", "-o", "-", "--format", ending).stdout
            self.assert_same(piped, self.read("a." + ending), ending)
        self.assertEqual(self.files(), sorted(["s.json", "odd name"] + ["a." + ending for ending in starts]))

    def test_pixels_agree(self):
        for name in ("a.png", "a.ppm", "a.pfm"):
            self.succeed("render", "s.json", "-o", name)
        self.succeed("render", "s.json", "-o", "text.ppm", "--format", "ppm-ascii")
        pixels = self.read("a.ppm").split(b"255\n", 1)[1]
        self.assertEqual(decode_png(self.read("a.png")), (20, 10, pixels))
        words = self.read("text.ppm").split()
        self.assertEqual(words[:4], [b"P3", b"20", b"10", b"255"])
        self.assertEqual(bytes(map(int, words[4:])), pixels)
        _, _, values = read_pfm(self.read("a.pfm"))
        rows = [values[60 * y:60 * y + 60] for y in range(10)]
        linear = [value for row in reversed(rows) for value in row]
        self.assertEqual(bytes(int(256 * min(value ** 0.5, 0.999)) for value in linear), pixels)

    def test_default_name(self):
        os.mkdir(self.path("deep.er"))
        self.write("deep.er/my.scene.json", scene(4))
        self.write("bare", scene(4))
        self.succeed("render", "deep.er/my.scene.json")
        self.succeed("render", "bare")
        self.succeed("render", "s.json", "--format", "ppm-ascii")
        self.succeed("render", "s.json", "--format", "bpa")
        self.assertEqual(self.files(),
                         ["bare", "bare.png", "deep.er", "my.scene.png", "s.bpa", "s.json", "s.ppm"])

    def test_default_is_png_on_standard_output(self):
        self.assertEqual(decode_png(self.succeed("render", "s.json", "-o", "-").stdout)[:2], (20, 10))

    def test_error_map(self):
        self.succeed("render", "s.json", "-o", "a.png", "--error-map", "map.png")
        width, height, _ = decode_png(self.read("map.png"))
        self.assertGreaterEqual((width, height), (20, 10))
        self.succeed("render", "s.json", "-o", "a.bpa")
        self.succeed("merge", "a.bpa", "-o", "b.png", "--error-map", "again.png")
        self.assert_same(self.read("map.png"), self.read("again.png"))
        self.assert_same(self.read("a.png"), self.read("b.png"))


class Writing(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(8))

    def test_quiet_is_silent(self):
        result = self.succeed("render", "s.json", "-o", "a.png", "--stats", "a.json", "--error-map", "m.png", "--quiet")
        self.assertEqual((result.stdout, result.errors), (b"", ""))
        self.succeed("render", "s.json", "-o", "a.bpa", "-q")
        self.assertEqual(self.succeed("merge", "a.bpa", "-o", "b.png", "-q").errors, "")

    def test_messages_go_to_standard_error(self):
        self.assertEqual(self.succeed("render", "s.json").stdout, b"")
        result = self.succeed("render", "s.json", "-o", "-", "--format", "pfm")
        self.assertEqual(len(result.stdout), len(b"PF\n8 8\n-1.0\n") + 8 * 8 * 12)
        self.assertIn("standard output: 8x8", result.errors)

    def test_unwritable_is_found_before_rendering(self):
        """A device that does not exist would be the error if the output were looked at later."""
        os.mkdir(self.path("folder.png"))
        for option in ("-o", "--stats", "--error-map"):
            self.fail_with(1, "render", "s.json", "--device", "none", option, "no/such.png", says="no/such.png")
            if option == "--stats":  # pictures go into a folder, under the scene's name
                self.fail_with(1, "render", "s.json", "--device", "none", option, "folder.png", says="folder.png")
        self.fail_with(1, "render", "s.json", "--device", "none", "-o", "s.json/x.png", says="s.json/x.png")
        os.rmdir(self.path("folder.png"))
        self.assertEqual(self.files(), ["s.json"])

    def test_full_disk(self):
        self.fail_with(1, "render", "s.json", "-o", "/dev/full", "--format", "png", says="No space left")
        self.fail_with(1, "render", "s.json", "-o", "a.png", "--stats", "/dev/full", says="No space left")
        with open("/dev/full", "wb") as full:
            for form in ("png", "pfm", "exr", "bpa"):
                self.fail_with(1, "render", "s.json", "-o", "-", "--format", form, stdout=full, says="No space left")
        self.assertEqual(self.files(), ["a.png", "s.json"])

    def test_reader_that_goes_away(self):
        reading, writing = os.pipe()
        os.close(reading)
        result = self.run_program("render", "s.json", "-o", "-", stdout=writing)
        os.close(writing)
        self.assertEqual((result.returncode, result.errors), (-signal.SIGPIPE, ""))

    def test_failure_leaves_the_old_picture(self):
        self.write("a.png", "precious")
        self.fail_with(1, "render", "s.json", "-o", "a.png", "--device", "none")
        self.assertEqual(self.read("a.png"), b"precious")
        self.succeed("render", "s.json", "-o", "a.png")
        self.assertTrue(self.read("a.png").startswith(b"\x89PNG"))
        self.assertEqual(self.files(), ["a.png", "s.json"])

    def test_links_are_followed(self):
        os.mkdir(self.path("far"))
        os.symlink("far/real.png", self.path("link.png"))
        self.succeed("render", "s.json", "-o", "link.png")
        self.assertTrue(os.path.islink(self.path("link.png")))
        self.assertTrue(self.read("far/real.png").startswith(b"\x89PNG"))

    def test_an_empty_name_is_no_scene(self):
        self.fail_with(2, "render", "", says="expected SCENE, found an empty name")

    def test_no_file_plays_two_parts(self):
        before = self.read("s.json")
        os.symlink("s.json", self.path("link.json"))
        for target in ("s.json", "./s.json", "link.json"):
            self.fail_with(2, "render", "s.json", "-o", target, "--format", "png", says="--output " + target)
            self.fail_with(2, "render", "s.json", "-o", "a.png", "--stats", target, says="--stats " + target)
            self.fail_with(2, "explain", "s.json", "--json", target, says="--json " + target)
            self.fail_with(2, "check", "s.json", "--json", target, says="--json " + target)
        self.assert_same(self.read("s.json"), before, "s.json")
        self.fail_with(2, "render", "s.json", "--error-map", "e.png", "--stats", "e.png", says="both name e.png")
        self.write("a.png", "")
        self.fail_with(2, "render", "s.json", "-o", "a.png", "--stats", "./a.png", says="--stats and --output")
        self.succeed("render", "s.json", "-o", "a.bpa")
        self.succeed("merge", "a.bpa", "-o", "a.bpa")

    def test_nothing_to_write_to_is_still_a_render(self):
        self.succeed("render", "s.json", "-o", "/dev/null", "--format", "exr")
        self.assertEqual(self.files(), ["s.json"])


if __name__ == "__main__":
    main()
