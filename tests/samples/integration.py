#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/integration.md and the sample hosts against what they promise, as test cases in TAP. Usage:
integration.py ROOT"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
samples = root / "samples"
guide = (root / "docs" / "integration.md").read_text(encoding="utf-8")
MAX_GI_LINES, MAX_MINIMAL_LINES = 100, 150
HOSTS = {"forward": ("forward_host.cpp", "forward_host.frag"),
         "deferred": ("deferred_host.c", "deferred_shade.comp", "deferred_gbuffer.frag")}
# Ways to light that a host shows side by side. A reader takes one of them.
WAYS = {"forward": ("",), "deferred": ("views", "gather")}
MARK = re.compile(r"/\* GI(?: with (\w+))? (begins|ends) \*/")


def split(name, way=None):
    """Lines between GI begins and GI ends, without those of other ways if one is given, and lines outside."""
    inside, outside, marks = [], [], []
    for line in (samples / name).read_text(encoding="utf-8").splitlines():
        mark = MARK.fullmatch(line.strip())
        if mark and mark[2] == "begins" and bool(marks) == bool(mark[1]):
            marks.append(mark[1])
        elif mark and mark[2] == "ends" and marks and marks.pop() == mark[1]:
            continue
        elif mark:
            raise ValueError(f"{name}: marks are not in turn: {line}")
        elif not marks:
            outside.append(line)
        elif way is None or marks[-1] in (None, way):
            inside.append(line)
    if marks:
        raise ValueError(f"{name}: a mark is not closed")
    return inside, outside


def hosts_that_take_too_many_lines():
    for host, way in ((host, way) for host, ways in WAYS.items() for way in ways):
        lines = [line for name in HOSTS[host] for line in split(name, way)[0] if line.strip()]
        if not 50 <= len(lines) <= MAX_GI_LINES:
            yield f"{host} {way}: {len(lines)} lines about the library"
        print(f"# {host} {way}: {len(lines)} lines about the library")
    count = len((samples / "minimal_host.c").read_text(encoding="utf-8").splitlines())
    if count > MAX_MINIMAL_LINES:
        yield f"minimal_host.c has {count} lines"


def lines_about_the_library_that_are_not_marked():
    """Names of the library outside of the marks, but for what comments say."""
    names = {name for host in HOSTS.values() for name in host}
    names |= {path.name for path in samples.glob("sample_*")}
    for name in sorted(names):
        code = re.sub(r"/\*.*?\*/", "", "\n".join(split(name)[1]), flags=re.S)
        for line in code.splitlines():
            if "sdfgi" in line.lower().replace('"libsdfgi"', ""):
                yield f"{name}: {line.strip()}"


def headers_that_an_installed_copy_lacks():
    """Hosts include public headers, those of their own, and those of the language and of Vulkan."""
    public = {f"sdfgi/{path.name}" for path in (root / "modules/sdfgi/include/sdfgi").glob("*.h")}
    for names in HOSTS.values():
        text = (samples / names[0]).read_text(encoding="utf-8")
        for name in re.findall(r"^#include <([^>]+)>", text, re.M):
            if name not in public and "/" in name:
                yield f"{names[0]}: {name}"
        for name in re.findall(r'^#include "([^"]+)"', text, re.M):
            if not (samples / name).is_file() and not name.endswith("_spirv.h"):
                yield f"{names[0]}: {name}"


def codes_that_the_guide_does_not_tell():
    """Every message of the public headers stands in a table of symptoms, or where a healthy start is told."""
    header = (root / "modules/sdfgi/include/sdfgi/messages.h").read_text(encoding="utf-8")
    codes = set(re.findall(r"^    X\((\w+), ", header, re.M))
    if len(codes) < 20:
        yield f"{len(codes)} codes were found in messages.h"
    told = guide[guide.index("\n## When the picture is wrong\n"):guide.index("\n## Checklist\n")]
    rows = set(re.findall(r"^\| `(\w+)` \| ", told, re.M)) | set(re.findall(r"`([A-Z_]+)`", told[:1200]))
    yield from (f"{code} is not told" for code in sorted(codes - rows))
    yield from (f"{code} is told and does not exist" for code in sorted(set(re.findall(
        r"^\| `([A-Z_]+)` \| ", told, re.M)) - codes))


def names_that_do_not_exist():
    """Names of the library in the guide are in its headers, its include, or its table of settings."""
    places = [*(root / "modules/sdfgi/include/sdfgi").glob("*"), *(root / "shaders/include").glob("*.glsl"),
              root / "modules/sdfgi/properties.c", root / "samples/meson.build"]
    known = "\n".join(path.read_text(encoding="utf-8") for path in places if path.is_file())
    files = {path.stem for path in [*(root / "shaders/include").iterdir(), *samples.iterdir()]}
    for name in sorted(set(re.findall(r"\bsdfgi_\w+", guide))):
        if not re.search(rf"\b{name}\b", known) and name not in files | {"sdfgi_main"}:
            yield name


def links_that_lead_nowhere():
    headings = {re.sub(r"[^a-z0-9 -]", "", line.lower()).strip().replace(" ", "-")
                for line in re.findall(r"^#+ (.*)$", guide, re.M)}
    for target in re.findall(r"\]\(([^)]+)\)", guide):
        path, _, anchor = target.partition("#")
        if path and not (root / "docs" / path).is_file():
            yield target
        if not path and anchor not in headings:
            yield target


CLAIMS = {
    "hosts_integrate_the_library_in_100_lines": hosts_that_take_too_many_lines,
    "all_lines_about_the_library_are_marked": lines_about_the_library_that_are_not_marked,
    "hosts_see_what_is_installed": headers_that_an_installed_copy_lacks,
    "the_guide_tells_every_health_code": codes_that_the_guide_does_not_tell,
    "names_in_the_guide_exist": names_that_do_not_exist,
    "links_of_the_guide_lead_somewhere": links_that_lead_nowhere,
}

failed = False
print(f"1..{len(CLAIMS)}")
for index, (claim, check) in enumerate(CLAIMS.items(), 1):
    problems = list(check())
    for problem in problems:
        print(f"# {problem}", file=sys.stderr)
    failed = failed or bool(problems)
    print(f"{'not ok' if problems else 'ok'} {index} - {claim}")
sys.exit(failed)
