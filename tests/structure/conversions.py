#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Where shaders turn floats into integers, as a test case in TAP: SPIR-V leaves the result undefined for NaN
and for what the integer cannot hold, so each place was looked at, and conversions.txt says why it is safe.
Usage: conversions.py LIST SHADER_HEADER..."""
import pathlib
import re
import sys

OP_NAME, OP_FUNCTION, OP_FTOU, OP_FTOS = 5, 54, 109, 110


def instructions(words):
    at = 5
    while at < len(words):
        count, code = words[at] >> 16, words[at] & 0xFFFF
        yield code, words[at + 1 : at + count]
        at += count


def text_of(words):
    return b"".join(word.to_bytes(4, "little") for word in words).split(b"\0")[0].decode()


def conversions_of(path):
    """{function: conversions} of one shader."""
    words = [int(word, 16) for word in re.findall(r"0x([0-9a-fA-F]{8})", path.read_text())]
    names, counts, function = {}, {}, None
    for code, operands in instructions(words):
        if code == OP_NAME:
            names[operands[0]] = text_of(operands[1:]).split("(")[0]
        elif code == OP_FUNCTION:
            function = names[operands[1]]
        elif code in (OP_FTOU, OP_FTOS):
            counts[function] = counts.get(function, 0) + 1
    return counts


def found(paths):
    counts = {}
    for path in paths:
        for function, count in conversions_of(path).items():
            shader = path.name.split(".")[0].removesuffix("_software").removesuffix("_textured")
            key = f"{shader}: main" if function == "main" else function
            counts[key] = max(count, counts.get(key, 0))
    return counts


def reviewed(path):
    counts = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            function, count, _ = (field.strip() for field in line.split("|"))
            counts[function] = int(count)
    return counts


def differences(listed, counts):
    for function in sorted(listed.keys() | counts.keys()):
        if listed.get(function, 0) != counts.get(function, 0):
            yield f"{function}: {counts.get(function, 0)} conversions, {listed.get(function, 0)} of them reviewed"


paths = [pathlib.Path(name) for name in sys.argv[2:] if re.search(r"\.(comp|vert|frag)\.h$", name)]
problems = list(differences(reviewed(pathlib.Path(sys.argv[1])), found(paths)))
print("1..1")
for problem in problems:
    print(f"# {problem}", file=sys.stderr)
print(f"{'not ok' if problems or not paths else 'ok'} 1 - hard_60_every_conversion_to_an_integer_was_reviewed")
