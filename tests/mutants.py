#!/usr/bin/env python3
"""Puts faults into changed lines, one at a time, and reports which of them no unit test catches.

    tests/mutants.py [--since COMMIT] [--seconds N] [--most N] [--build FOLDER] [FILE...]

Compares with COMMIT (HEAD~20), and uses changed lines of src/**/*.cpp and tools/**/*.cpp, or all lines of each FILE.
First come the faults that tests/mutations.txt has for these files, then operators, comparisons and constants. Ends
after N seconds (600) or N faults (30). The build is not modified: a changed file is compiled and linked in a folder
beside bin/. Exits with 1 if a fault of the list is not caught, or if fewer than half of at least 10 others are, since
some faults change nothing visible, or if the test that caught a fault fails without it too.
"""
import argparse
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

source = pathlib.Path(__file__).resolve().parent.parent
SWAPS = {" < ": " >= ", " > ": " <= ", " <= ": " > ", " >= ": " < ", " == ": " != ", " != ": " == ", " + ": " - ",
         " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ", " && ": " || ", " || ": " && ",
         "std::min(": "std::max(", "std::max(": "std::min(", "true": "false", "false": "true"}


ENOUGH = 10  # fewer faults tell nothing about the tests; how many are tried depends on the machine


def said(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=source, **options).stdout


def changed_lines(since):
    """{file: numbers of the lines that differ from that commit, or from the oldest that a shallow clone has}"""
    if subprocess.run(["git", "rev-parse", "-q", "--verify", since + "^{commit}"], capture_output=True, cwd=source).returncode:
        since = said("git", "rev-list", "HEAD").split()[-1]
    lines, file = {}, None
    for line in said("git", "diff", "-U0", since, "--", "src/*.cpp", "tools/*.cpp").splitlines():
        if line.startswith("+++ "):
            file = line[6:]
        elif (hunk := re.match(r"@@ \S+ \+(\d+)(?:,(\d+))? @@", line)) and (source / file).exists():
            first = int(hunk[1])
            lines.setdefault(file, set()).update(range(first, first + int(hunk[2] or 1)))
    return lines


def mutants_of(line):
    """The line with one fault each. Quoted words and comments stay."""
    code = re.sub(r'"(\\.|[^"\\])*"|//.*', lambda m: "\0" * len(m[0]), line)
    if re.match(r"\s*(#|namespace|template|using|static_assert|throw)", code):
        return
    for word, other in SWAPS.items():
        for m in re.finditer(rf"(?<!\w){word}(?!\w)" if word.isalpha() else re.escape(word), code):
            yield line[:m.start()] + other + line[m.end():]
    for m in re.finditer(r"(?<![\w.<\[])(\d+)(?=\.?\d*f?\b)", code):
        yield line[:m.start()] + ("1" if m[0] == "0" else str(2 * int(m[0]))) + line[m.end():]
    for m in re.finditer(r"(?<=[( ])!(?=[\w(])", code):
        yield line[:m.start()] + line[m.end():]


def generated(lines):
    """(name, file, text, None), in an order that depends only on the lines; one fault per line first."""
    found = []
    for file, numbers in lines.items():
        text = (source / file).read_text().splitlines(keepends=True)
        for number in numbers:
            if number > len(text):
                continue
            named = {f"{file}:{number}: {m.strip()}": m for m in mutants_of(text[number - 1])}
            by_chance = {hashlib.sha256(name.encode()).digest(): name for name in named}
            for turn, (chance, name) in enumerate(sorted(by_chance.items())):
                whole = "".join(text[:number - 1] + [named[name]] + text[number:])
                found.append((turn, chance, (name, file, whole, None)))
    return [fault for _, _, fault in sorted(found)]


def listed(lines):
    """The faults of tests/mutations.txt in these files, except those that tests other than the unit tests catch."""
    for row in (source / "tests/mutations.txt").read_text().splitlines():
        name, file, what, instead, *by = row.split("|") if "|" in row and row[0] != "#" else [None] * 4
        if file in lines and not re.match(r"[a-z]+\.", (by or [""])[0]):
            yield name, file, said("sed", f"s|{what}|{instead}|", file), (by or ["*"])[0] or "*"


