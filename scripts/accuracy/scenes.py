# SPDX-License-Identifier: MIT
"""Which scenes there are, with what is known about each."""
import json

import measure

# Parts of a shared scene's picture that no two programs need agree on, as shares of its sides: left, top, right, bottom.
MASKS = {"living_room": (136 / 320, 24 / 180, 176 / 320, 120 / 180)}  # a pillar whose faces coincide with the window's


CELL_M = 0.2  # of the finest cascade, by default


def wall_m(name):
    """The thickness of the wall that keeps a closed room dark; None for other scenes."""
    if name == "two_rooms_dark":
        return 0.05
    if name.startswith("two_rooms_door"):
        return 0.2
    for part in name.split("_"):
        if name.startswith(("two_rooms_w", "sealed_room_w")) and part[0] == "w" and part[1:].isdigit():
            return int(part[1:]) / 100
    return None


def generate(build, folder):
    """Has the sample program write its scenes into `folder`."""
    program = build / "samples" / "reference_scenes"
    if not program.exists():
        raise measure.Failure(f"{program} is missing: build with -Dsamples=enabled")
    measure.run([program, "--out", folder])
    rows = json.loads((folder / "scenes.json").read_text(encoding="utf-8"))
    return [
        {
            "name": row["name"],
            "shows": row["shows"],
            "exact": row.get("radiance"),
            "file": folder / f"{row['name']}.glb",
            "view": folder / f"{row['name']}.view.json",
            "wall_m": wall_m(row["name"]),
            "lit": "two_rooms_lit",
            "mask": None,
        }
        for row in rows
    ]


def find_shared(folder):
    """The scenes of another renderer's references; none where the folder is absent."""
    found = []
    for view in sorted(folder.glob("*/*.view.json")):
        name = view.name[: -len(".view.json")]
        for file in sorted(view.parent.glob("*.glb")):
            found.append(
                {
                    "name": "shared_" + name,
                    "shows": "shared scene",
                    "exact": 0 if name == "two_rooms_dark" else None,
                    "file": file,
                    "view": view,
                    "wall_m": wall_m(name),
                    "lit": "shared_two_rooms_lit",
                    "mask": MASKS.get(name),
                }
            )
    return found
