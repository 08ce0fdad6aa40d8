# SPDX-License-Identifier: MIT
"""Renders each scene, traces its truth, and compares the two."""
import array
import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys
import threading
import zlib

import strip

# relMSE's, as `sdfgi compare` has it.
RELMSE_EPSILON = 0.01

# Paths this long leave 1e-22 of a furnace of albedo 0.95; the 64 of a picture's default would leave 3.6 %.
BOUNCES = 1000

# Of the command line, kept with the results.
OPTIONS = ("size", "frames", "ssaa", "spp", "error", "set", "finer")

PARTS = ("picture", "indirect")

# Of roughness: a ray over the lobe, a blend of that and irradiance, and irradiance alone. The limits are the defaults of
# sdfgi_reflection_blend and sdfgi_reflection_end.
TIERS = {"sharp": (0, 0.5), "medium": (0.5, 0.75), "rough": (0.75, 2)}

# Pixels differ in roughness by no more if they show the same material.
SAME_ROUGHNESS = 0.01

# A tier that fewer pixels show than this share says nothing.
MIN_SHARE = 0.005

# The same extent in cells, and between probes, of half the edge.
FINER = ["--set", "sdfgi_resolution=256", "--set", "sdfgi_min_cell_size=0.1"]


class Failure(Exception):
    """One line that says what is wrong."""


def run(command):
    """The output of a program that must succeed."""
    command = [str(word) for word in command]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        why = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
        raise Failure(f"{' '.join(command)}: {why}")
    return done.stdout


class Bench:
    """What all scenes share: programs, options, and where things lie."""

    def __init__(self, args):
        self.args = args
        self.program = args.build / "runtime" / "sdfgi"
        if not self.program.exists():
            raise Failure(f"{self.program} is missing: build the runtime first")
        self.voxels = "--geometry" in run([self.program, "reference", "--help"])
        self.lock = threading.Lock()

    def path(self, scene, kind, ending=".pfm"):
        return self.args.out / "pictures" / f"{scene['name']}.{kind}{ending}"

    def say(self, text):
        with self.lock:
            print(text, file=sys.stderr, flush=True)

    def make(self, scene, kind, command):
        """Runs `command` unless it ran before, for the same scene and program. Returns what it printed."""
        words = [str(word) for word in command]
        inputs = [self.program, scene["file"], scene["view"]]
        key = {"command": words, "inputs": [zlib.crc32(pathlib.Path(path).read_bytes()) for path in inputs]}
        note = self.path(scene, kind, ".json")
        if note.exists():
            before = json.loads(note.read_text(encoding="utf-8"))
            if before["key"] == key:
                return before["output"]
        output = run(words)
        note.write_text(json.dumps({"key": key, "output": output}), encoding="utf-8")
        self.say(f"{scene['name']}: {kind}: {output.strip().splitlines()[-1] if output.strip() else ''}")
        return output

    def settings(self):
        return [word for pair in self.args.set for word in ("--set", pair)]


def render(bench, scene, kind, settings):
    """The renderer's picture, its indirect light, and the report of the run."""
    report = bench.path(scene, kind, ".report.json")
    bench.make(
        scene,
        kind,
        [bench.program, "render", scene["file"], "--view", scene["view"], "--size", bench.args.size]
        + ["--frames", bench.args.frames, "--ssaa", bench.args.ssaa, *settings, "--report", report]
        + ["--aov", f"diffuse_indirect={bench.path(scene, kind + '.indirect')}"]
        + ["--aov", f"reflection={bench.path(scene, kind + '.reflection')}"]
        + ["--aov", f"roughness={bench.path(scene, kind + '.roughness')}"]
        + ["--out", bench.path(scene, kind + ".picture")],
    )
    return json.loads(report.read_text(encoding="utf-8"))


def trace(bench, scene, geometry):
    """The truth over triangles or voxels: samples per pixel and the noise that is left, as relMSE."""
    command = [bench.program, "reference", scene["file"], "--view", scene["view"], "--size", bench.args.size]
    command += ["--spp", bench.args.spp, "--error", bench.args.error, "--bounces", BOUNCES, "--cull-back-faces"]
    if bench.voxels:
        command += ["--geometry", geometry]
    if geometry == "voxels":
        command += bench.settings()
    command += ["--aov", f"diffuse_indirect={bench.path(scene, geometry + '.indirect')}"]
    command += ["--aov", f"reflection={bench.path(scene, geometry + '.reflection')}"]
    command += ["--aov", f"variance={bench.path(scene, geometry + '.variance')}"]
    command += ["--out", bench.path(scene, geometry + ".picture")]
    output = bench.make(scene, geometry, command)
    found = re.search(r"(\d+) samples per pixel", output)
    return {"spp": int(found[1]) if found else None, "noise_relmse": noise(bench, scene, geometry)}


def read_pfm(path):
    with open(path, "rb") as file:
        kind, _size, scale = file.readline(), file.readline(), float(file.readline())
        values = array.array("f", file.read())
    if kind.strip() != b"PF":
        raise Failure(f"{path}: expected three channels")
    if (scale < 0) != (sys.byteorder == "little"):
        values.byteswap()
    return values


def noise(bench, scene, geometry):
    """The part of a relMSE against this truth that is the truth's own variance."""
    variance = read_pfm(bench.path(scene, geometry + ".variance"))
    picture = read_pfm(bench.path(scene, geometry + ".picture"))
    terms = [v / (p * p + RELMSE_EPSILON) for v, p in zip(variance, picture)]
    return sum(terms) / len(terms)


def pixel_count(bench):
    width, height = map(int, bench.args.size.split("x"))
    return width * height


