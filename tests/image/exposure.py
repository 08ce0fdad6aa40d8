#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The automatic exposure is that of what is shown, however much of the picture shows nothing. Writes TAP.

Usage: exposure.py PROGRAM"""
import base64
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

CORNERS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
SCENE = {
    "asset": {"version": "2.0"},
    "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 5}]}},
    "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}
    ],
    "bufferViews": [{"buffer": 0, "byteLength": len(CORNERS)}],
    "buffers": [
        {
            "byteLength": len(CORNERS),
            "uri": "data:application/octet-stream;base64," + base64.b64encode(CORNERS).decode("ascii"),
        }
    ],
}


def exposure(program, folder, distance):
    """The exposure of a picture of the triangle from a distance."""
    (folder / "scene.gltf").write_text(json.dumps(SCENE), encoding="utf-8")
    view = {"camera": {"position": [0.3, 0.3, distance], "look_at": [0.3, 0.3, 0]}}
    (folder / "view.json").write_text(json.dumps(view), encoding="utf-8")
    command = [program, "render", "scene.gltf", "--view", "view.json", "--size", "96x54", "--gi", "off", "--quiet"]
    command += ["--sky", "none", "--frames", "1", "--report", "report.json", "--out", "picture.png"]
    subprocess.run(command, cwd=folder, check=True)
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))["exposure"]


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        near, far = (exposure(program, pathlib.Path(folder), distance) for distance in (0.5, 6))
    print(f"1..1\n# exposure near {near:.4f}, far {far:.4f}")
    print("ok" if 0 < near and abs(far / near - 1) < 0.1 else "not ok", "1 - what_shows_nothing_does_not_count")
    return 0


if __name__ == "__main__":
    sys.exit(main())
