"""The command line: help, commands, options, values; what is wrong is named, with the nearest that is right."""

import re

from cli import ProgramTest, main, scene


class Help(ProgramTest):
    def commands(self):
        text = self.succeed("--help").stdout.decode()
        block = text.split("Commands:\n")[1].split("\n\n")[0]
        return re.findall(r"^  (\w+)", block, re.M)

    def test_top(self):
        result = self.succeed("--help")
        self.assertEqual(result.errors, "")
        self.assertEqual(result.stdout, self.succeed("help").stdout)
        self.assertEqual(result.stdout, self.succeed("-h").stdout)
        for word in ("render", "merge", "devices", "generate", "Exit codes"):
            self.assertIn(word, result.stdout.decode())

    def test_every_command(self):
        for command in self.commands():
            with self.subTest(command):
                text = self.succeed("help", command).stdout.decode()
                self.assertEqual(text, self.succeed(command, "--help").stdout.decode())
                self.assertTrue(text.startswith(f"Usage: ballpark {command}"), text)
                for line in text.split("\n"):
                    if not line.startswith("  ballpark"):
                        self.assertLessEqual(len(line), 80, line)

    def test_help_needs_nothing_else(self):
        self.succeed("merge", "--help")
        self.fail_with(2, "help", "rendr", says="did you mean render?")

    def test_version(self):
        self.assertRegex(self.succeed("--version").stdout.decode(), r"\Aballpark \d+\.\d+\.\d+ \(commit [0-9a-f]")
        self.fail_with(2, "devices", "--version", says="ballpark --version")

    def test_help_to_a_full_disk(self):
        with open("/dev/full", "wb") as full:
            self.fail_with(1, "help", stdout=full, says="No space left")