def write_pixels(bench, scene, kind, shown):
    """A picture of what to compare: white where `shown` says so, which lists pixels from the bottom."""
    values = array.array("f", [float(white) for white in shown for _channel in range(3)])
    if sys.byteorder == "big":
        values.byteswap()
    width, height = map(int, bench.args.size.split("x"))
    path = bench.path(scene, kind)
    path.write_bytes(f"PF\n{width} {height}\n-1.0\n".encode("ascii") + values.tobytes())
    return path


def write_mask(bench, scene):
    """A picture that is black where no comparison is due; None where all counts."""
    if not scene["mask"]:
        return None
    width, height = map(int, bench.args.size.split("x"))
    left, top, right, bottom = scene["mask"]
    shown = [
        not (left * width <= x + 0.5 < right * width and top * height <= y + 0.5 < bottom * height)
        for y in range(height - 1, -1, -1)
        for x in range(width)
    ]
    return write_pixels(bench, scene, "mask", shown)


def compare(bench, scene, pair, part, mask):
    """How far the first of `pair` is from the second."""
    files = [bench.path(scene, f"{kind}.{part}") for kind in pair]
    command = [bench.program, "compare", *files, "--json"]
    if mask:
        command += ["--mask", mask]
    command += ["--strip", bench.path(scene, f"{pair[0]}.{pair[1]}.{part}", ".png")]
    return json.loads(run(command))


def compare_all(bench, scene):
    mask = write_mask(bench, scene)
    pairs = [("renderer", "triangles")]
    if is_finer(bench, scene):
        pairs += [("finer", "triangles")]
    if bench.voxels:
        pairs += [("renderer", "voxels"), ("voxels", "triangles")]
    return {
        f"{a}/{b}": {part: compare(bench, scene, (a, b), part, mask) for part in PARTS} for a, b in pairs
    }


def unmixed(bench, roughness):
    """Marks pixels with the roughness of all their neighbours: others may show a mirror in part of their samples."""
    width, height = map(int, bench.args.size.split("x"))

    def is_unmixed(x, y):
        around = [
            roughness[width * v + u]
            for v in range(max(y - 1, 0), min(y + 2, height))
            for u in range(max(x - 1, 0), min(x + 2, width))
        ]
        return max(around) - min(around) <= SAME_ROUGHNESS

    return [is_unmixed(x, y) for y in range(height) for x in range(width)]


def compare_tiers(bench, scene):
    """Per tier: its share of the pixels, and how far reflected light is from the truth. Pixels show surfaces."""
    if not any(read_pfm(bench.path(scene, "triangles.reflection"))):
        return {}
    roughness = read_pfm(bench.path(scene, "renderer.roughness"))[::3]
    found = {}
    pure = unmixed(bench, roughness)
    for tier, (low, high) in {"all": (0, 2), **TIERS}.items():
        shown = [value > 0 and low <= value < high and (tier == "all" or p) for value, p in zip(roughness, pure)]
        share = sum(shown) / pixel_count(bench)
        if share >= MIN_SHARE:
            mask = write_pixels(bench, scene, tier, shown)
            found[tier] = {"share": share} | compare(bench, scene, ("renderer", "triangles"), "reflection", mask)
    return found


def is_finer(bench, scene):
    """Whether to render a scene with finer cells, too: not where one number is all that there is to find."""
    return bench.args.finer and scene["exact"] is None


def frame_count(report):
    return {
        "frames": report["frames"],
        "converged": report["gi"]["converged"],
        "health": report["health"],
        "frame_gpu_ms": report["frame_gpu_ns"]["median"] * 1e-6,
    }


def measure(args, chosen):
    """All numbers of the chosen scenes."""
    bench = Bench(args)
    (args.out / "pictures").mkdir(exist_ok=True)
    geometries = ("triangles", "voxels") if bench.voxels else ("triangles",)
    # The renderer needs the graphics device and the truth the processor: one of each at a time.
    with concurrent.futures.ThreadPoolExecutor(1) as device, concurrent.futures.ThreadPoolExecutor(1) as processor:
        rendered = {s["name"]: device.submit(render, bench, s, "renderer", bench.settings()) for s in chosen}
        finer = [
            device.submit(render, bench, s, "finer", bench.settings() + FINER) for s in chosen if is_finer(bench, s)
        ]
        traced = {
            (s["name"], geometry): processor.submit(trace, bench, s, geometry)
            for geometry in geometries
            for s in chosen
        }
        jobs = [*rendered.values(), *finer, *traced.values()]
        done, waiting = concurrent.futures.wait(jobs, return_when=concurrent.futures.FIRST_EXCEPTION)
        for job in waiting:
            job.cancel()
        for job in done:
            job.result()
    with concurrent.futures.ThreadPoolExecutor() as pool:
        measures = list(pool.map(lambda scene: compare_all(bench, scene), chosen))
        tiers = list(pool.map(lambda scene: compare_tiers(bench, scene), chosen))
    results = {"options": {key: getattr(args, key) for key in OPTIONS}, "voxels": bench.voxels}
    results["scenes"] = []
    for scene, measured, reflected in zip(chosen, measures, tiers):
        report = rendered[scene["name"]].result()
        results["device"] = report["device"]["name"]
        row = {key: scene[key] for key in ("name", "shows", "exact", "wall_m", "lit")}
        row["run"] = frame_count(report)
        row["truth"] = {geometry: traced[scene["name"], geometry].result() for geometry in geometries}
        row["measures"] = measured
        row["tiers"] = reflected
        results["scenes"].append(row)
    strip.shrink_all(bench, chosen)
    return results
