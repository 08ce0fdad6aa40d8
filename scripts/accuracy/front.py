# SPDX-License-Identifier: MIT
"""The front of error against time: settings, what they cost a frame, and what error is left after how long."""
import argparse
import json
import pathlib
import subprocess
import sys

import measure
import scenes

# Scenes whose light comes from the sun, the sky and lamps. The last one is shared.
SCENES = ("two_rooms_lit", "maze", "cornell", "shared_living_room")

# The picture in which errors are measured. One sample a pixel, because a lookup at half resolution would be one
# at full resolution in a picture of four samples.
SIZE = "320x180"

# Where a frame is timed.
TIMED_SCENE, TIMED_SIZE, TIMED_FRAMES = "maze", "1920x1080", 120

# Seconds at 60 frames a second; the last one is as long as it takes.
AFTER = (("0.25 s", "15"), ("1 s", "60"), ("4 s", "240"), ("settled", "converged"))

FINE = {"sdfgi_min_cell_size": "0.1", "sdfgi_cascades": "5"}
DEFAULT = "cells of 0.2 m, 131,072 rays, full"


def cells(rays, lookup, finer=False):
    name = f"cells of {'0.1' if finer else '0.2'} m, {rays:,} rays, {lookup}"
    return name, lookup, {"sdfgi_cell_rays_per_frame": str(rays)} | (FINE if finer else {})


CONFIGURATIONS = [
    ("probes, full", "full", {"sdfgi_surface_light": "probes"}),
    *[cells(rays, "full") for rays in (32768, 131072, 524288)],
    *[cells(131072, lookup) for lookup in ("half", "quarter")],
    *[cells(rays, "full", True) for rays in (32768, 131072, 524288)],
    cells(131072, "half", True),
]


def arguments():
    parser = argparse.ArgumentParser(prog="front.sh", allow_abbrev=False)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/front"))
    parser.add_argument("--docs", type=pathlib.Path)
    parser.add_argument("--shared", type=pathlib.Path, default=pathlib.Path("../shared/scenes"))
    parser.add_argument("--spp", type=int, default=256)
    return parser.parse_args()


def render(program, scene, options, size, frames, picture, report):
    _name, lookup, settings = options
    command = [program, "render", scene["file"], "--view", scene["view"], "--size", size, "--frames", frames]
    command += ["--lookup", lookup, *[word for pair in settings.items() for word in ("--set", "=".join(pair))]]
    command += ["--aov", f"diffuse_indirect={picture}", "--report", report, "--out", picture.with_suffix(".picture.pfm")]
    measure.run(command)
    return json.loads(report.read_text(encoding="utf-8"))


def trace(program, scene, spp, out):
    truth = out / f"{scene['name']}.truth.pfm"
    if not truth.exists():
        command = [program, "reference", scene["file"], "--view", scene["view"], "--size", SIZE, "--spp", spp]
        command += ["--bounces", measure.BOUNCES, "--cull-back-faces", "--aov", f"diffuse_indirect={truth}"]
        measure.run(command + ["--out", out / "truth.picture.pfm"])
    return truth


def errors(program, chosen, options, out, truths):
    """Per time the means over the scenes of relMSE and FLIP; and the memory."""
    row, memory = [], 0
    picture, report = out / "indirect.pfm", out / "report.json"
    for _label, frames in AFTER:
        found = []
        for scene in chosen:
            text = render(program, scene, options, SIZE, frames, picture, report)
            memory = max(memory, text["memory"]["total_bytes"])
            compared = measure.run([program, "compare", picture, truths[scene["name"]], "--json"])
            found.append(json.loads(compared))
        row.append([sum(one[key] for one in found) / len(found) for key in ("relmse", "flip")])
    return row, memory


def times(program, chosen, options, out):
    scene = next(one for one in chosen if one["name"] == TIMED_SCENE)
    report = render(program, scene, options, TIMED_SIZE, TIMED_FRAMES, out / "timed.pfm", out / "timed.json")
    return report["gi_cost"]["update_ms"], report["gi_cost"]["lookup_ms"], report["device"]["name"]


def measure_all(args, program):
    known = scenes.generate(args.build, args.out / "scenes") + scenes.find_shared(args.shared)
    chosen = [one for one in known if one["name"] in SCENES]
    truths = {scene["name"]: trace(program, scene, args.spp, args.out) for scene in chosen}
    rows, device = [], ""
    for options in CONFIGURATIONS:
        row, memory = errors(program, chosen, options, args.out, truths)
        update, lookup, device = times(program, chosen, options, args.out)
        rows.append({"name": options[0], "update": update, "lookup": lookup, "memory": memory, "errors": row})
        print(rows[-1], file=sys.stderr, flush=True)
    return {"device": device, "scenes": [one["name"] for one in chosen], "rows": rows}


def write_table(results, path):
    head = ["settings", "update, ms", "lookup, ms", "MiB", *[label for label, _frames in AFTER]]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for row in results["rows"]:
        name = f"**{row['name']}** (default)" if row["name"] == DEFAULT else row["name"]
        cost = [f"{row['update']:.2f}", f"{row['lookup']:.2f}", f"{row['memory'] / 2**20:.0f}"]
        lines.append("| " + " | ".join([name, *cost, *[f"{a:.4f}, {b:.3f}" for a, b in row["errors"]]]) + " |")
    text = f"""Means of relMSE and FLIP of indirect light over {", ".join(f"`{name}`" for name in results["scenes"])}, after
a time from nothing at 60 frames a second, at {SIZE}. Update and lookup are those of a frame of `{TIMED_SCENE}` at
{TIMED_SIZE}, on {results["device"]}. Made by `scripts/front.sh --docs docs`.

![error against time a frame](accuracy/front.png)

"""
    path.write_text(text + "\n".join(lines) + "\n", encoding="utf-8")


def write_plot(results, path):
    """FLIP against the time of a frame, a curve for each time after the start."""
    blocks = []
    for index, _after in enumerate(AFTER):
        points = sorted((row["update"] + row["lookup"], row["errors"][index][1]) for row in results["rows"])
        blocks.append("\n".join(f"{x} {y}" for x, y in points))
    curves = ", ".join(f"'-' with points pt {5 + 2 * i} title '{label}'" for i, (label, _) in enumerate(AFTER))
    script = f"""set terminal pngcairo size 800,500
set output '{path}'
set xlabel 'update + lookup, ms a frame'
set ylabel 'FLIP of indirect light'
set yrange [0:*]
set key outside
plot {curves}
""" + "".join(block + "\ne\n" for block in blocks)
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


def main():
    args = arguments()
    docs = args.docs or args.out
    program = args.build / "runtime" / "sdfgi"
    try:
        (args.out / "scenes").mkdir(parents=True, exist_ok=True)
        (docs / "accuracy").mkdir(parents=True, exist_ok=True)
        path = args.out / "front.json"
        if not path.exists():
            path.write_text(json.dumps(measure_all(args, program), indent=1) + "\n", encoding="utf-8")
        results = json.loads(path.read_text(encoding="utf-8"))
        write_table(results, docs / "accuracy" / "front.md")
        write_plot(results, docs / "accuracy" / "front.png")
    except (measure.Failure, OSError, subprocess.CalledProcessError) as error:
        print(f"front.sh: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
