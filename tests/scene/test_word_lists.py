"""Words stand in several places: the parsers' lists, the schema's enums, the command line, ballpark.h and Python. They are the same.

What a parser's list holds is asked of the program: each place of a document gets a word that nobody means, and the message lists what was
expected. Every list that the readers in host/formats choose from, and every enum of the schema, must stand in PLACES.
"""
import ast
import json
import pathlib
import re

import cli

ALIEN = "qqqqqq"


def texture(**members):
    return {"textures": {"t": members}}


def material(**members):
    return {"materials": {"m": members}}


def particles(**members):
    return {"particles": [dict(file="p.xyz", **members)]}


NOISE = {"type": "noise", "colors": [0, 1], "pattern": "wood"}
IMAGE = {"type": "image", "file": "i.png"}
GLASS = {"type": "dielectric", "refraction_index": 1.5}
# The schema's enum, the list that the reader in host/formats chooses from, and members of a document that has ALIEN there.
PLACES = [
    ("lighting", "bp_lighting_names", {"lighting": ALIEN}),
    ("transfer", "bp_transfer_names", {"transfer": ALIEN}),
    ("figure text", "bp_figure_text_names", {"figure": {"text": ALIEN}}),
    ("encoding", "encoding_names", {"background": {"image": "i.png", "encoding": ALIEN}}),
    ("camera pixel_sampling", "sampling_names", {"camera": {"pixel_sampling": ALIEN}}),
    ("camera projection", "bp_projection_names", {"camera": {"projection": ALIEN}}),
    ("camera fit", "fit_names", {"camera": {"fit": ALIEN}}),
    ("camera view", "bp_view_names", {"camera": {"fit": "scene", "view": ALIEN}}),
    ("texture type", "bp_texture_type_names", texture(type=ALIEN)),
    ("texture mapping", "bp_mapping_names", texture(type="checker", colors=[0, 1], mapping=ALIEN)),
    ("texture pattern", "bp_pattern_names", texture(**dict(NOISE, pattern=ALIEN))),
    ("texture axis", "bp_axis_names", texture(**NOISE, axis=ALIEN)),
    ("encoding", "encoding_names", texture(**IMAGE, encoding=ALIEN)),
    ("texture wrap", "bp_wrap_names", texture(**IMAGE, wrap=ALIEN)),
    ("material type", "type_names", material(type=ALIEN)),
    ("material scatter", "member->names", material(type="lambertian", albedo=[1, 1, 1], scatter=ALIEN)),
    ("material fuzz_shape", "member->names", material(type="metal", albedo=[1, 1, 1], fuzz_shape=ALIEN)),
    ("material fresnel", "member->names", material(**GLASS, fresnel=ALIEN)),
    ("material total_reflection", "member->names", material(**GLASS, total_reflection=ALIEN)),
    ("particles style", "style_names", particles(style=ALIEN)),
    ("particles radius", "words", particles(radius=ALIEN)),
    ("particles radius by", "radius_words", particles(radius={"by": ALIEN})),
    ("particles color", "words", particles(color=ALIEN)),
    ("particles color by", "color_words", particles(color={"by": ALIEN})),
    ("particles color map", "bp_colormap_names", particles(color={"column": "q", "map": ALIEN})),
]
# Options whose words belong to documents; a few leave out a word.
OPTIONS = {"lighting": ("lighting", set()), "projection": ("camera projection", set()), "transfer": ("transfer", set()),
           "fresnel": ("material fresnel", {"none"})}
# Python's lists, and the enumerations of ballpark.h whose values they count.
ENUMERATIONS = {"transfer": "BpTransfer", "format": "BpFormat", "device type": "BpDeviceType", "precision": "BpPrecision", "math": "BpMath",
                "numerics": "BpNumerics", "sampler": "BpSampler", "light_sampling": "BpLightSampling", "caustics": "BpCaustics", "roulette": "BpRoulette",
                "kernel": "BpKernelForm"}


