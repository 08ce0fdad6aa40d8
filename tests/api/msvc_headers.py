#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Public headers by the rules of MSVC: clang compiles each as for Windows, as C11 and as C++17, without
extensions, and sees no other header than those of Vulkan and of a freestanding compiler. As test cases in TAP;
skipped where clang is missing. Usage: msvc_headers.py VULKAN_INCLUDE SDFGI_INCLUDE..."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

COMMON = ["--target=x86_64-pc-windows-msvc", "-ffreestanding", "-nostdlibinc", "-fsyntax-only",
          "-pedantic-errors", "-Wall", "-Wextra", "-Wgnu", "-Wmicrosoft", "-Werror"]
LANGUAGES = {"C11": ["-x", "c", "-std=c11"], "C++17": ["-x", "c++", "-std=c++17"]}
# What must be refused, or else the headers are not tested for it.
REFUSED = {"C11": ["struct list { int count; int items[0]; };", "#include <unistd.h>",
                   "int f(void);\n#define N ({ f(); })\nint g(void) { return N; }"],
           "C++17": ["void f(const float v[static 3]);", "#include <pthread.h>",
                     "struct point { int x, y; };\nstatic point p = { .x = 1 };\nint g() { return p.x; }"]}

clang = shutil.which("clang")
if not clang:
    print("1..0 # SKIP clang is not installed")
    sys.exit(0)
vulkan, includes = pathlib.Path(sys.argv[1]), [pathlib.Path(path) for path in sys.argv[2:]]
headers = sorted({path.name for include in includes for path in (include / "sdfgi").glob("*.h")})
scratch = tempfile.TemporaryDirectory()
for folder in ("vulkan", "vk_video"):  # alone: beside them lie the headers of this system
    (pathlib.Path(scratch.name) / folder).symlink_to(vulkan / folder)


def errors(language, source):
    """What clang says of a source; None if it has nothing to say."""
    words = [clang, *COMMON, *LANGUAGES[language], f"-isystem{scratch.name}"]
    words += [f"-I{include}" for include in includes] + ["-"]
    done = subprocess.run(words, input=source, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False)
    return done.stdout if done.returncode else None


def refused(language, header):
    text = errors(language, f"#include <sdfgi/{header}>\n#include <sdfgi/{header}>\nint main(void);\n")
    if text:
        yield f"{header}: {text}"


cases = {f"{header}_as_{language}": refused(language, header) for language in LANGUAGES for header in headers}
cases |= {f"{language}_without_extensions": (f"taken: {source}" for source in REFUSED[language]
                                             if errors(language, source + "\n") is None)
          for language in LANGUAGES}
failed = 0 if len(headers) > 5 else 1
print(f"1..{len(cases)}")
for index, (name, problems) in enumerate(cases.items(), 1):
    found = list(problems)
    print("\n".join(found), file=sys.stderr, end="\n" if found else "")
    failed += bool(found)
    print(f"{'not ok' if found else 'ok'} {index} - {name}")
sys.exit(failed > 0)
