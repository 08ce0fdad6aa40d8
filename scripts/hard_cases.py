#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes docs/hard_cases.md from the records of the tests.

Usage: hard_cases.py RECORDS        writes docs/hard_cases.md
       hard_cases.py --check        says where the document and the tests differ, as a test case in TAP

RECORDS comes from the tests: SDFGI_TEST_HARD_CASES=RECORDS ./test.sh --full (an absolute path)."""
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parent.parent
document = root / "docs" / "hard_cases.md"
CALL = re.compile(r"HARD_CASE_AT_(MOST|LEAST)\(\s*(\d+),\s*\"([^\"]+)\",")
LITERAL = re.compile(r"[\d.e+\-*/ ()]+")
# What runs in full alone: a test that skips otherwise or is in a list of slow ones, and a figure.
FULL = r"(?:getenv\(\"SDFGI_TEST_FULL\"\)|scroll_is_full\(\))"
SKIPS = re.compile(r"if \(!" + FULL + r"\)\s*skip\(\);")
ONLY = re.compile(r"if \(" + FULL + r"\)\s*$")
SLOW = re.compile(r"CMUnitTest (?:slow|full)\[\] = \{(.*?)\};", re.DOTALL)
FUNCTION = re.compile(r"^static [^;{}=]*?\b(\w+)\([^;{}]*\)\n\{\n.*?^\}", re.MULTILINE | re.DOTALL)
HEAD = """# Hard cases

What makes global illumination unstable, and what the tests assert about it. `scripts/hard_cases.py` makes
this table from records of the tests. *Measured* is the worst figure of all calls. Figures marked *full* are
those of `./test.sh --full`, on an NVIDIA H100; all others are of lavapipe.

| # | case | figure | measured | limit | test |
|---|---|---|---|---|---|
"""


def catalogue():
    rows = []
    for line in (root / "tests" / "hard_cases.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            number, case, promise = (field.strip() for field in line.split("|"))
            rows.append((int(number), case, promise))
    return rows


def worst_of(records):
    """(row, what, suite) -> (measured, sense, limit, file, test)"""
    worst = {}
    for line in records.read_text(encoding="utf-8").splitlines():
        row, suite, file, test, what, measured, sense, limit = line.split("\t")
        key, measured = (int(row), what, suite), float(measured)
        sign = 1 if sense == "at most" else -1
        if key not in worst or sign * measured > sign * worst[key][0]:
            worst[key] = (measured, sense, float(limit), file.split("tests/")[-1], test)
    return worst


def table(worst):
    for number, case, promise in catalogue():
        yield f"| {number} | **{case}**: {promise.removeprefix('restated: ')} | | | | |\n"
        figures = sorted(key for key in worst if key[0] == number)
        for key in figures:
            measured, sense, limit, file, test = worst[key]
            if key[2] == "full" and worst.get((*key[:2], "default"), (None,))[0] == measured:
                continue
            mark = " (*full*)" if key[2] == "full" else ""
            yield f"| | | {key[1]}{mark} | {measured:.4g} | {sense} {limit:.4g} | `{file}`: `{test}` |\n"


def limit_of(text, call):
    """The last argument of a call, as the document has it; None: no literal, and no name of one in the file"""
    depth, start, end = 1, call.end(), call.end()
    while depth:
        depth += {"(": 1, ")": -1}.get(text[end], 0)
        if text[end] == "," and depth == 1:
            start = end + 1
        end += 1
    limit = text[start : end - 1].strip()
    named = re.search(r"^#define " + re.escape(limit) + r" +(.*?)(?: */\*.*)?$", text, re.MULTILINE)
    limit = named[1] if named else limit
    return f"{eval(limit):.4g}" if LITERAL.fullmatch(limit) else None


def functions_of(text):
    """(name, start, end) of each"""
    return [(found[1], found.start(), found.end()) for found in FUNCTION.finditer(text)]


def slow_spans(text):
    """Where tests stand that run in full alone."""
    slow = "".join(SLOW.findall(text))
    for name, start, end in functions_of(text):
        if SKIPS.search(text, start, end) or f"({name})" in slow:
            yield start, end


def figures_of_the_tests():
    """(row, what, file) -> its limits, and whether each call runs in full alone"""
    figures = {}
    for path in sorted((root / "tests").rglob("*.c")):
        text, file = path.read_text(encoding="utf-8"), str(path.relative_to(root / "tests"))
        slow = list(slow_spans(text))
        for call in CALL.finditer(text):
            limit = limit_of(text, call)
            in_full = ONLY.search(text[: call.start()]) or any(a < call.start() < b for a, b in slow)
            limits = figures.setdefault((int(call[2]), call[3], file), [])
            limits.append((limit and f"at {call[1].lower()} {limit}", bool(in_full)))
    return figures


def figures_of_the_document():
    """The same: limits, and whether the mark is there"""
    row, figures = None, {}
    for line in document.read_text(encoding="utf-8").splitlines():
        fields = [field.strip() for field in line.split("|")[1:-1]]
        if len(fields) == 6 and fields[0].isdigit():
            row = int(fields[0])
        elif len(fields) == 6 and fields[0] == "" and row is not None:
            what = fields[2].removesuffix(" (*full*)")
            limits = figures.setdefault((row, what, fields[5].split("`")[1]), [])
            limits.append((fields[4], what != fields[2]))
    return figures


def stale(asserted, listed):
    """What the document says of a figure, and its calls do not."""
    limits = {limit for limit, _ in asserted}
    for limit, _ in listed:
        if None not in limits and limit not in limits:
            yield f"{limit} in the document, {' or '.join(sorted(limits))} in the test"
    if all(in_full for _, in_full in asserted) != all(mark for _, mark in listed):
        yield "the mark (*full*) and whether the test runs in full alone differ"


def differences():
    tests, listed = figures_of_the_tests(), figures_of_the_document()
    for row, what, file in sorted(tests.keys() - listed.keys()):
        yield f"row {row}, {what}: asserted in {file}, not in the document"
    for row, what, file in sorted(listed.keys() - tests.keys()):
        yield f"row {row}, {what}: in the document, not asserted in {file}"
    for key in sorted(tests.keys() & listed.keys()):
        for text in stale(tests[key], listed[key]):
            yield f"row {key[0]}, {key[1]}: {text}"
    asserted = {row for row, _, _ in tests}
    for number, case, promise in catalogue():
        if number not in asserted and not promise.startswith("waits:"):
            yield f"row {number}, {case}: nothing asserts it"


def check():
    found = list(differences())
    print("1..1")
    print(("not ok" if found else "ok") + " 1 - the_catalogue_of_hard_cases_is_what_tests_assert")
    for text in found:
        print(f"# {text}")
    return 1 if found else 0


if len(sys.argv) != 2:
    sys.exit(__doc__)
if sys.argv[1] == "--check":
    sys.exit(check())
document.write_text(HEAD + "".join(table(worst_of(pathlib.Path(sys.argv[1])))), encoding="utf-8")
