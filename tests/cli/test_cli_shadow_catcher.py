"""The ground that shows nothing but shadow, against closed forms of 1 - lit / unlit, and where it lies."""

import json
import math

import cli
from pfm import read_pfm
from png import read_png

WIDTH, VIEW = 24, 8.0
PIXEL = VIEW / WIDTH
# Straight down, by parallel rays: a pixel's column is x, its row z.
ABOVE = {"projection": "orthographic", "view_height": VIEW, "lookfrom": [0, 50, 0], "lookat": [0, 0, 0], "vup": [0, 0, -1], "samples_per_pixel": 256}
GREY = {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}}


def ball(height, radius=1.0, **members):
    """A ball over the ground at height 0, in front of white."""
    document = {"camera": ABOVE, "background": [0.5, 0.5, 0.5], "backdrop": [1, 1, 1], "shadow_catcher": {"height": 0},
                "spheres": [{"center": [0, height, 0], "radius": radius, "material": "m"}], **members}
    return cli.scene(WIDTH, WIDTH, materials=GREY, **document)


def covered(radius, height, distance):
    """The share of the light of a uniform sky that a ball keeps from a point of a plane: (r / D)^2 times the cosine, as long as all
    of it stands above the horizon (E. Sparrow, R. Cess, "Radiation Heat Transfer", 1978, the sphere and a small plane element)."""
    return radius ** 2 * height / (height ** 2 + distance ** 2) ** 1.5


