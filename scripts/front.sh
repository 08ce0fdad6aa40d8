#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures what settings cost a frame, and what error they leave after how long: a table and a plot.
#   scripts/front.sh [--out DIR] [--docs DIR] [--spp N] [--shared DIR] [--build DIR]
#   --out DIR      where pictures and front.json go (out/front); numbers that are there are not measured again
#   --docs DIR     where accuracy/front.md and accuracy/front.png go (that of --out)
#   --spp N        samples of the truth (256)
#   --shared DIR   the folder of shared scenes (../shared/scenes)
#   --build DIR    programs that are there already, instead of building them into build/
# The times are those of the device that the program finds: choose a GPU.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

[ "${1:-}" != --help ] || { sed -n '3,10s/^# \{0,1\}//p' "$0"; exit 0; }
measuring_options "" "--out --docs --spp --shared" "$@"
exec python3 scripts/accuracy/front.py --build "$build" "${measure[@]}"
