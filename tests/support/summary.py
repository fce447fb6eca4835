#!/usr/bin/env python3
"""The last words of scripts/test: what failed, what was skipped and why, and one line that counts.

usage: summary.py RESULTS

In:   the folder RESULTS: `stages`, with a line "NAME EXIT_CODE" for each stage; NAME.log, what the stage said; for a
      stage that ran ctest also NAME.xml, its report in JUnit's form.
Out:  a line "test: longest: ..." with the tests that took most of the time, lines "test: skipped: ...", the last lines of
      what each failed test said, lines "test: failed: ...", then "test: N passed, N failed, N skipped". Exit code 1 if
      anything failed, or nothing passed. Whoever sees only the end of a long output sees why tests failed.

Each test of ctest counts as one, and so does each stage without a report: 77 is its exit code when it is skipped. A
line "skipped: REASON" of a test that passed says that a part of it was skipped: the test counts as passed, and the
part as skipped. So does a check of scripts/lint that it left out.
"""
import pathlib
import re
import sys
import xml.etree.ElementTree

REASON = re.compile(r"^(?:\w+: )?skipped: (.+)$", re.MULTILINE)
LEFT_OUT = re.compile(r"^lint: (.+) left out: (.+)$", re.MULTILINE)
LONGEST = 5  # tests, that whoever makes the suite slower sees it
LAST_LINES = 30  # of each failed test
FAILURES_SHOWN = 10  # whose lines are repeated


class Summary:
    def __init__(self):
        self.passed, self.failed, self.skipped = 0, [], []  # the lists: (name, why), of failures (name, why, what it said)
        self.seconds = []  # (seconds, name)
        self.reports, self.cases = 0, 0

    def add_passed(self, name, text):
        self.passed += 1
        self.skipped += [(name, f"{reason} (a part of it)") for reason in dict.fromkeys(REASON.findall(text))]

    def add_skipped(self, name, text):
        reasons = list(dict.fromkeys(REASON.findall(text)))
        self.skipped.append((name, "; ".join(reasons) or "it does not say why"))

    def add_report(self, stage, status, path, log):
        """The tests of one report. ctest's own failure, say at a test that it cannot start, is a failure as well."""
        failed_before = len(self.failed)
        self.reports += 1
        for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
            self.cases += 1
            name = f"{case.get('name')} ({stage})"
            text = case.findtext("system-out") or ""
            self.seconds.append((float(case.get("time", 0)), name))
            skipped = case.find("skipped")
            why = skipped.get("message", "") if skipped is not None else ""
            if case.get("status") == "run":
                self.add_passed(name, text)
            elif why.startswith("SKIP_"):
                self.add_skipped(name, text)
            elif case.get("status") == "disabled":
                self.skipped.append((name, "disabled"))
            else:
                failure = case.find("failure")
                self.failed.append((name, why or (failure.get("message") if failure is not None else "") or "failed", text))
        if status != 0 and len(self.failed) == failed_before:
            self.failed.append((stage, f"ctest ended with exit code {status}", log))

    def add_stage(self, stage, status, folder):
        log = folder / f"{stage}.log"
        text = log.read_text(encoding="utf-8", errors="replace") if log.exists() else ""
        report = folder / f"{stage}.xml"
        if report.exists():
            self.add_report(stage, status, report, text)
        elif status == 0:
            self.add_passed(stage, text)
        elif status == 77:
            self.add_skipped(stage, text)
        else:
            self.failed.append((stage, f"exit code {status}", text))
        self.skipped += [(f"{what} ({stage})", why) for what, why in LEFT_OUT.findall(text)]

    def lines(self):
        longest = [f"{name} {seconds:.0f} s" for seconds, name in sorted(self.seconds, reverse=True)[:LONGEST] if seconds >= 1]
        if longest:
            yield "test: longest: " + ", ".join(longest)
        yield from (f"test: skipped: {name}: {why}" for name, why in self.skipped)
        for name, _, said in self.failed[:FAILURES_SHOWN]:
            if last := said.rstrip().splitlines()[-LAST_LINES:]:
                yield f"test: the last lines of {name}:"
                yield from (f"    {line}" for line in last)
        yield from (f"test: failed: {name}: {why}" for name, why, _ in self.failed)
        yield f"test: {self.passed} passed, {len(self.failed)} failed, {len(self.skipped)} skipped"


def summarise(folder):
    summary = Summary()
    stages = folder / "stages"
    for line in stages.read_text().splitlines() if stages.exists() else []:
        name, status = line.split()
        summary.add_stage(name, int(status), folder)
    if summary.reports > 0 and summary.cases == 0:
        summary.failed.append(("ctest", "the options choose no test; those labelled deep need --all", ""))
    return summary


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    summary = summarise(pathlib.Path(sys.argv[1]))
    print("\n".join(summary.lines()), flush=True)
    return 1 if summary.failed or summary.passed == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
