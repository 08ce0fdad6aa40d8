#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The rules of CONTRIBUTING.md that a program can check, as test cases in TAP. Usage: structure.py ROOT"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
CODE = (".c", ".h", ".cpp", ".glsl", ".comp", ".vert", ".frag")
FOLDERS = ("modules", "shaders", "runtime", "samples", "tests", "editor_stub")
MAX_COLUMNS, MAX_LINES = 110, 500
MEDIAN_WORDS, P90_WORDS = 18, 30

# Folders of modules/sdfgi, each of which may include those before it.
OWNERS = ("core", "pass", "scene", "volume", "view", "frame")


def sources():
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in CODE or path.name == "meson.build":
                yield path


def lines_that_are_too_long():
    for path in sources():
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if len(line) > MAX_COLUMNS:
                yield f"{path.relative_to(root)}:{number}: {len(line)} columns"


def files_that_are_too_long():
    for path in sources():
        count = len(path.read_text(encoding="utf-8").splitlines())
        if count > MAX_LINES:
            yield f"{path.relative_to(root)}: {count} lines"


def includes_against_the_order():
    base = root / "modules" / "sdfgi"
    for path in sorted(base.rglob("*.[ch]")):
        owner = path.relative_to(base).parts[0]
        if owner not in OWNERS:
            continue
        for name in re.findall(r'^#include "([^"]+)"', path.read_text(encoding="utf-8"), re.M):
            other = name.split("/")[0]
            if other in OWNERS and OWNERS.index(other) > OWNERS.index(owner):
                yield f"{path.relative_to(root)}: includes {name}"
            elif (base / name).is_file() and name not in ("pass_table.h", "resource_table.h") and "/" not in name:
                yield f"{path.relative_to(root)}: includes {name} of the folder above"


def editor_includes_beyond_public_headers():
    """Quoted names are its own; others are public, of Dear ImGui, or of the language."""
    public = {f"sdfgi/{path.name}" for path in (root / "modules" / "sdfgi" / "include" / "sdfgi").glob("*.h")}
    own = {path.name for path in (root / "editor_stub").glob("*.h")}
    for path in sorted((root / "editor_stub").glob("*.[ch]*")):
        text = path.read_text(encoding="utf-8")
        for name in re.findall(r'^\s*#\s*include "([^"]+)"', text, re.M):
            if name not in own:
                yield f"{path.relative_to(root)}: includes {name}"
        for name in re.findall(r"^\s*#\s*include <([^>]+)>", text, re.M):
            if name not in public and not re.fullmatch(r"\w+|imgui\.h|backends/imgui_\w+\.h", name):
                yield f"{path.relative_to(root)}: includes {name}"


def sentences(text):
    text = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text):
        if re.match(r"\s*(#|\||!\[|<)", block):
            continue
        block = re.sub(r"^\s*(?:[-*]|\d+\.) ", "", block)
        block = re.sub(r"\(https?:[^)]*\)|\]\([^)]*\)", " ", " ".join(block.split()))
        for sentence in re.split(r"(?<=[.:;!?])\s+(?=[A-Z`(\[*_0-9])", block):
            words = [w for w in sentence.split() if re.search(r"\w", w)]
            if words:
                yield words


def documents_with_long_sentences():
    paths = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").glob("*.md"))]
    for path in paths:
        counts = sorted(len(words) for words in sentences(path.read_text(encoding="utf-8")))
        if not counts:
            continue
        median, p90 = counts[len(counts) // 2], counts[int(0.9 * len(counts))]
        if median > MEDIAN_WORDS or p90 > P90_WORDS:
            yield f"{path.relative_to(root)}: words a sentence: median {median}, 90 % {p90}"


CLAIMS = {
    "no_line_is_longer_than_110_columns": lines_that_are_too_long,
    "no_file_is_longer_than_500_lines": files_that_are_too_long,
    "owners_include_one_way": includes_against_the_order,
    "the_editor_sees_public_headers_alone": editor_includes_beyond_public_headers,
    "sentences_of_documents_are_short": documents_with_long_sentences,
}

print(f"1..{len(CLAIMS)}")
for index, (claim, check) in enumerate(CLAIMS.items(), 1):
    problems = list(check())
    for problem in problems:
        print(f"# {problem}", file=sys.stderr)
    print(f"{'not ok' if problems else 'ok'} {index} - {claim}")
