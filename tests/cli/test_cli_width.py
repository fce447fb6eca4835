"""Lines fit the terminal, or 80 columns where its width is not known; --wide leaves them as they are; --quiet leaves
nothing but errors."""

import os
import re

from cli import ProgramTest, SOURCE, deep, main, scene
from terminal import Terminal

UNKNOWN = {"COLUMNS": ""}
LONG = "a material of a rather long name, so that lines are long"
# A study compiles a dozen kernels: all commands but one share those of a diffuse scene.
DIFFUSE = {LONG: {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]}}
GLASS = {LONG: {"type": "dielectric", "refraction_index": 1.5}}
COMMANDS = [
    ("check", "s.json", "--width", "8", "--spp", "16", "--margin", "50%"),
    ("check", "s.json", "--width", "8", "--spp", "16", "--margin", "50%", "--device", "all"),
    ("cost", "s.json", "--width", "8", "--time", "0.3"),
    ("devices",),
    ("bench", "s.json", "--rounds", "1", "--time", "0.05"),
    ("explain", "s.json", "lamps.json"),
    ("explain", "s.json", "--pixel", "8,8"),
    ("render", "glass.json", "--fresnel", "exact", "--threads", "1000", "--depth", "1"),
    ("render", "s.json", "--set", "camera.lookat=[0,9,-1]", "-o", "empty.png"),
    ("merge", "a.bpa", "-o", "a.exr"),
    ("generate", "cover", "-o", "cover.json"),
]


