#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What samples/reference_scenes writes, as test cases in TAP. Usage: reference_scenes.py REFERENCE_SCENES SDFGI"""
import array
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

program, sdfgi = sys.argv[1:3]


def write(folder, *names):
    return subprocess.run([program, "--out", folder, *names], capture_output=True, text=True, check=False)


def listed(folder):
    return json.loads((folder / "scenes.json").read_text(encoding="utf-8"))


def materials(path):
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)  # of the first chunk, which is JSON
    return json.loads(data[20 : 20 + length])["materials"]


def picture_mean(path):
    with path.open("rb") as file:
        for _ in range(3):
            file.readline()
        values = array.array("f", file.read())
    return sum(values) / len(values)


def the_list_names_what_is_there(folder):
    assert write(folder).returncode == 0
    expected = {"scenes.json"}
    for scene in listed(folder):
        expected |= {scene["name"] + ".glb", scene["name"] + ".view.json"}
    assert expected == {path.name for path in folder.iterdir()}


def named_scenes_have_the_same_bytes(folder):
    assert write(folder / "all").returncode == 0
    names = [scene["name"] for scene in listed(folder / "all")]
    assert write(folder / "named", *names).returncode == 0
    assert listed(folder / "named") == listed(folder / "all")
    for path in (folder / "all").iterdir():
        assert path.read_bytes() == (folder / "named" / path.name).read_bytes(), path.name


def a_sphere_has_the_roughness_asked_for(folder):
    roughnesses = [(i + 1) / 64 for i in range(64)]
    assert write(folder, *[f"metal_sphere={r}" for r in roughnesses]).returncode == 0
    for r in roughnesses:
        metals = [m for m in materials(folder / f"metal_sphere_{r}.glb") if m["name"] == "ball"]
        assert [m["pbrMetallicRoughness"]["roughnessFactor"] for m in metals] == [r]


def wrong_names_leave_nothing(folder):
    for name in ("nothing", "cornell=0.5", "metal_sphere=", "metal_sphere=0", "metal_sphere=1.1", "metal_sphere=1x"):
        result = write(folder / "out", "cornell", name)
        assert result.returncode != 0 and name in result.stderr and result.stderr.count("\n") == 1, name
        assert not (folder / "out").exists(), name


def white_metals_reflect_all_light(folder):
    """Balls cover a fifth of the picture: without the light from facet to facet its mean is 0.95."""
    assert write(folder, "white_metal_furnace").returncode == 0
    scene, out = folder / "white_metal_furnace.glb", folder / "out.pfm"
    view = scene.with_suffix(".view.json")
    options = ["--view", view, "--size", "160x90", "--spp", "64", "--out", out]
    subprocess.run([sdfgi, "reference", scene, *options], capture_output=True, check=True)
    assert abs(picture_mean(out) - 1) < 0.002, picture_mean(out)


CASES = (
    the_list_names_what_is_there,
    named_scenes_have_the_same_bytes,
    a_sphere_has_the_roughness_asked_for,
    wrong_names_leave_nothing,
    white_metals_reflect_all_light,
)


def main():
    failed = False
    print(f"1..{len(CASES)}")
    for number, case in enumerate(CASES, 1):
        with tempfile.TemporaryDirectory() as folder:
            try:
                case(pathlib.Path(folder))
            except (AssertionError, subprocess.CalledProcessError) as error:
                failed = True
                print(f"not ok {number} - {case.__name__}\n# {error}")
                continue
        print(f"ok {number} - {case.__name__}")
    return failed


sys.exit(main())
