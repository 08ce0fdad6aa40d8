#!/bin/sh
# SPDX-License-Identifier: MIT
# What GI adds to a scene, in the mean over its picture, against a path-traced reference: the reference less its direct light
# and less what both show alike (emitters and sky seen directly).
#
# usage: reference_ratio.sh SDFGI SCENES_DIR FOLDER NAME LOW HIGH     the ratio must lie in [LOW, HIGH]
#        reference_ratio.sh SDFGI SCENES_DIR FOLDER NAME leak MOST    black reference: mean over 0.571 at most MOST
set -eu

sdfgi=$1 folder=$2/$3 name=$4 low=$5 high=$6
if [ ! -d "$folder" ]; then
    echo "skipped: no reference scenes in $2"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scene=$(find "$folder" -name '*.glb')

# A ring of 500 rays in 4 frames settles in few frames, which a software driver needs.
"$sdfgi" render "$scene" --view "$folder/$name.view.json" --size 320x180 --gi on --frames 48 \
    --set sdfgi_ray_count=125 --set sdfgi_frames_to_converge=4 \
    --aov direct="$work/direct.exr" --aov diffuse_indirect="$work/indirect.exr" --out "$work/color.exr"

# mean FILE REFERENCE FIELD
mean() {
    "$sdfgi" compare "$work/$1.exr" "$folder/$name.$2.exr" --json | sed -n "s/^[[:space:]]*\"$3\":[[:space:]]*\([0-9.e+-]*\),*/\1/p"
}
awk -v color="$(mean color reference mean)" -v direct="$(mean direct direct mean)" \
    -v indirect="$(mean indirect reference mean)" -v reference="$(mean color reference reference_mean)" \
    -v reference_direct="$(mean direct direct reference_mean)" -v name="$name" -v low="$low" -v high="$high" '
BEGIN {
    if (low == "leak") {
        leak = color / 0.571
        printf "%s: leak %.2e of the lit room, allowed %g\n", name, leak, high
        exit !(leak <= high)
    }
    seen = color - direct - indirect
    truth = reference - reference_direct - seen
    ratio = indirect / truth
    printf "%s: GI adds %.5f, the reference %.5f, ratio %.3f, allowed %g to %g\n", name, indirect, truth, ratio, low, high
    exit !(ratio >= low && ratio <= high)
}'