class Width(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, materials in ("s.json", DIFFUSE), ("glass.json", GLASS):
            self.write(name, scene(materials=materials, spheres=[{"center": [0, 0, -1], "radius": 0.5, "material": LONG}]))
        os.symlink(os.path.join(SOURCE, "scenes/lamps.json"), self.path("lamps.json"))

    def run_command(self, arguments, *more, **options):
        if arguments[0] == "merge":
            self.succeed("render", "s.json", "--spp", "2", "-o", "a.bpa", "-q")
        return self.succeed(*arguments, *more, **options)

    def check(self, text, columns, what):
        self.assertTrue(text.strip(), what)
        for line in text.splitlines():
            self.assertLessEqual(len(line), columns, (what, line))

    @deep
    def test_pipe(self):
        for arguments in COMMANDS:
            with self.subTest(arguments=arguments):
                result = self.run_command(arguments, environment=UNKNOWN)
                self.check(result.stdout.decode() + result.errors, 80, arguments)

    def test_told_width(self):
        for columns in 60, 70:
            result = self.succeed("explain", "s.json", "lamps.json", environment={"COLUMNS": str(columns)})
            self.check(result.stdout.decode(), columns, columns)
            self.assertGreater(max(map(len, result.stdout.decode().splitlines())), columns - 20, columns)

    def test_terminal(self):
        for columns in 50, 80, 110:
            for arguments in ("devices",), ("explain", "s.json"), ("render", "s.json", "--depth", "1"), ("help", "render"):
                screen = Terminal(self, *arguments, columns=columns)
                self.assertEqual(screen.finish(), 0, screen.seen)
                text = re.sub(r"\r[^\n]*\x1b\[K", "", screen.seen.decode().replace("\r\n", "\n"))
                # One word alone may be longer than a narrow terminal: the name of a device.
                for line in text.splitlines():
                    self.assertTrue(len(line) <= columns or columns == 50 and "  -" not in line.strip(), (columns, line))

    def test_errors(self):
        """Wrapped on a terminal, with commands in one piece; one line where a program may read it."""
        missing = ("render", "a folder with blanks " * 6 + "and no end.json")
        for arguments in missing, ("merge",), ("view", "s.json"):
            environment = {"BALLPARK_WINDOW": "/nowhere.so", "COLUMNS": "60"}
            screen = Terminal(self, *arguments, columns=60, environment=environment)
            self.assertNotEqual(screen.finish(), 0)
            lines = screen.seen.decode().replace("\r\n", "\n").splitlines()
            self.check("\n".join(lines), 60, arguments)
            piped = self.run_program(*arguments, environment=environment).errors
            self.assertEqual(len(piped.splitlines()), 1)
            self.assertEqual(" ".join(piped.split()), " ".join("\n".join(lines).split()))
        self.assertTrue(any("`ballpark render --show`" in line for line in lines), lines)
        wide = Terminal(self, *missing, "--wide", columns=60)
        wide.finish()
        self.assertEqual(len(wide.seen.splitlines()), 1, wide.seen)

    def test_words_stay_whole(self):
        """Wrapping loses nothing and adds nothing but line ends and indentation."""
        for arguments in ("explain", "s.json", "lamps.json"), ("explain", "s.json", "--pixel", "8,8"), ("help", "devices"), ("devices", "--help"):
            narrow = self.succeed(*arguments, environment={"COLUMNS": "40"}).stdout.decode()
            wide = self.succeed(*arguments, "--wide", environment={"COLUMNS": "40"}).stdout.decode()
            self.assertEqual(narrow.split(), wide.split())
            self.assertGreater(max(map(len, wide.splitlines())), 40)
            self.assertLess(max(map(len, narrow.splitlines())), 60)

    def test_wide(self):
        for arguments in ("devices",), ("bench", "s.json", "--rounds", "1", "--time", "0.05"):
            lines = self.succeed(*arguments, "--wide", environment=UNKNOWN).stdout.decode().splitlines()
            self.assertGreater(max(map(len, lines)), 80, arguments)
            self.assertNotIn("", lines)

    @deep
    def test_pasted_commands(self):
        """Advice is a command to be pasted, also where it is wrapped."""
        self.write("s" * 60 + ".json", scene())
        said = self.succeed("cost", "s" * 60 + ".json", "--width", "8", "--time", "0.3", environment=UNKNOWN).stdout.decode()
        commands = re.findall(r"(?m)^ +(ballpark render (?:.*\\\n)*.*)$", said)
        self.assertTrue(commands)
        for command in commands:
            words = command.replace("\\\n", " ").split()[1:]
            self.assertIn("--spp", words)
            words[words.index("--spp") + 1] = "1"
            self.succeed(*words, "--width", "4")

    def test_quiet(self):
        for arguments in COMMANDS:
            with self.subTest(arguments=arguments):
                result = self.run_command(arguments, "--quiet")
                self.assertEqual((result.stdout, result.errors), (b"", ""))

    def test_quiet_errors(self):
        self.assertRegex(self.run_program("explain", "none.json", "-q").errors, "^ballpark: none.json: cannot open it")


class Help(ProgramTest):
    """The help of a command tells its own defaults, and those alone."""

    def option(self, command, name):
        text = self.succeed("help", command, environment=UNKNOWN).stdout.decode()
        return " ".join(re.search(rf"(?ms)^ +(?:-\w, )?--{name} .*?(?=^ +(?:-\w, |    )--|\n\n|\Z)", text)[0].split())

    def test_defaults(self):
        for command, name, usual in [("render", "spp", "the scene's number"), ("check", "spp", "1024"),
                                     ("cost", "time", "1m"), ("bench", "time", "5s"), ("render", "sampler", "sobol"),
                                     ("bench", "sampler", "independent"), ("generate", "seed", "1"),
                                     ("render", "seed", "0"), ("check", "width", "64, or the scene's width if that is less")]:
            self.assertTrue(self.option(command, name).endswith(f"(default: {usual})"), (command, self.option(command, name)))

    def test_no_other_command(self):
        for command in "render", "check", "explain", "cost", "merge", "bench", "devices", "generate":
            text = self.succeed("help", command).stdout.decode()
            options = text[text.index("Options:"):text.index("Examples:")]
            self.assertNotRegex(options, r"\b(render|check|explain|cost|merge|bench|generate): ")
            self.check_lines(text)

    def check_lines(self, text):
        for line in text.splitlines():
            self.assertLessEqual(len(line), 80, line)

    def test_defaults_are_true(self):
        """As far as a document tells them."""
        self.write("s.json", scene(300))
        self.assertEqual(self.option("check", "spp")[-5:-1], "1024")
        stats = self.succeed("render", "s.json", "--spp", "1", "--stats", "-").stdout.decode()
        self.assertIn('"sampler": "sobol"', stats)
        self.assertIn('"seed": 0', stats)
        self.succeed("generate", "cover", "--seed", "1", "--grid", "11", "--edition", "4", "-o", "a.json")
        self.succeed("generate", "cover", "-o", "b.json")
        self.assert_same(self.read("a.json"), self.read("b.json"))


if __name__ == "__main__":
    main()