class Tests:
    """The unit tests, with one of their files recompiled."""

    def __init__(self, build, scratch):
        self.build, self.scratch = build, scratch
        self.rules = json.loads(said("ninja", "-C", build, "-t", "compdb").partition("[")[2].join(["[", ""]))
        self.link = next(r for r in self.rules if r["output"] == "bin/sparselens-tests")["command"]

    def prepared(self, file, text):
        """Whether it compiles. Also False if the tests do not contain that file."""
        rule = next((r for r in self.rules if r["file"] == str(source / file) and r["output"].endswith(".o")), None)
        archive = rule and next((r["output"] for r in self.rules
                                 if r["output"].endswith(".a") and rule["output"] in r["command"].split()), None)
        if not archive or archive not in self.link.split():
            return False
        aside, object_ = self.scratch / pathlib.Path(file).name, self.scratch / pathlib.Path(rule["output"]).name
        aside.write_text(text)
        compile_ = rule["command"].replace(f"-c {source / file}", f"-iquote {(source / file).parent} -c {aside}")
        compile_ = re.sub(r" -M[FT] \S+| -MD| -Werror\b", "", compile_).replace(f"-o {rule['output']}", f"-o {object_}")
        # The linker takes the first definition, and leaves out the archive's own.
        link = self.link.replace("-o bin/sparselens-tests ", f"-o {self.scratch}/tests {object_} ")
        return all(subprocess.run(c, shell=True, cwd=self.build, capture_output=True).returncode == 0 for c in (compile_, link))

    def failing(self, filters, limit, program="tests"):
        """The first test that fails; None: no test does; "no time": they did not end."""
        try:
            ran = subprocess.run([self.scratch / program, "--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter={filters}"],
                                 capture_output=True, text=True, errors="replace", timeout=limit, cwd=self.build)
        except subprocess.TimeoutExpired:
            return "no time"
        failed = re.search(r"\[  FAILED  \] ([\w./]+)", ran.stdout)
        return failed[1] if failed else "all ended early" if ran.returncode else None

    def fails_anyway(self, test):
        """Whether a test fails without a fault."""
        unchanged = self.scratch / "unchanged"
        if not unchanged.exists():
            unchanged.hardlink_to(self.build / "bin" / "sparselens-tests")
        return "." in test and self.failing(test, 600, "unchanged") is not None

    def beside(self, file):
        """The suites of the test file that mirrors this file."""
        mirror = source / "tests" / re.sub(r"^(src|tools)/", "", file).replace(".cpp", "_test.cpp")
        suites = set(re.findall(r"^TEST\w*\((\w+),", mirror.read_text(), re.M)) if mirror.exists() else set()
        return ":".join(f"{s}.*:*/{s}.*" for s in sorted(suites))


def main():
    parser = argparse.ArgumentParser()
    for name, default in {"since": "HEAD~20", "seconds": 600, "most": 30, "build": "build"}.items():
        parser.add_argument(f"--{name}", default=default, type=type(default))
    parser.add_argument("files", nargs="*")
    asked = parser.parse_args()
    lines = ({f: range(1, len((source / f).read_text().splitlines()) + 1) for f in asked.files} or changed_lines(asked.since))
    end, caught, tried, code = time.monotonic() + asked.seconds, 0, 0, 0
    with tempfile.TemporaryDirectory(dir=source / asked.build) as scratch:  # lib/ is beside it, as it is beside bin/
        tests = Tests(source / asked.build, pathlib.Path(scratch))
        for name, file, text, filters in [*listed(lines), *generated(lines)]:
            if time.monotonic() > end or tried == asked.most:
                break
            if not tests.prepared(file, text):
                continue
            # The mirroring tests are quick, so if they do not end, the fault is the reason.
            first = None if filters or not tests.beside(file) else tests.failing(tests.beside(file), 600)
            by = first or tests.failing(filters or "*", max(end - time.monotonic(), 1))
            if by == "no time" and not first:  # a fault with which no test ends, or the time is up
                break
            if by and tests.fails_anyway(by):
                sys.exit(f"mutants.py: {by} fails without a fault too")
            print(f"{'caught' if by else 'NOT CAUGHT'}: {name}{f' ({by})' if by else ''}", flush=True)
            if filters:
                code |= not by
            else:
                tried, caught = tried + 1, caught + bool(by)
    print(f"mutants: {caught} of {tried} caught; {len(lines)} files changed")
    return code or (tried >= ENOUGH and 2 * caught < tried)


if __name__ == "__main__":
    sys.exit(main())
