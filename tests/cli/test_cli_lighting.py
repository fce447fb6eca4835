"""Light by name: what stands in the camera's frame, against the same light written out for that camera."""

import json
import math

import cli
from pfm import read_pfm

PRESETS = ("soft", "studio", "rembrandt", "overhead")
CAMERA = {"vfov": 30, "lookfrom": [3, 2, 6], "lookat": [0.2, 0.1, 0], "vup": [0.1, 1, 0.3]}
# To the right of the picture, up in it, towards the viewer.
STUDIO = {"dome": 0.35, "lamps": [([-0.7, 0.8, 0.75], 45, 1.3)]}
XYZ = "2\n\nO 0 0 0\nC 0 0 1.5\n"


def axes(camera):
    def unit(v):
        return [x / math.sqrt(sum(y * y for y in v)) for x in v]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    back = unit([f - t for f, t in zip(camera["lookfrom"], camera["lookat"])])
    right = unit(cross(camera["vup"], back))
    return right, cross(back, right), back


def in_scene(camera, direction):
    return [sum(d * axis[i] for d, axis in zip(direction, axes(camera))) for i in range(3)]


class Light(cli.ProgramTest):
    def pixels(self, *arguments):
        self.succeed("render", *arguments, "-o", "out.pfm", "--quiet")
        return list(read_pfm(self.read("out.pfm"))[2])

    def assert_near(self, one, other, tolerance=1e-5):
        self.assertEqual(len(one), len(other))
        self.assertLessEqual(max(abs(a - b) for a, b in zip(one, other)), tolerance)

    def document(self, **members):
        return cli.scene(12, spheres=[{"center": [0, 0, 0], "radius": 1, "material": "m"},
                                      {"center": [1, 0.5, 0.5], "radius": 0.4, "material": "m"}],
                         camera=CAMERA, **members)

    def test_studio_is_a_lamp_before_a_dome_in_the_cameras_frame(self):
        self.write("named.json", self.document(lighting="studio"))
        explicit = {"bottom": [STUDIO["dome"]] * 3, "top": [STUDIO["dome"]] * 3, "discs": [
            {"direction": in_scene(CAMERA, direction), "half_angle": angle, "radiance": [radiance] * 3,
             "visible_to_camera": False} for direction, angle, radiance in STUDIO["lamps"]]}
        self.write("written.json", self.document(background=explicit, backdrop=[1, 1, 1]))
        self.assert_near(self.pixels("named.json"), self.pixels("written.json"))

    def test_the_light_turns_with_the_camera(self):
        """A lone ball looks the same from every side, which it does not under a light that stands in the scene."""
        ball = cli.scene(12, spheres=[{"center": [0, 0, 0], "radius": 1, "material": "m"}],
                         camera={"fit": "scene", "view": "front"})
        for light in PRESETS:
            self.write("ball.json", dict(ball, lighting=light))
            self.succeed("render", "ball.json", "--turntable", 3, "-o", "ball.pfm", "--quiet", "--spp", 64)
            turned = [list(read_pfm(self.read(f"ball-000{i}.pfm"))[2]) for i in range(3)]
            means = [sum(values) / len(values) for values in turned]
            for values in turned[1:]:
                self.assert_near(values, turned[0], 0.12)
            self.assertLess(max(means) - min(means), 0.01, light)
        self.write("ball.json", dict(ball, background={"bottom": [0, 0, 0], "top": [1, 1, 1], "up": [1, 0, 0]}))
        self.succeed("render", "ball.json", "--turntable", 2, "-o", "ball.pfm", "--quiet", "--spp", 64)
        left, right = (self.halves(list(read_pfm(self.read(f"ball-000{i}.pfm"))[2])) for i in range(2))
        self.assertLess(left[0], left[1])
        self.assertGreater(right[0], right[1])

    def halves(self, values, width=12):
        """Mean of the left and of the right half of a picture."""
        left = [values[3 * i] for i in range(len(values) // 3) if i % width < width // 2]
        right = [values[3 * i] for i in range(len(values) // 3) if i % width >= width // 2]
        return sum(left) / len(left), sum(right) / len(right)

    def test_each_arrangement_lights_the_side_it_should(self):
        ball = cli.scene(12, spheres=[{"center": [0, 0, 0], "radius": 1, "material": "m"}],
                         camera={"fit": "scene", "view": [1, 2, 3], "vup": [0, 0, 1]}, backdrop=[0, 0, 0])
        self.write("ball.json", ball)
        for light, brighter in (("soft", "left"), ("studio", "left"), ("rembrandt", "right")):
            left, right = self.halves(self.pixels("ball.json", "--lighting", light, "--spp", 64))
            self.assertEqual(brighter, "left" if left > right else "right", light)
        rows = self.pixels("ball.json", "--lighting", "overhead", "--spp", 64)
        lower, upper = sum(rows[:len(rows) // 2]), sum(rows[len(rows) // 2:])  # a PFM begins at the bottom
        self.assertLess(lower, 0.8 * upper)

    def test_the_camera_sees_white_behind_unless_a_backdrop_says_otherwise(self):
        self.write("scene.json", cli.scene(4, spheres=0))
        for light in PRESETS:
            self.assertEqual(set(self.pixels("scene.json", "--lighting", light)), {1})
        self.assertEqual(set(self.pixels("scene.json", "--lighting", "studio", "--set", "backdrop=[0,0.5,0]")), {0, 0.5})

    def test_the_option_stands_for_what_the_scene_says(self):
        self.write("scene.json", self.document(lighting="rembrandt"))
        self.write("studio.json", self.document(lighting="studio"))
        self.write("sky.json", self.document())
        self.write("own.json", self.document(background=[0, 0.25, 0]))
        self.assertEqual(self.pixels("scene.json", "--lighting", "studio"), self.pixels("studio.json"))
        self.assertEqual(self.pixels("own.json", "--lighting", "studio"), self.pixels("studio.json"))
        self.assertEqual(self.pixels("scene.json", "--lighting", "sky"), self.pixels("sky.json"))
        self.assertNotEqual(self.pixels("scene.json"), self.pixels("studio.json"))

    def test_particle_files(self):
        self.write("a.xyz", XYZ)
        document = json.loads(self.succeed("scene", "a.xyz").stdout)
        self.assertEqual((document["lighting"], document["backdrop"]), ("soft", {"bottom": [1, 1, 1], "top": [1, 1, 1]}))
        self.assertNotIn("background", document)
        self.succeed("scene", "a.xyz", "--lighting", "overhead", "-o", "a.json", "--quiet")
        self.assertEqual(json.loads(self.read("a.json"))["lighting"], "overhead")
        small = ("--width", 16, "--spp", 4)
        self.assertEqual(self.pixels("a.json", *small), self.pixels("a.xyz", "--lighting", "overhead", *small))
        self.write("a.csv", "x,y,z\n0,0,0\n1,1,1\n")  # z is up there
        sky = json.loads(self.succeed("scene", "a.csv", "--lighting", "sky").stdout)
        self.assertEqual(sky["background"]["up"], [0, 0, 1])
        self.assertNotIn("backdrop", sky)

    def test_scenes_are_written_again(self):
        for light in PRESETS:
            self.write("scene.json", self.document(lighting=light))
            self.succeed("scene", "scene.json", "-o", "again.json", "--quiet")
            again = json.loads(self.read("again.json"))
            self.assertEqual(again["lighting"], light)
            self.assertEqual(self.pixels("scene.json", "--spp", 2), self.pixels("again.json", "--spp", 2))

    def test_mistakes(self):
        self.write("scene.json", cli.scene(8, lighting="studoi"))
        self.fail_with(2, "render", "scene.json", "-o", "a.png", says=("scene.json:", "lighting", "did you mean \"studio\"?"))
        self.write("scene.json", cli.scene(8, lighting="studio", background=[1, 1, 1]))
        self.fail_with(2, "render", "scene.json", "-o", "a.png", says=("lighting: found beside \"background\"", "remove one"))
        self.write("scene.json", cli.scene(8, lighting="sky", background=[1, 1, 1]))
        self.succeed("render", "scene.json", "-o", "a.png", "--lighting", "studio", "--quiet")
        self.fail_with(2, "render", "scene.json", "--lighting", "sun", says=("--lighting", "soft, studio, rembrandt, overhead"))


cli.main()
