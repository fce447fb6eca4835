"""The page of `ballpark cost` without a browser: it is one file that fetches nothing, carries the document that --json
writes, and the pictures; and nothing that a scene is called breaks out of it."""
import json
import re

from page import SCENE, TITLE, PageTest, crop_images, decode_png, embedded
from cli import main


class Page(PageTest):
    def test_page(self):
        result = self.study(SCENE, 4)
        source = self.read("page.html").decode()
        self.assertNotRegex(source, r"""(?i)https?:|<script[^>]*src|@import|url\(|(?:src|href)="(?!data:)""")
        self.assertIn("default-src 'none'", source)
        self.assertRegex(source, r"(?s)<noscript>.*scripts are switched off.*</noscript>")
        self.assertNotIn("{{study}}", source)
        self.assertTrue(source.startswith("<!DOCTYPE html>") and source.endswith("</html>\n"))
        self.assertEqual(json.loads(embedded(source, "study")), result)
        self.assertEqual(result["title"], TITLE)
        self.check_escapes(source)
        self.check_pictures(json.loads(embedded(source, "crops")), result)

    def check_escapes(self, source):
        """Three elements open and three close, whatever the title says; and the template is not filled twice."""
        self.assertNotIn("<", embedded(source, "study"))
        self.assertIn("\\u003c/script>\\u003c!-- \\u003cscript> {{crops}}", source)
        self.assertEqual(len(re.findall(r"<script", source)), 3)
        self.assertEqual(len(re.findall(r"</script", source)), 3)
        self.assertEqual(source.count("{{"), 1)

    def check_pictures(self, crops, result):
        """A crop and a map of every count, of the truth, and of every other configuration."""
        counts = [point["samples"] for point in result["series"][0]["points"]]
        names = ["base"] * len(counts) + ["truth"] + [s["name"] for s in result["series"][1:]]
        images = crop_images(crops)
        self.assertEqual(len(images), 2 * len(names))
        self.assertEqual((crops["width"], crops["height"]), (48, 48))
        self.assertEqual(len(crops["scale"]), 25)
        self.assertLess(int(crops["scale"][0][1:], 16), int(crops["scale"][-1][1:], 16))
        means = []
        for number, (_, kind, data) in enumerate(images):
            width, height, channels, rows = decode_png(data)
            self.assertEqual((width, height, channels), (48, 48, 3))
            # Where nothing but noise is wrong, a fast machine's map is nearly black: few shades are left.
            name, is_map = names[number // 2], kind == "map"
            noise_alone = is_map and name in ("truth", "no approximations", "exact Fresnel")
            shades = len({row[i:i + 3] for row in rows for i in range(0, len(row), 3)})
            self.assertGreater(shades, 3 if noise_alone else 50, name)
            means.append(sum(map(sum, rows)) / (3 * width * height))
        # Maps of more samples are darker: the error falls, until Schlick's is all that is left. How many counts
        # there are is a matter of the machine's speed and of what its kernel cache holds; two there are in any case.
        maps = dict(zip(counts, means[1::2]))
        for count, next_count in zip(counts, counts[1:]):
            self.assertLess(maps[next_count], (0.97 if count < 64 else 1.01) * maps[count], (count, maps))
        if 64 in maps:
            self.assertLess(maps[64], 0.8 * maps[4])


if __name__ == "__main__":
    main()
