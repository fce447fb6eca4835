"""Small files as people have them, each of which once went wrong: files/NAME/, and in cases.json what is right and why.

A case passes if one of its "right" alternatives holds. An alternative may have: "rc", the exit code, or "not 0"; "match" and
"absent", regular expressions that the program's output must and must not contain; "same" and "differs", another file of the
folder, rendered with "same_options" or the case's options, whose picture must be equal or different; "mean_not", a linear
colour and a tolerance that the mean of the picture must be away from.

Run as: python3 test_cases.py PROGRAM SOURCE_DIR
"""
import json
import os
import re

from cli import ProgramTest, SOURCE, main
from pfm import read_pfm

HERE = os.path.join(SOURCE, "tests", "cases")


class Cases(ProgramTest):
    def render(self, folder, file, options, out):
        done = self.run_program("render", os.path.join(HERE, "files", folder, file), "--width", "48", "--spp", "4", "--wide",
                                "-o", out, *options)
        # Messages begin with the file's name, which patterns name without its folder.
        text = (done.stdout.decode() + done.errors).replace(os.path.join(HERE, "files", folder) + os.sep, "")
        return done.returncode, text

    def picture(self, case, file, options):
        code, text = self.render(case["name"], file, options, "other.pfm")
        self.assertEqual(code, 0, text)
        return self.read("other.pfm")

    def fault(self, case, right, code, text):
        """What is not as `right` has it; None where all is."""
        if "rc" in right and (code <= 0 if right["rc"] == "not 0" else code != right["rc"]):
            return f"exit code {code}"
        for member, wanted in (("match", True), ("absent", False)):
            for pattern in right.get(member, []):
                if (re.search(pattern, text) is not None) != wanted:
                    return f"{'no' if wanted else 'a'} match of {pattern!r}"
        for member, wanted in (("same", True), ("differs", False)):
            if member in right:
                other = self.picture(case, right[member], right.get("same_options", case.get("options", [])))
                if (other == self.read("picture.pfm")) != wanted:
                    return f"the picture {'differs from' if wanted else 'is the same as'} that of {right[member]}"
        if "mean_not" in right:
            numbers = read_pfm(self.read("picture.pfm"))[2]
            means = [sum(numbers[c::3]) / len(numbers[c::3]) for c in range(3)]
            if all(abs(mean - wrong) <= right["mean_not"][3] for mean, wrong in zip(means, right["mean_not"])):
                return f"the mean is {means}"
        return None

    def test_cases(self):
        with open(os.path.join(HERE, "cases.json")) as file:
            cases = json.load(file)
        self.assertEqual(sorted(case["name"] for case in cases), sorted(os.listdir(os.path.join(HERE, "files"))))
        for case in cases:
            with self.subTest(case["name"]):
                code, text = self.render(case["name"], case["file"], case.get("options", []), "picture.pfm")
                faults = [self.fault(case, right, code, text) for right in case["right"]]
                self.assertIn(None, faults, f"{case['what']}\n{text}")


if __name__ == "__main__":
    main()
