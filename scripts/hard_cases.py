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
CALL = re.compile(r"HARD_CASE_AT_(?:MOST|LEAST)\(\s*(\d+),\s*\"([^\"]+)\"")
HEAD = """# Hard cases

What makes global illumination unstable, and what the tests assert about it. `scripts/hard_cases.py` makes
this table from records of the tests. *Measured* is the worst figure of all calls, on lavapipe. Rows marked
*full* run in `./test.sh --full` alone.

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


def figures_of_the_tests():
    for path in sorted((root / "tests").rglob("*.c")):
        text = path.read_text(encoding="utf-8")
        for row, what in CALL.findall(text):
            yield int(row), what, str(path.relative_to(root / "tests"))


def figures_of_the_document():
    row = None
    for line in document.read_text(encoding="utf-8").splitlines():
        fields = [field.strip() for field in line.split("|")[1:-1]]
        if len(fields) == 6 and fields[0].isdigit():
            row = int(fields[0])
        elif len(fields) == 6 and fields[0] == "" and row is not None:
            yield row, fields[2].removesuffix(" (*full*)"), fields[5].split("`")[1]


def differences():
    tests, listed = set(figures_of_the_tests()), set(figures_of_the_document())
    for row, what, file in sorted(tests - listed):
        yield f"row {row}, {what}: asserted in {file}, not in the document"
    for row, what, file in sorted(listed - tests):
        yield f"row {row}, {what}: in the document, not asserted in {file}"
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
