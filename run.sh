#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds what it needs, makes the sample world, renders every view of it with global illumination off and on, and
# walks through it, on the GPU if there is one that will do. Pictures, reports, contact sheets and a plot end
# up under out/. Takes no arguments; see RUN_* below.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")"
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

seed=${RUN_SEED:-1}               # of the world
out=out

# What is rendered, and how well. A GPU takes all defaults, 240 frames, and walks at 30 frames a
# second. A software driver gets all cascades and cells, but an eighth of the rays that probes send in twenty
# frames, in eight that make a ring; light bounces once a frame. It walks with twice as many, from the last house
# on, in 37 frames, 3.3 m from one to the next: at twice that, walls of the tunnel are seen before their light
# cells have sent a ray.
# Its threads wait for each other a quarter of the time, so it does two things at once; the times that it
# reports are longer for that.
choose_quality() {
    at_once=1
    if [ -n "$(best_device build/sdfgi)" ]; then
        size=${RUN_SIZE:-1280x720} frames=${RUN_FRAMES:-240} settings=${RUN_SET-}
        walk=${RUN_WALK-$settings} steps=(--fps 30)
    else
        at_once=2
        size=${RUN_SIZE:-480x270} frames=${RUN_FRAMES:-10}
        settings=${RUN_SET-sdfgi_ray_count=8 sdfgi_frames_to_converge=8}
        walk=${RUN_WALK-${RUN_SET-sdfgi_ray_count=16 sdfgi_frames_to_converge=8}}
        steps=(--start 100 --fps 1.5 --hold 4)
    fi
}

# The process groups of what runs: where one thing fails, the others are stopped, and all that they started.
running=()

stop_running() {
    local job
    for job in "${running[@]}"; do
        kill -TERM -- "-$job" 2>/dev/null || true
    done
    wait
}

reap() {
    local ended job left=()
    wait -n -p ended "${running[@]}" || exit 1
    for job in "${running[@]}"; do
        [ "$job" = "$ended" ] || left+=("$job")
    done
    running=("${left[@]}")
}

# Runs a function beside the others, at most `at_once` of them.
begin() {
    while [ "${#running[@]}" -ge "$at_once" ]; do
        reap
    done
    set -m # a process group of its own
    "$@" &
    set +m
    running+=($!)
}

finish() {
    while [ "${#running[@]}" -gt 0 ]; do
        reap
    done
}

render_pair() { # both pictures of a view have the exposure of the one with GI, so that they can be compared
    local view=$1 number=$2 options=() setting
    say "[$number/${#views[@]}, $SECONDS s] $view"
    for setting in $settings; do
        options+=(--set "$setting")
    done
    build/sdfgi render "$out/world.glb" --view "$out/views/$view.view.json" --size "$size" --frames "$frames" \
        "${options[@]}" --report "$out/reports/$view.json" --out "$out/pictures/$view.on.png" \
        --off "$out/pictures/$view.off.png" >"$out/reports/$view.log" 2>&1 || {
        tail -n 5 "$out/reports/$view.log" >&2
        die "rendering $view failed; all of it is in $out/reports/$view.log"
    }
    build/samples/contact_sheet "$out/$view.png" 2 1 \
        "$out/pictures/$view.off.png" "$out/pictures/$view.on.png"
}

render_all() {
    local view number=0 pictures=()
    for view in "${views[@]}"; do
        number=$((number + 1))
        begin render_pair "$view" "$number"
        pictures+=("$out/pictures/$view.off.png" "$out/pictures/$view.on.png")
    done
    finish
    build/samples/contact_sheet "$out/contact_sheet.png" 4 1 "${pictures[@]}"
}

take_walk() {
    local options=() setting
    for setting in $walk; do
        options+=(--set "$setting")
    done
    say "walking"
    build/sdfgi walk "$out/world.glb" --path "$out/views/walk.json" "${steps[@]}" \
        --size 320x180 "${options[@]}" --out "$out/walk" || die "the walk failed"
}

[ $# -eq 0 ] || die "takes no arguments; RUN_SIZE=WxH, RUN_FRAMES=N or converged, RUN_SEED=N," \
    "RUN_SET=\"key=value ...\" and RUN_WALK=\"key=value ...\" change what it does"
install_packages
configure_and_build build programs
choose_device build/sdfgi
choose_quality

mkdir -p "$out/pictures" "$out/reports" || die "cannot make $out/"
build/samples/open_world --seed "$seed" --out "$out/world.glb" --views "$out/views"
mapfile -t views < <(cd "$out/views" && printf '%s\n' *.view.json | sed 's/\.view\.json$//')
trap stop_running EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
begin take_walk
render_all

reports=("${views[@]/#/$out/reports/}")
build/samples/pass_table "${reports[@]/%/.json}"
say "done in $((SECONDS / 60)) min $((SECONDS % 60)) s:
   GI off on the left, on on the right, in $out/contact_sheet.png; the walk, off above on,
   in $out/walk/contact_sheet.png, with times and work in walk.svg and report.json there"
