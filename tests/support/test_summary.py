"""The last words of scripts/test: what is counted as passed, failed and skipped, with which reason."""
import pathlib
import tempfile
import unittest

import summary

CASE = '<testcase name="{}" status="{}">{}<system-out>{}</system-out></testcase>'


def case(name, status="run", inside="", output=""):
    return CASE.format(name, status, inside, output)


class Summary(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def stage(self, name, status, log="", cases=None):
        with open(self.folder / "stages", "a", encoding="utf-8") as file:
            file.write(f"{name} {status}\n")
        (self.folder / f"{name}.log").write_text(log, encoding="utf-8")
        if cases is not None:
            (self.folder / f"{name}.xml").write_text(f"<testsuite>{''.join(cases)}</testsuite>", encoding="utf-8")

    def lines(self):
        return list(summary.summarise(self.folder).lines())

    def test_all_is_well(self):
        self.stage("lint", 0, "lint: clean")
        self.stage("tests", 0, cases=[case("a"), case("b")])
        self.assertEqual(self.lines(), ["test: 3 passed, 0 failed, 0 skipped"])

    def test_a_failed_test_has_its_stage(self):
        self.stage("tests", 8, cases=[case("a"), case("b", "fail", '<failure message="Failed"/>')])
        self.assertEqual(self.lines(), ["test: failed: b (tests): Failed", "test: 1 passed, 1 failed, 0 skipped"])

    def test_what_failed_tests_said_last_comes_at_the_end(self):
        said = "".join(f"line {n}\n" for n in range(50)) + "\n"
        self.stage("tests", 8, cases=[case("a", output="a passes"), case("b", "fail", '<failure message="Failed"/>', said),
                                      case("c", "fail", '<failure message="Timeout"/>', "waits"), case("d", "fail")])
        self.assertEqual(self.lines(), ["test: the last lines of b (tests):", *(f"    line {n}" for n in range(20, 50)),
                                        "test: the last lines of c (tests):", "    waits", "test: failed: b (tests): Failed",
                                        "test: failed: c (tests): Timeout", "test: failed: d (tests): failed",
                                        "test: 1 passed, 3 failed, 0 skipped"])

    def test_of_many_failed_tests_ten_are_repeated(self):
        self.stage("tests", 8, cases=[case(f"t{n}", "fail", output=f"said {n}") for n in range(12)])
        self.assertEqual(len([line for line in self.lines() if line.startswith("    said")]), 10)
        self.assertEqual(len([line for line in self.lines() if line.startswith("test: failed: ")]), 12)

    def test_a_test_that_cannot_start_failed(self):
        self.stage("tests", 8, cases=[case("a", "notrun", '<skipped message="Unable to find executable"/>')])
        self.assertEqual(self.lines(), ["test: failed: a (tests): Unable to find executable",
                                        "test: 0 passed, 1 failed, 0 skipped"])

    def test_a_skipped_test_has_its_reason(self):
        skipped = '<skipped message="SKIP_RETURN_CODE=77"/>'
        self.stage("tests", 0, cases=[case("a", "notrun", skipped, "skipped: no device\nskipped: no device\n"),
                                      case("b", "notrun", skipped)])
        self.assertEqual(self.lines(), ["test: skipped: a (tests): no device",
                                        "test: skipped: b (tests): it does not say why",
                                        "test: 0 passed, 0 failed, 2 skipped"])

    def test_a_part_that_was_skipped_is_named(self):
        self.stage("tests", 0, cases=[case("a", output="ran 3\nskipped: no terminal\nskipped: no linker\n")])
        self.assertEqual(self.lines(), ["test: skipped: a (tests): no terminal (a part of it)",
                                        "test: skipped: a (tests): no linker (a part of it)",
                                        "test: 1 passed, 0 failed, 2 skipped"])

    def test_a_stage_that_ran_no_test(self):
        self.stage("setup", 0)
        self.stage("tests", 1, "does not build")
        self.stage("fuzz", 77, "fuzz: skipped: no clang")
        self.assertEqual(self.lines(), ["test: skipped: fuzz: no clang", "test: the last lines of tests:", "    does not build",
                                        "test: failed: tests: exit code 1",
                                        "test: 1 passed, 1 failed, 1 skipped"])

    def test_ctest_fails_by_itself(self):
        self.stage("tests", 2, cases=[case("a")])
        self.assertEqual(self.lines()[0], "test: failed: tests: ctest ended with exit code 2")

    def test_no_test_was_chosen(self):
        self.stage("lint", 0)
        self.stage("tests", 0, cases=[])
        self.assertEqual(self.lines()[-1], "test: 1 passed, 1 failed, 0 skipped")

    def test_a_check_that_lint_left_out(self):
        self.stage("lint", 0, "lint: shellcheck left out: not installed\nlint: clean")
        self.assertEqual(self.lines(), ["test: skipped: shellcheck (lint): not installed",
                                        "test: 1 passed, 0 failed, 1 skipped"])

    def test_the_longest(self):
        cases = [case(f"t{n}").replace("<testcase", f'<testcase time="{n}.2"') for n in range(8)]
        self.stage("tests", 0, cases=cases[:4])
        self.stage("sanitizers", 0, cases=cases[:2] + cases[4:])
        self.assertEqual(self.lines()[0], "test: longest: t7 (sanitizers) 7 s, t6 (sanitizers) 6 s, t5 (sanitizers) 5 s, "
                                          "t4 (sanitizers) 4 s, t3 (tests) 3 s")
        self.assertEqual(len(self.lines()), 2)

    def test_nothing_at_all(self):
        self.assertEqual(self.lines(), ["test: 0 passed, 0 failed, 0 skipped"])


if __name__ == "__main__":
    unittest.main()
