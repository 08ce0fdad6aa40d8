# SPDX-License-Identifier: MIT
"""Writes accuracy.md from the numbers of measure.py and the explanations in notes.md."""
import os
import pathlib
import sys

import measure
import scenes

NOTES = pathlib.Path(__file__).with_name("notes.md")

# A scene outside these is explained. FLIP of 0.1 is seen when two pictures are shown in turn.
RATIO_LOW, RATIO_HIGH, FLIP_MAX = 0.9, 1.1, 0.1

# Of the lit room's indirect light: walls of a cell and more, and thinner ones.
LEAK_MAX, LEAK_MAX_THIN = 1e-3, 1e-2

PARTS = {"picture": "picture", "indirect": "indirect light"}


def read_notes():
    """Paragraphs by scene, from sections whose titles list scenes; the text above them has the title ""."""
    notes, names = {"": []}, [""]
    for line in NOTES.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            names = [name.strip() for name in line[3:].split(",")]
        elif not line.startswith("<!--"):
            for name in names:
                notes.setdefault(name, []).append(line)
    return {name: "\n".join(lines).strip() for name, lines in notes.items()}


def number(value, digits=3):
    """A few digits, without a mantissa for what needs none; a dash for none."""
    if value is None:
        return "-"
    return f"{value:.1e}" if value != 0 and abs(value) < 10**-digits else f"{value:.{digits}f}"


def is_black(measures):
    return measures["reference_mean"] <= 0


def cells(measures):
    """Ratio, relMSE, FLIP and p99 of one comparison, or dashes where there is nothing to be relative to."""
    ratio = None if is_black(measures) else measures["mean_ratio"]
    tail = None if is_black(measures) else measures["p99_relative_error"]
    return [number(ratio), number(measures["relmse"], 4), number(measures["flip"]), number(tail, 2)]


def is_outside(measures):
    ratio = measures["mean_ratio"] if not is_black(measures) else None
    return (ratio is not None and not RATIO_LOW <= ratio <= RATIO_HIGH) or measures["flip"] > FLIP_MAX


def outside(scene):
    return [part for part in PARTS if is_outside(scene["measures"]["renderer/triangles"][part])]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def link(scene):
    return f"[{scene['name']}](#{scene['name']})"


def picture_table(results):
    rows = [
        [link(s), *cells(s["measures"]["renderer/triangles"]["picture"])]
        + [number(s["truth"]["triangles"]["noise_relmse"], 4), str(s["truth"]["triangles"]["spp"] or "-")]
        for s in results["scenes"]
    ]
    return table(["scene", "ratio", "relMSE", "FLIP", "p99", "noise of the truth, relMSE", "its samples"], rows)


def indirect_table(results):
    pairs = ["renderer/triangles"]
    names = ["all"]
    if results["options"]["finer"]:
        pairs += ["finer/triangles"]
        names += ["finer"]
    if results["voxels"]:
        pairs += ["renderer/voxels", "voxels/triangles"]
        names += ["transport", "voxels"]
    head = ["scene"] + [f"{name}: {what}" for name in names for what in ("ratio", "relMSE", "FLIP", "p99")]
    rows = []
    for scene in results["scenes"]:
        row = [link(scene)]
        for pair in pairs:
            measures = scene["measures"].get(pair)
            row += cells(measures["indirect"]) if measures else ["-"] * 4
        rows.append(row)
    return table(head, rows)


def tier_table(results):
    rows = []
    for scene in results["scenes"]:
        for tier, measures in scene["tiers"].items():
            name = link(scene) if tier == "all" else ""
            rows.append([name, tier, f"{100 * measures['share']:.1f}", *cells(measures)])
    return table(["scene", "tier", "% of pixels", "ratio", "relMSE", "FLIP", "p99"], rows)


def leak_limit(scene):
    return LEAK_MAX if scene["wall_m"] >= scenes.CELL_M else LEAK_MAX_THIN


def leaks(results):
    """Per closed room: the scene and its indirect light as a share of the lit room's, mean and largest."""
    found = {s["name"]: s for s in results["scenes"]}
    for scene in results["scenes"]:
        if scene["wall_m"] is None or scene["lit"] not in found:
            continue
        lit = found[scene["lit"]]["measures"]["renderer/triangles"]["indirect"]["reference_mean"]
        measures = scene["measures"]["renderer/triangles"]
        yield scene, measures["indirect"]["mean"] / lit, measures["indirect"]["max"] / lit, measures["picture"]["mean"] / lit


def leak_table(results):
    rows = []
    for scene, mean, largest, picture in leaks(results):
        angle = "45" if scene["name"].endswith("_a45") else "0"
        verdict = "yes" if mean <= leak_limit(scene) else "**no**"
        wall = f"{scene['wall_m']:g} m, {scene['wall_m'] / scenes.CELL_M:g} cells"
        rows.append([link(scene), wall, angle, *(f"{v:.1e}" if v else "0" for v in (mean, largest, picture))])
        rows[-1] += [f"{leak_limit(scene):g}", verdict]
    head = ["scene", "wall", "degrees", "leak", "brightest pixel", "whole picture", "target", "met"]
    return table(head, rows)


