#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The commands and the shader of docs/integration.md for HLSL work as they stand there: what comes out
compiles, is valid, and reads the descriptors that the GLSL reads. Skipped with 77 where spirv-cross is not
installed. Usage: hlsl.py ROOT"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(sys.argv[1]).resolve()
if not all(shutil.which(tool) for tool in ("spirv-cross", "spirv-opt", "spirv-val", "pkg-config")):
    print("skipped: install spirv-cross, spirv-tools and pkg-config")
    sys.exit(77)
guide = (root / "docs" / "integration.md").read_text(encoding="utf-8")
section = guide[guide.index("\n## HLSL and Slang\n"):]
commands = re.search(r"^```sh\n(.*?)^```", section, re.S | re.M).group(1)
shader = re.search(r"^```hlsl\n(.*?)^```", section, re.S | re.M).group(1)


def run(words, **more):
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                          **more)
    if done.returncode != 0:
        sys.exit(f"{words}: {done.stdout[-3000:]}")
    return done.stdout


def descriptors(spirv):
    """Kind, set and binding of what a module reads."""
    run(["spirv-opt", "-O", spirv, "-o", f"{spirv}.opt"])
    reflected = json.loads(run(["spirv-cross", f"{spirv}.opt", "--reflect"]))
    return {(kind, row["set"], row["binding"]) for kind, rows in reflected.items() if isinstance(rows, list)
            for row in rows if "binding" in row}


with tempfile.TemporaryDirectory() as folder:
    pathlib.Path(folder, "sdfgi.pc").write_text(
        f"shaderdir={root}/shaders/include\nName: sdfgi\nDescription: sources\nVersion: 0\n",
        encoding="utf-8")
    run(["sh", "-euc", commands], cwd=folder, env={**os.environ, "PKG_CONFIG_PATH": folder})
    pathlib.Path(folder, "host.frag.hlsl").write_text(shader, encoding="utf-8")
    run(["glslangValidator", "-D", "-V", "--target-env", "vulkan1.1", "-S", "frag", "-e", "main", "-o",
         "host.spv", "host.frag.hlsl"], cwd=folder)
    run(["spirv-val", "--target-env", "vulkan1.1", "host.spv"], cwd=folder)
    pathlib.Path(folder, "host.frag").write_text("""#version 450
#extension GL_GOOGLE_include_directive : require
#define SDFGI_SET 1
#include "sdfgi.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 to_eye;
layout(location = 0) out vec4 color;
void main()
{
    color = vec4(0.8 / 3.14159265 * sdfgi_irradiance(position, normal, to_eye), 1.0);
}
""", encoding="utf-8")
    run(["glslangValidator", "-V", "--target-env", "vulkan1.1", f"-I{root}/shaders/include", "-o", "glsl.spv",
         "host.frag"], cwd=folder)
    ours, theirs = (descriptors(f"{folder}/{name}.spv") for name in ("glsl", "host"))
    if ours != theirs or len(ours) < 5:
        sys.exit(f"descriptors of GLSL {sorted(ours)}, of HLSL {sorted(theirs)}")
    print(f"{len(ours)} descriptors")
