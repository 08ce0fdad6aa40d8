#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Renders every reference scene and every scene of ../shared/scenes, traces the truth for each, and writes a table.
#   scripts/accuracy.sh [--out DIR] [--docs DIR] [--scenes NAME,...] [--spp N] [--error E] [--size WxH]
#                       [--frames N|converged] [--ssaa N] [--set KEY=VALUE]... [--finer] [--shared DIR] [--build DIR]
#   --out DIR      where pictures and results.json go (out/accuracy); what is there already is not made again
#   --docs DIR     where accuracy.md and accuracy/*.png go (that of --out); docs/ holds those of the project
#   --scenes LIST  only these
#   --spp, --error the truth's samples at most, and the mean relative standard error to stop at (4096, 0.02)
#   --size WxH     of all pictures (240x135)
#   --frames       of the renderer (converged); --ssaa N samples along a side of its pixels (4)
#   --set          a setting of the renderer, see sdfgi properties
#   --finer        also renders with cells, and distances between probes, of half the edge: eight times the work
#   --shared DIR   the folder of shared scenes (../shared/scenes)
#   --build DIR    programs that are there already, instead of building them into build/
# On a software driver, this takes hours; with `--frames 24 --ssaa 1 --set sdfgi_ray_count=125
# --set sdfgi_frames_to_converge=4 --error 0.1`, about one.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

[ "${1:-}" != --help ] || { sed -n '3,17s/^# \{0,1\}//p' "$0"; exit 0; }
measuring_options "--finer" "--out --docs --scenes --spp --error --size --frames --ssaa --set --shared" "$@"
choose_lavapipe
exec python3 scripts/accuracy/main.py --build "$build" "${measure[@]}"
