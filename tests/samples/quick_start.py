#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts the code of README.md's quick start into a frame that makes it a program. Usage: quick_start.py c|glsl
README FRAME OUTPUT. `@BEFORE@` in the frame becomes the code's directives, `@CODE@` the rest."""
import pathlib
import re
import sys

language, readme, frame, output = sys.argv[1:]
text = pathlib.Path(readme).read_text(encoding="utf-8")
embedding = text[text.index("\n## Embedding\n"):]
blocks = re.findall(rf"^```{language}\n(.*?)^```", embedding, re.S | re.M)
if not blocks:
    sys.exit(f"{readme}: no block of {language} below Embedding")
lines = blocks[0].splitlines()
parts = {"BEFORE": [line for line in lines if line.startswith("#")],
         "CODE": [line for line in lines if not line.startswith("#")]}
made = pathlib.Path(frame).read_text(encoding="utf-8")
for name, part in parts.items():
    if made.count(f"@{name}@") != 1:
        sys.exit(f"{frame}: @{name}@ does not stand there once")
    made = made.replace(f"@{name}@", "\n".join(part))
pathlib.Path(output).write_text(made, encoding="utf-8")