class ShadowCatcher(cli.ProgramTest):
    def shadow(self, document, *options, name="s"):
        """{(x, z): share of shadow} of the pixels, over a white backdrop."""
        self.write(f"{name}.json", document)
        self.succeed("render", f"{name}.json", "-o", f"{name}.pfm", "--quiet", *options)
        width, height, values = read_pfm(self.read(f"{name}.pfm"))
        return {((column + 0.5) * PIXEL - VIEW / 2, VIEW / 2 - (row + 0.5) * PIXEL): 1 - values[3 * (row * width + column)]
                for row in range(height) for column in range(width)}

    def assert_follows(self, shadow, expected, least):
        """The pixels outside of the ball, in rings: the mean over a ring is that of `expected` within 4 standard errors, which are
        those of coins, and a pixel in 0.002 for what a pixel's width makes of its middle."""
        rings = {}
        for (x, z), value in shadow.items():
            distance = math.hypot(x, z)
            if distance > least:
                rings.setdefault(int(distance * 2), []).append((value, expected(distance)))
        self.assertGreater(len(rings), 4)
        for ring, pairs in rings.items():
            found, wanted = (sum(pair[i] for pair in pairs) / len(pairs) for i in range(2))
            error = math.sqrt(wanted * (1 - wanted) / (256 * len(pairs)))
            self.assertLess(abs(found - wanted), 4 * error + 0.01 * wanted + 0.0005, (ring, found, wanted))

    def test_a_ball_under_a_uniform_sky(self):
        """Standing on the ground and above it; in every form of the kernel, lamps on and off, at any level of light."""
        for height in (1.0, 2.0):
            self.assert_follows(self.shadow(ball(height)), lambda d: covered(1, height, d), 1.3)
        for options in (("--kernel", "sample"), ("--precision", "double"), ("--light-sampling", "off"), ("--sampler", "independent"), ("--effects", "all")):
            self.assert_follows(self.shadow(ball(1.0), *options), lambda d: covered(1, 1, d), 1.3)
        self.assert_follows(self.shadow(ball(1.0, background=[1e-6, 0, 0])), lambda d: covered(1, 1, d), 1.3)

    def test_a_lamp_at_infinity(self):
        """A disc at an angle of 45 degrees: its shadow lies aside, and is all dark or, beside a sky, as dark as the light it keeps away."""
        sun = {"direction": [1, 1, 0], "half_angle": 5, "radiance": [20, 20, 20]}
        shadow = self.shadow(ball(3.0, background={"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": [sun]}))
        for (x, z), value in shadow.items():
            along, across = (x + 3) / math.sqrt(2), z  # in the disc's direction, the shadow's rim is a circle
            if math.hypot(x, z) < 1.3:
                continue
            if math.hypot(along, across) < 0.5:
                self.assertEqual(value, 1, (x, z))
            if math.hypot(along, across) > 1.7:
                self.assertEqual(value, 0, (x, z))
        background = {"bottom": [0.3, 0.3, 0.3], "top": [0.3, 0.3, 0.3], "discs": [{**sun, "visible_to_camera": False}]}
        shadow = self.shadow(ball(3.0, background=background))
        of_sun, of_sky = 20 * math.sin(math.radians(5)) ** 2 * math.sqrt(0.5), 0.3  # irradiance over pi
        middle = [(value, covered(1, 3, math.hypot(x, z))) for (x, z), value in shadow.items() if math.hypot((x + 3) / math.sqrt(2), z) < 0.5]
        wanted = sum(of_sun + of_sky * share for _, share in middle) / len(middle) / (of_sun + of_sky)
        self.assertAlmostEqual(sum(value for value, _ in middle) / len(middle), wanted, delta=0.02)
        aside = [(value, covered(1, 3, math.hypot(x, z))) for (x, z), value in shadow.items() if x > 1.5]
        wanted = sum(of_sky * share for _, share in aside) / len(aside) / (of_sun + of_sky)
        self.assertAlmostEqual(sum(value for value, _ in aside) / len(aside), wanted, delta=0.004)

    def test_light_that_is_not_there(self):
        """Without light from above nothing is kept away: there is no shadow."""
        below = {"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": [{"direction": [0.3, -1, 0], "half_angle": 20, "radiance": [5, 5, 5]}]}
        for background in ([0, 0, 0], below):
            shadow = self.shadow(ball(1.0, background=background))
            self.assertEqual({value for (x, z), value in shadow.items() if math.hypot(x, z) > 1.3}, {0})

        # Seen from the side, the ground right below a ball that hangs above it: there what stands overhead hides nothing either.
        aside = dict(ABOVE, lookfrom=[0, 50, 50], vup=[0, 1, 0])
        for background in ([0, 0, 0], below):
            shadow = self.shadow(ball(4.0, camera=aside, background=background))
            self.assertEqual({value for (x, y), value in shadow.items() if math.hypot(x, y) < 0.6}, {0})

    def test_a_gradient(self):
        """A sky that is dark overhead, as (1 - cos) / 2, where a ball hides a cone of half angle 25.8 degrees: 2.8 % of the light."""
        sine = 1 / 2.294
        samples = 16384
        camera = dict(ABOVE, lookfrom=[0, 50, 50], vup=[0, 1, 0], view_height=0.4, samples_per_pixel=samples)
        document = ball(2.294 * 10, radius=10.0, camera=camera, background={"bottom": [1, 1, 1], "top": [0, 0, 0]})
        document["camera"]["image_width"] = 8
        document["camera"]["image_height"] = 8
        self.write("s.json", document)
        self.succeed("render", "s.json", "-o", "s.pfm", "--quiet")
        _, _, values = read_pfm(self.read("s.pfm"))
        found = 1 - sum(values[::3]) / 64
        least = math.sqrt(1 - sine ** 2)

        def light(c):  # from 0 to the cosine c
            return c ** 2 / 4 - c ** 3 / 6
        wanted = (light(1) - light(least)) / light(1)
        error = math.sqrt(wanted * (1 - wanted) / (64 * samples))
        self.assertLess(abs(found - wanted), 4 * error + 0.003 * wanted, (found, wanted))

    def test_alpha(self):
        """Without a backdrop the shadow is black, and as opaque as it is dark: over white, that is the picture with a white backdrop."""
        white = self.shadow(ball(1.0))
        self.write("none.json", ball(1.0, backdrop="none"))
        self.succeed("render", "none.json", "-o", "none.png", "--bit-depth", 16, "--quiet")
        _, _, bits, channels, rows, _ = read_png(self.read("none.png"))
        self.assertEqual((bits, channels), (16, 4))
        some = 0
        for (x, z), value in white.items():
            column, row = round((x + VIEW / 2) / PIXEL - 0.5), round((z + VIEW / 2) / PIXEL - 0.5)
            r, g, b, alpha = rows[row][4 * column:4 * column + 4]
            if math.hypot(x, z) < 1.3:
                continue
            self.assertEqual((r, g, b), (0, 0, 0))
            self.assertAlmostEqual(alpha / 65535, value, delta=1e-4)
            some += alpha > 0
        self.assertGreater(some, 300)

    def test_things_are_lit_as_without_it(self):
        """Only camera rays meet it, and only from above; so pictures of what stands on it have the same bits."""
        down = ball(1.0, camera={"lookfrom": [0, 1, 5], "lookat": [0, 1, 0], "vfov": 14})  # nothing but the ball
        below = ball(1.0, camera={"lookfrom": [0, -3, 5], "lookat": [0, 0, 0], "vfov": 40})
        for document in (down, below):
            pictures = []
            for catcher in ({"height": 0}, False):
                self.shadow(dict(document, shadow_catcher=catcher))
                pictures.append(self.read("s.pfm"))
            self.assert_same(*pictures)

    def test_where_it_lies(self):
        """Under the lowest sphere, along the background's up, or below particles along theirs, whatever else is there."""
        def same(one, other):
            pictures = []
            for name, document in (("a", one), ("b", other)):
                self.write(f"{name}.json", document)
                self.succeed("render", f"{name}.json", "-o", "x.pfm", "--quiet", "--width", 24, "--spp", 16)
                pictures.append(self.read("x.pfm"))
            self.assert_same(*pictures)
            self.write("c.json", dict(one, shadow_catcher=False))
            self.succeed("render", "c.json", "-o", "x.pfm", "--quiet", "--width", 24, "--spp", 16)
            self.assert_different(pictures[0], self.read("x.pfm"))
        spheres = [{"center": [0, 2, 0], "radius": 1, "material": "m"}, {"center": [0, 1, 2], "radius": 0.25, "material": "m", "center_end": [0, 0.75, 2]}]
        view = {"fit": "scene", "view": [1, 1, 1]}
        plain = cli.scene(24, 24, spheres=spheres, camera=view, backdrop=[1, 1, 1])
        same(dict(plain, shadow_catcher=True), dict(plain, shadow_catcher={"height": 0.5, "up": [0, 3, 0]}))
        tilted = dict(plain, background={"up": [0, 0, 5]})
        same(dict(tilted, shadow_catcher=True), dict(tilted, shadow_catcher={"height": -1, "up": [0, 0, 1]}))
        self.write("p.csv", "x,y,z,radius\n0,0,1,0.5\n1,0,2,0.5\n")
        particles = {"camera": {"fit": "particles"}, "lighting": "studio", "particles": [{"file": "p.csv"}], "materials": GREY,
                     "spheres": [{"center": [0, 0, -50], "radius": 1, "material": "m"}]}
        same(dict(particles, shadow_catcher=True), dict(particles, shadow_catcher={"height": 0.5, "up": [0, 0, 1]}))

    def test_files_of_particles(self):
        self.write("p.csv", "x,y,z,radius\n0,0,1,0.5\n1,0,2,0.5\n")
        self.succeed("render", "p.csv", "--set", "shadow_catcher=true", "--set", "backdrop=none", "-q", "-o", "p.png", "--width", 24, "--spp", 16)
        self.succeed("scene", "p.csv", "--set", "shadow_catcher=true", "-o", "p.json")
        self.assertEqual(json.loads(self.read("p.json"))["shadow_catcher"], True)
        self.succeed("scene", "p.json", "--set", 'shadow_catcher={"height":-2.5,"up":[0,0,1]}', "-o", "q.json")
        self.assertEqual(json.loads(self.read("q.json"))["shadow_catcher"], {"height": -2.5, "up": [0, 0, 1]})
        self.assertNotIn("shadow_catcher", json.loads(self.succeed("scene", "p.csv").stdout))

    def test_explained(self):
        self.write("s.json", ball(1.0))
        self.assertIn("the scene has a shadow catcher", self.succeed("explain", "s.json").stdout.decode())
        said = [self.succeed("explain", "s.json", "--pixel", "16,12", "--first-sample", i).stdout.decode() for i in range(12)]
        self.assertTrue(any("the shadow catcher, in shadow" in text for text in said))
        self.assertTrue(any("the shadow catcher, lit: the backdrop" in text for text in said))

    def test_films_of_another_ground_are_not_added(self):
        for name, height in (("a", 0), ("b", 0.25)):
            self.write(f"{name}.json", ball(1.0, shadow_catcher={"height": height}))
            self.succeed("render", f"{name}.json", "-o", f"{name}.bpa", "--quiet", "--spp", 4, "--first-sample", 4 * (name == "b"))
        self.fail_with(2, "merge", "a.bpa", "b.bpa", "-o", "c.png")

    def test_refused(self):
        for value, says in [(3, "true, false or"), ({"up": [0, 0, 0]}, "the direction that is up"), ({"heigt": 1}, 'did you mean "height"'),
                            ({"height": 2e12}, "from -1e12 to 1e12"), ({"height": "low"}, "number"), ({"up": [1, 2]}, "three")]:
            self.write("s.json", ball(1.0, shadow_catcher=value))
            self.fail_with(2, "render", "s.json", says=["shadow_catcher", says])
        with open(self.path("sky.pfm"), "wb") as file:
            file.write(b"PF\n2 1\n-1.0\n" + bytes(24))
        self.write("s.json", ball(1.0, background={"image": "sky.pfm"}))
        self.fail_with(2, "render", "s.json", says=["shadow_catcher", "beside an image"])


if __name__ == "__main__":
    cli.main()