class Wrong(ProgramTest):
    def test_commands(self):
        self.fail_with(2, says="ballpark --help")
        self.fail_with(2, "rendr", says=["\"rendr\"", "did you mean render?"])
        self.fail_with(2, "xyzzyplugh", says="ballpark --help")
        self.fail_with(2, "--seed", "3", says="must follow a command")

    def test_operands(self):
        self.fail_with(2, "render", says="ballpark render: missing SCENE")
        self.fail_with(2, "check", "a.json", "b.json", says="\"b.json\"")
        self.fail_with(2, "devices", "x", says="\"x\"")
        self.fail_with(2, "generate", says="cover|field")
        self.fail_with(2, "generate", "cower", says="\"cower\"")
        self.fail_with(2, "merge", "a.bpa", says="--output")

    def test_unknown_options(self):
        self.fail_with(2, "render", "x.json", "--widht", "3", says=["--widht", "did you mean --width?"])
        self.fail_with(2, "render", "x.json", "--widht=3", says=["--widht;", "did you mean --width?"])
        self.fail_with(2, "render", "--sedd", "x.json", says="did you mean --seed?")
        self.fail_with(2, "render", "x.json", "--xyzzyplugh", says="ballpark help render")
        self.fail_with(2, "render", "x.json", "-x", says="unknown option -x")
        self.fail_with(2, "render", "x.json", "-qx", says="unknown option -x")

    def test_options_of_other_commands(self):
        self.fail_with(2, "merge", "x.bpa", "--spp", "3", says=["merge: unsupported option --spp", "render"])
        self.fail_with(2, "render", "x.json", "--grid", "3", says=["render: unsupported option --grid", "generate"])
        self.fail_with(2, "generate", "field", "--grid", "3", says="--grid")
        self.fail_with(2, "generate", "cover", "--count", "3", says="--count")

    def test_missing_and_unwanted_values(self):
        self.fail_with(2, "render", "x.json", "--spp", says="--spp needs a value")
        self.fail_with(2, "render", "x.json", "-o", says="--output needs a value")
        self.fail_with(2, "render", "x.json", "--output=", says="--output needs a value")
        self.fail_with(2, "render", "x.json", "--quiet=3", says="--quiet takes no value")

    def test_values(self):
        whole = ["", "-1", "+1", "1.5", "1x", " 1", "1 ", "0x", "0xg", "ten", "1e3", "18446744073709551616"]
        bad = {
            "--spp": whole + ["0", "67108865"],
            "--width": whole + ["0", "65536", "1000000000"],
            "--depth": whole + ["1000001"],
            "--seed": whole + ["0x10000000000000000"],
            "--first-sample": whole + ["4294967296"],
            "--error": ["", "0", "-1", "101", "1%%", "nan", "inf", "0x1", "1e999", "ten", "1,5"],
            "--time": ["", "0", "-1", "nan", "inf", "10x", "1e9"],
            "--precision": ["half", "Single", "dbl"],
            "--math": ["exact"],
            "--numerics": ["good"],
            "--sampler": ["random"],
            "--effects": ["none"],
            "--kernel": ["auto"],
            "--transfer": ["gamma"],
            "--exposure": ["", "101", "-101", "nan", "1stop"],
            "--format": ["jpg", "PNG"],
        }
        for option, values in bad.items():
            for value in values:
                with self.subTest(option=option, value=value):
                    self.fail_with(2, "render", "x.json", option, value, says=option)
        for value in ["1x", "-1", "5001"]:
            self.fail_with(2, "generate", "cover", "--grid", value, says="--grid")
        self.fail_with(2, "generate", "cover", "--edition", "2", says=["--edition", "1, 3, 3rust or 4"])
        for value in ["0", "134217729"]:
            self.fail_with(2, "generate", "field", "--count", value, says="--count")

    def test_samples_past_the_last_number(self):
        self.write("s.json", scene())
        last = ["--first-sample", "4294967295", "-o", "x.png"]
        self.fail_with(2, "render", "s.json", *last, "--spp", "2",
                       says=["--first-sample 4294967295 leaves room for 1 sample per pixel", "--spp asks for 2",
                             "--spp 1 or less", "--first-sample 4294967294 or less"])
        self.fail_with(2, "render", "s.json", *last,
                       says=["--first-sample 4294967295", "the scene's \"samples_per_pixel\" asks for 8", "--spp 1 or less",
                             "--first-sample 4294967288 or less"])
        self.succeed("render", "s.json", *last, "--spp", "1")
        self.succeed("render", "s.json", *last, "--error", "1")
        self.succeed("render", "s.json", *last, "--time", "100")
        self.succeed("explain", "s.json", "--first-sample", "4294967295", "--pixel", "1,1")

    def test_two_outputs_of_one_name(self):
        self.write("s.json", scene())
        self.fail_with(2, "render", "s.json", "-o", "a.png", "--stats", "a.png", says="--stats")
        self.fail_with(2, "render", "s.json", "-o", "-", "--stats", "-", says="--stats")
        self.fail_with(2, "render", "s.json", "-o", "a.png", "--error-map", "a.png", says="--error-map")
        self.fail_with(2, "render", "s.json", "--error-map", "a.exr", says=".png")
        self.fail_with(2, "render", "s.json", "-o", "a.jpg", says=["--output", ".png, .pdf, .svg, .ppm, .pfm, .exr or .bpa"])
        self.assertEqual(self.files(), ["s.json"])

    def test_the_last_of_two_wins(self):
        self.write("s.json", scene())
        self.fail_with(2, "render", "s.json", "--width", "0", "--width", "4", says="--width")
        self.succeed("generate", "cover", "--grid", "3", "--grid", "1", "-o", "a.json", "-q")
        self.succeed("generate", "cover", "--grid", "1", "-o", "b.json", "-q")
        self.assertEqual(self.read("a.json"), self.read("b.json"))

    def test_operand_after_two_dashes(self):
        self.fail_with(2, "render", "--", "--spp", says="--spp: cannot open")


class Generate(ProgramTest):
    def test_cover(self):
        result = self.succeed("generate", "cover", "-o", "cover.json")
        self.assertEqual(self.files(), ["cover.json"])
        self.assertIn("484 spheres", result.errors)
        self.assertEqual(result.stdout, b"")
        piped = self.succeed("generate", "cover", "-o", "-", "--quiet")
        self.assertEqual(piped.stdout, self.read("cover.json"))
        self.assertEqual(piped.errors, "")
        other = self.succeed("generate", "cover", "-o", "-", "-q", "--seed", "2").stdout
        self.assertNotEqual(piped.stdout, other)
        self.assertEqual(other, self.succeed("generate", "cover", "-o", "-", "-q", "--seed", "0x2").stdout)
        for edition in ("1", "3", "3rust", "4"):
            self.succeed("generate", "cover", "--grid", "2", "--edition", edition, "-o", edition + ".json")

    def test_field(self):
        self.succeed("generate", "field", "--count", "1000", "--seed", "5", "-o", "a.ply")
        self.succeed("generate", "field", "--count", "1000", "--seed", "5", "-o", "b.ply", "-q")
        data = self.read("a.ply")
        self.assertTrue(data.startswith(b"ply\n"))
        self.assertIn(b"element vertex 1000\n", data)
        self.assertEqual(data, self.read("b.ply"))

    def test_unwritable(self):
        self.fail_with(1, "generate", "cover", "-o", "no/such/folder.json", says="no/such/folder.json")
        self.fail_with(1, "generate", "field", "-o", "no/such/folder.ply", says="no/such/folder.ply")
        self.assertEqual(self.files(), [])


if __name__ == "__main__":
    main()
