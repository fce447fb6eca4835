"""The last words of the mutants: what was not killed stands at the end, where a log that was cut off still has it."""
import unittest

import test_mutants
from mutants import check


def row(name, outcome, said):
    return {"name": name, "outcome": outcome, "said": said, "layer": "1 exact", "trial": "a trial", "origin": ""}


class LastWords(unittest.TestCase):
    def test_all_were_killed(self):
        self.assertEqual(test_mutants.last_words([row("a", "killed", "failed")], []), [])

    def test_what_survived_or_did_not_build_is_named_with_what_was_said(self):
        rows = [row("a", "SURVIVED", "passed"), row("b", "killed", "failed"), row("c", "ERROR", "it does not build")]
        title, *lines = test_mutants.last_words(rows, [])
        self.assertEqual(title, "2 mutants were not killed:")
        self.assertEqual([" ".join(line.split()) for line in lines],
                         ["SURVIVED a 1 exact a trial: passed", "ERROR c 1 exact a trial: it does not build"])

    def test_a_trial_that_fails_on_the_product_is_named(self):
        controls = test_mutants.Controls.__new__(test_mutants.Controls)
        controls.results = {check("glass"): ("killed", "z = 9", []), check("metal"): ("SURVIVED", "z = 1", [])}
        failed = ["CONTROL killed: glass, 16 samples: z = 9"]
        self.assertEqual(test_mutants.last_words([], controls.failures()), failed)


if __name__ == "__main__":
    unittest.main()
