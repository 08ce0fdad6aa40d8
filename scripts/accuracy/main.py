# SPDX-License-Identifier: MIT
"""The arguments of scripts/accuracy.sh, and the order of the work."""
import argparse
import json
import os
import pathlib
import sys

import document
import measure
import scenes


def arguments():
    parser = argparse.ArgumentParser(prog="accuracy.sh", allow_abbrev=False)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/accuracy"))
    parser.add_argument("--docs", type=pathlib.Path)
    parser.add_argument("--shared", type=pathlib.Path, default=pathlib.Path("../shared/scenes"))
    parser.add_argument("--scenes", type=lambda text: text.split(","))
    parser.add_argument("--spp", type=int, default=4096)
    parser.add_argument("--error", type=float, default=0.02)
    parser.add_argument("--size", default="240x135")
    parser.add_argument("--frames", default="converged")
    parser.add_argument("--ssaa", type=int, default=4)
    parser.add_argument("--finer", action="store_true")
    parser.add_argument("--set", action="append", default=[])
    return parser.parse_args()


def chosen(args):
    """The scenes to measure, in the order of their lists."""
    known = scenes.generate(args.build, args.out / "scenes") + scenes.find_shared(args.shared)
    if not args.scenes:
        return known
    for name in args.scenes:
        if name not in [scene["name"] for scene in known]:
            raise measure.Failure(f"--scenes: there is no scene {name}")
    return [scene for scene in known if scene["name"] in args.scenes]


def main():
    args = arguments()
    args.docs = args.docs or args.out
    try:
        args.out.mkdir(parents=True, exist_ok=True)
        results = measure.measure(args, chosen(args))
        path = args.out / "results.json"
        temporary = path.with_suffix(".part")
        temporary.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
        os.replace(temporary, path)
        document.write(results, args.docs)
    except (measure.Failure, OSError) as error:
        print(f"accuracy.sh: {error}", file=sys.stderr)
        return 1
    print(f"{args.docs / 'accuracy.md'}: {len(results['scenes'])} scenes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
