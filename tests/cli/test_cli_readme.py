"""What README.md and docs/USING.md show is what the program does: the scene, the error, the commands. README's figures are those of
the documents that it names, which scripts write."""

import json
import os
import re
import shlex
import textwrap

from cli import SOURCE, ProgramTest, deep, main

SMALL = {"render": ["--width", "8", "--spp", "32"], "check": ["--width", "8", "--spp", "64", "--margin", "50"],
         "cost": ["--time", "0.2", "--width", "16"]}


class Readme(ProgramTest):
    def setUp(self):
        super().setUp()
        self.text, self.using = (self.document(name) for name in ("README.md", "docs/USING.md"))
        os.symlink(os.path.join(SOURCE, "scenes"), self.path("scenes"))

    @staticmethod
    def document(name):
        with open(os.path.join(SOURCE, name), encoding="utf-8") as file:
            return file.read()

    def scene(self):
        """The document under "A scene", as a person would copy it."""
        block = re.search(r"(?m)^    \{ \"camera\":.*\n(?:    .*\n)*", self.text)[0]
        return textwrap.dedent(block)

    def test_scene(self):
        self.write("scene.json", self.scene())
        document = json.loads(self.scene())
        said = self.succeed("explain", "scene.json").stdout.decode()
        self.assertIn(f"{len(document['spheres'])} spheres", said)

    def test_error(self):
        """The mistake that README quotes, made in the scene that stands above it."""
        quoted = re.search(r"(?m)^    (ballpark: scene\.json:.*)$", self.text)[1]
        self.write("scene.json", self.scene().replace('"lookfrom"', '"lookform"'))
        self.fail_with(2, "explain", "scene.json", says=quoted + "\n")

    def run_commands(self, wanted):
        """The commands of the page, the large ones at a small size; those for a terminal or a screen have tests of
        their own (test_cli_preview, test_view)."""
        self.write("scene.json", self.scene())
        lines = re.findall(r"(?m)^    build/release/ballpark (.*?)(?: +#.*)?$", self.text + self.using)
        self.assertGreater(len(lines), 16)
        chosen = [words for words in map(shlex.split, lines)
                  if wanted(words) and words[0] != "view" and "--show" not in words]
        self.assertTrue(chosen)
        for words in chosen:
            if "--pixel" not in words:
                words += SMALL.get(words[0], [])
            self.succeed(*words)

    def test_commands(self):
        self.run_commands(lambda words: words[0] != "cost")

    @deep
    def test_cost(self):
        """It compiles a dozen kernels."""
        self.run_commands(lambda words: words[0] == "cost")

    def test_camera_members_are_those_of_the_grammar(self):
        with open(os.path.join(SOURCE, "scenes/scene.schema.json"), encoding="utf-8") as file:
            known = set(re.findall(r'"([a-z_]+)"', file.read()))
        words = set(re.findall(r"`([a-z_]+)`", self.text + self.using))
        self.assertEqual({word for word in words if "_" in word or word.endswith("fov")} - known, set())

    def test_figures_are_those_of_the_documents(self):
        """The first number of each pair is README's, the other that of the document that it names."""
        text = " ".join(self.text.split())
        for said, name, measured in (
                (r"on the cover takes (\d+) seconds", "COST", r"\| the cover, .*exact Fresnel, \d+ samples: \*\*(\d+) s\*\*"),
                (r"gets below ([\d.]+) %", "COST", r"<!-- figure cover floor -->([\d.]+) %"),
                (r"Of (ten million rays)", "NUMERICS", r"seen on (ten million rays)"),
                (r"a (false hit) or miss more than 1e-5", "NUMERICS", r"(false hit)s and false misses more than 1e-5 from "
                 r"the rim \| 0 \| 0 \| 0 \|"),
                (r"all effects takes ([\d.]+) % longer", "EFFECTS", r"\| cover \|.*\+([\d.]+) % \|")):
            found = re.search(measured, self.document(f"docs/{name}.md"))
            self.assertIsNotNone(found, measured)
            self.assertEqual(re.search(said, text)[1], found[1], said)


if __name__ == "__main__":
    main()
