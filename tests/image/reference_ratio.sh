#!/bin/sh
# SPDX-License-Identifier: MIT
# What GI adds to a scene, in the mean over its picture, against path tracing.
#
# usage: reference_ratio.sh SDFGI SCENES_DIR FOLDER NAME KIND LIMITS [KEY=VALUE...]
#
#   picture LOW HIGH   against the picture stored with the scene, less its direct light and less what both show alike
#                      (emitters and sky seen directly); for scenes without reflections
#   diffuse LOW HIGH   against the diffuse light of our own path tracer, which is right for every material
#   flat LOW HIGH      the same through an orthographic camera in place of the scene's, and relMSE at most 0.01
#   leak MOST          the scene's picture is black: mean over 0.571, the lit room's, at most MOST
#
# KEY=VALUE are settings of the renderer besides those below.
set -eu

sdfgi=$1 folder=$2/$3 name=$4 kind=$5 low=$6
shift 6
high=$low
if [ "$kind" != leak ]; then
    high=$1
    shift
fi
leak_size=320x180 leak_frames=28 frames=24
if [ $# -gt 0 ]; then # where cells are larger, too
    leak_size=160x90 leak_frames=16 frames=16
fi
if [ ! -d "$folder" ]; then
    echo "skipped: no reference scenes in $folder"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scene=$(find "$folder" -name '*.glb')
view=$folder/$name.view.json

# Light settles in few frames, which a software driver needs: a ring of 500 rays in 4 frames, and a visit to each
# light cell in each frame.
options="--set sdfgi_ray_count=125 --set sdfgi_frames_to_converge=4 --set sdfgi_cell_rays_per_frame=1048576"
for setting in "$@"; do
    options="$options --set $setting"
done

# render SIZE FRAMES
render() {
    # shellcheck disable=SC2086 # each word of $options is an argument
    "$sdfgi" render "$scene" --view "$view" --size "$1" --gi on --frames "$2" $options \
        --aov direct="$work/direct.exr" --aov diffuse_indirect="$work/indirect.exr" --out "$work/color.exr"
}

# mean FILE REFERENCE FIELD
mean() {
    "$sdfgi" compare "$1" "$2" --json | sed -n "s/^[[:space:]]*\"$3\":[[:space:]]*\([0-9.e+-]*\),*/\1/p"
}

# judge INDIRECT TRUTH
judge() {
    awk -v indirect="$1" -v truth="$2" -v name="$name" -v low="$low" -v high="$high" 'BEGIN {
        ratio = indirect / truth
        printf "%s: GI adds %.5f, the reference %.5f, ratio %.3f, allowed %g to %g\n", name, indirect, truth, ratio, low, high
        exit !(ratio >= low && ratio <= high)
    }'
}

case $kind in
picture)
    render 320x180 56
    indirect=$(mean "$work/indirect.exr" "$folder/$name.reference.exr" mean)
    truth=$(awk -v color="$(mean "$work/color.exr" "$folder/$name.reference.exr" mean)" \
        -v direct="$(mean "$work/direct.exr" "$folder/$name.direct.exr" mean)" -v indirect="$indirect" \
        -v reference="$(mean "$work/color.exr" "$folder/$name.reference.exr" reference_mean)" \
        -v reference_direct="$(mean "$work/direct.exr" "$folder/$name.direct.exr" reference_mean)" 'BEGIN {
            seen = color - direct - indirect
            print reference - reference_direct - seen
        }')
    judge "$indirect" "$truth"
    ;;
diffuse | flat)
    if [ "$kind" = flat ]; then
        sed 's/"yfov_deg": *[0-9.]*/"ymag": 2.7/' "$view" >"$work/flat.json"
        view=$work/flat.json
    fi
    render 160x90 "$frames"
    # The mean of 64 samples differs from seed to seed by 2 %.
    "$sdfgi" reference "$scene" --view "$view" --size 160x90 --spp 256 --aov diffuse_indirect="$work/truth.exr" \
        --out "$work/reference.exr"
    judge "$(mean "$work/indirect.exr" "$work/truth.exr" mean)" "$(mean "$work/indirect.exr" "$work/truth.exr" reference_mean)"
    if [ "$kind" = flat ]; then
        error=$(mean "$work/color.exr" "$work/reference.exr" relmse)
        echo "relMSE $error, allowed 0.01"
        awk -v error="$error" 'BEGIN { exit !(error <= 0.01) }'
    fi
    ;;
leak)
    # No picture but its own is needed to tell that it is black.
    render "$leak_size" "$leak_frames"
    awk -v color="$(mean "$work/color.exr" "$work/color.exr" mean)" -v name="$name" -v most="$high" 'BEGIN {
        leak = color / 0.571
        printf "%s: leak %.2e of the lit room, allowed %g\n", name, leak, most
        exit !(leak <= most)
    }'
    ;;
*)
    echo "unknown kind $kind"
    exit 1
    ;;
esac