def scene_text(scene, note):
    lines = [f"### {scene['name']}", "", f"![renderer, truth, error](accuracy/{scene['name']}.png)", ""]
    text = scene["shows"][0].upper() + scene["shows"][1:]
    known = scene["exact"]
    if known is not None:
        traced = scene["measures"]["renderer/triangles"]["picture"]["reference_mean"]
        text += f" (known radiance {known:.5g}; truth {traced:.5g})"
    state = "converged" if scene["run"]["converged"] else "not converged"
    text += f". {scene['run']['frames']} frames, {state}."
    out = outside(scene)
    if out:
        text += " Outside the bounds: " + " and ".join(PARTS[part] for part in out) + "."
    lines += [text, ""]
    lines += [note, ""] if note else []
    return "\n".join(lines)


HOW = """This page is made by

```
scripts/accuracy.sh --docs docs --spp {spp} --error {error}{finer}
```

on {device}, with {size} pixels of {samples} samples each; frames: {frames}{settings}. The truth is the path
tracer's, with {spp} samples a pixel or a mean relative standard error of {error}, whichever is first.

- *Ratio* is mean luminance over mean luminance.
- *relMSE* is the mean of (a - b)^2 / (b^2 + 0.01).
- *FLIP* is the mean perceived difference at 67 pixels per degree after the tone curve of `sdfgi compare`.
- *p99* is the relative error that one pixel in a hundred exceeds.
- *Indirect light* is what leaves the diffuse part of the surfaces that the camera sees, without that from sun
  and lamps.
"""

ALL = """*All* compares the renderer with the truth over triangles."""

FINER = """*Finer* is the same with half the cell size, and so half the probe spacing
(`sdfgi_min_cell_size=0.1`, `sdfgi_resolution=256`)."""

SPLIT = """*Transport* compares the renderer with the truth over voxels. That is the same path tracer, in which every
ray but the camera's meets what the renderer's rays meet. *Voxels* compares the two truths."""

TIERS = """What leaves the specular part of surfaces, without sun and punctual lights, against the truth over triangles, by
roughness: *sharp* below {sharp} sends a ray over the lobe, *rough* from {rough} on takes irradiance, and *medium*
blends the two. Of a tier are pixels whose neighbours have the same roughness: others may show a mirror in part."""

LEAK = """The closed room is black in truth. A leak is the mean of its indirect light over that of the lit room
(`{lit}`).
"""

STRIPS = """Left is the renderer, in the middle the truth, right FLIP's error from black (0) to pale yellow (1)."""


def how(results):
    options = results["options"]
    settings = ", " + ", ".join(f"`{pair}`" for pair in options["set"]) if options["set"] else ""
    frames = "as many as it takes to converge" if options["frames"] == "converged" else options["frames"]
    return HOW.format(
        device=results["device"],
        size=options["size"],
        samples=int(options["ssaa"]) ** 2,
        frames=frames,
        settings=settings,
        finer=" --finer" if options["finer"] else "",
        spp=options["spp"],
        error=options["error"],
    )


def front(notes, docs):
    """What scripts/front.sh wrote, if it did."""
    path = docs / "accuracy" / "front.md"
    if not path.exists():
        return []
    return ["## The front of error against time", path.read_text(encoding="utf-8"), notes.get("front", "")]


def before(notes):
    """Numbers of earlier versions, which cannot be measured again."""
    return ["## Before and after", notes["before"]] if "before" in notes else []


def text(results, docs):
    notes = read_notes()
    parts = ["# Accuracy", notes[""], how(results), "## The picture", picture_table(results)]
    legend = [ALL] + [FINER] * results["options"]["finer"] + [SPLIT] * results["voxels"]
    parts += ["## Indirect light", "\n".join(legend), indirect_table(results)]
    tiers = TIERS.format(sharp=measure.TIERS["sharp"][1], rough=measure.TIERS["rough"][0])
    parts += ["## Reflected light", tiers, tier_table(results)]
    parts += before(notes) + front(notes, docs)
    parts += ["## Leaks", LEAK.format(lit="two_rooms_lit"), leak_table(results), "## Scene by scene"]
    parts += [STRIPS]
    for scene in results["scenes"]:
        note = notes.get(scene["name"], "")
        if outside(scene) and not note:
            print(f"accuracy.sh: {scene['name']} is outside the bounds and notes.md does not say why", file=sys.stderr)
        parts.append(scene_text(scene, note))
    return "\n\n".join(part.strip() for part in parts if part.strip()) + "\n"


def write(results, docs):
    docs.mkdir(parents=True, exist_ok=True)
    temporary = docs / "accuracy.md.part"
    temporary.write_text(text(results, docs), encoding="utf-8")
    os.replace(temporary, docs / "accuracy.md")