def enums_of(node, names=(), found=None):
    """The schema's lists of words, by the members that lead to them: enums, and the constants of one member in all alternatives. What
    stands under a definition begins with the definition's name."""
    found = {} if found is None else found
    if isinstance(node, list):
        for element in node:
            enums_of(element, names, found)
    elif isinstance(node, dict):
        if "enum" in node:
            found.setdefault((*names, "enum"), []).append(node["enum"])
        if isinstance(node.get("const"), str):
            found.setdefault((*names, "const"), [[]])[0].append(node["const"])
        for name, child in node.items():
            if name in ("properties", "$defs"):
                for member, value in child.items():
                    enums_of(value, (*names, member), found)
            elif name not in ("if", "not", "enum"):
                enums_of(child, names, found)
    return found


class Words(cli.ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.schema = {}
        for (*names, _), lists in enums_of(json.loads(pathlib.Path(cli.SOURCE, "scenes/scene.schema.json").read_text())).items():
            lists = [words for words in map(set, lists) if len(words) > 1]  # one alone is no choice
            if lists:
                cls.schema.setdefault(" ".join(names), []).extend(lists)

    def words_of(self, members):
        """What the program expects where the members have ALIEN."""
        self.write("p.xyz", "1\n\nC 0 0 0\n")
        camera = dict({"image_width": 8}, **members.get("camera", {}))
        document = {"materials": {"m": {"type": "lambertian", "albedo": [1, 1, 1]}}, **members, "camera": camera}
        self.write("s.json", document)
        said = self.fail_with(2, "scene", "s.json", says=f'"{ALIEN}"').errors
        return re.findall(r'"([^"]+)"', said.split("expected ", 1)[1].split(";")[0])

    def test_schema(self):
        """Every enum of the schema has the words of the reader, in whatever order."""
        self.assertEqual(sorted(self.schema), sorted({place for place, _, _ in PLACES}))
        for place, _, members in PLACES:
            expected = set(self.words_of(members))
            self.assertGreater(len(expected), 1, place)
            for words in self.schema[place]:
                where = f"scenes/scene.schema.json, {place}"
                self.assertEqual(sorted(expected - words), [], f"{where}: add these to its enum, and entries to its oneOf if it has one")
                self.assertEqual(sorted(words - expected), [], f"{where}: no reader knows these")

    def test_no_list_is_forgotten(self):
        calls = set()
        for path in pathlib.Path(cli.SOURCE, "host/formats").glob("*.c"):
            calls.update(re.findall(r"bp_node_choice\(\s*&?\w+,\s*([\w>-]+)", path.read_text()))
        self.assertEqual(calls - {"const"}, {names for _, names, _ in PLACES})

    def test_options(self):
        said = self.succeed("help", "render").stdout.decode()
        for option, (place, missing) in OPTIONS.items():
            words = re.search(rf"--{option} ([a-z0-9|-]+)", said).group(1).split("|")
            self.assertEqual(set(words), self.schema[place][0] - missing, option)

    def test_python(self):
        """Python counts its words as the header counts the values that names.c gives these words."""
        text = pathlib.Path(cli.SOURCE, "python/ballpark/_library.py").read_text()
        lists = {name: ast.literal_eval(value) for name, value in re.findall(r"^([A-Z_]+) = (\[[^\]]+\]|\{[^}]+\})", text, re.M)}
        python = {"transfer": lists["TRANSFERS"], "format": lists["FORMATS"], "device type": lists["DEVICE_TYPES"], **lists["CHOICES"]}
        self.assertEqual(sorted(python), sorted(ENUMERATIONS))
        header = pathlib.Path(cli.SOURCE, "host/ballpark.h").read_text()
        word_of = dict(re.findall(r'X\((BP_\w+), "([^"]+)"\)', pathlib.Path(cli.SOURCE, "host/base/names.c").read_text()))
        for name, words in python.items():
            values = re.search(rf"typedef enum {ENUMERATIONS[name]} \{{([^}}]+)\}}", header).group(1)
            values = re.findall(r"\bBP_\w+", re.sub(r"/\*.*?\*/", "", values, flags=re.S))
            self.assertEqual(words, [word_of[value] for value in values], name)


if __name__ == "__main__":
    cli.main()
