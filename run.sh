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
# second. A software driver gets all cascades and cells, but the rays of twenty frames in four, which make a
# ring; light bounces once a frame. It walks all the way in 45 frames, 5 m from one to the next, coarsely.
choose_quality() {
    if [ -n "$(best_device build/sdfgi)" ]; then
        size=${RUN_SIZE:-1280x720} frames=${RUN_FRAMES:-240} settings=${RUN_SET-}
        walk=${RUN_WALK-$settings} steps=(--fps 30)
    else
        size=${RUN_SIZE:-480x270} frames=${RUN_FRAMES:-12}
        settings=${RUN_SET-sdfgi_ray_count=125 sdfgi_frames_to_converge=4}
        walk=${RUN_WALK-$settings sdfgi_resolution=32} steps=(--fps 1 --hold 8)
    fi
}

render() { # render VIEW off|on [OPTION...]
    local view=$1 gi=$2
    shift 2
    build/sdfgi render "$out/world.glb" --view "$out/views/$view.view.json" --size "$size" --gi "$gi" "$@" \
        --report "$out/reports/$view.$gi.json" --out "$out/pictures/$view.$gi.png" \
        >"$out/reports/$view.$gi.log" 2>&1 || {
        tail -n 5 "$out/reports/$view.$gi.log" >&2
        die "rendering $view with GI $gi failed; all of it is in $out/reports/$view.$gi.log"
    }
}

render_pair() { # on first: its exposure is used for both, so that the two can be compared
    local view=$1 options=() setting exposure
    for setting in $settings; do
        options+=(--set "$setting")
    done
    render "$view" on --frames "$frames" "${options[@]}"
    exposure=$(sed -n 's/^[[:space:]]*"exposure":[[:space:]]*\([-+.0-9eE]*\),$/\1/p' \
        "$out/reports/$view.on.json")
    [ -n "$exposure" ] || die "$out/reports/$view.on.json names no exposure"
    render "$view" off --frames 2 --exposure "$exposure"
    build/samples/contact_sheet "$out/$view.png" 2 1 \
        "$out/pictures/$view.off.png" "$out/pictures/$view.on.png"
}

render_all() {
    local view number=0 started=$SECONDS pictures=()
    for view in "${views[@]}"; do
        number=$((number + 1))
        say "[$number/${#views[@]}, $((SECONDS - started)) s] $view"
        render_pair "$view"
        pictures+=("$out/pictures/$view.off.png" "$out/pictures/$view.on.png")
    done
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
render_all
take_walk

reports=("${views[@]/#/$out/reports/}")
build/samples/pass_table "${reports[@]/%/.on.json}"
say "done in $((SECONDS / 60)) min $((SECONDS % 60)) s:
   GI off on the left, on on the right, in $out/contact_sheet.png; the walk, off above on,
   in $out/walk/contact_sheet.png, with times and work in walk.svg and report.json there"
