#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs 16 fuzz processes of a folder that pack.sh made, one line for each at the end, and a summary of what was
# found. All of it goes to $OUT in three files: corpus.tar.gz, findings.tar.gz and summary.txt.
#   OUT=FOLDER run16.sh MINUTES
# What was found comes with names where the programs were built: unpack it, and run
#   tests/fuzz/summary.sh FOLDER/findings build-fuzz/tests/fuzz
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3,7s/^# \{0,1\}//p' "$0"; exit 2; }
here=$(dirname "$(readlink -f "$0")")
: "${OUT:?is to name a folder}"
mkdir -p "$OUT/findings" "$OUT/corpus"
packed=$(mktemp -d)
trap 'rm -rf "$packed"' EXIT
tar -C "$packed" -xzf "$here/programs.tar.gz"
# The libraries of the machine that built it, the loader and libc among them.
export FUZZ_LOADER="$packed/lib/ld-linux-x86-64.so.2 --library-path $packed/lib"

# Those of one target work on one corpus.
workers=(gltf gltf gltf trace trace exr png jpeg hdr pfm view path state cache settings cli)
printf '%-10s %12s %10s   %s\n' target executions coverage findings
for target in "${workers[@]}"; do
    "$here/feed.sh" "$packed/fuzz_$target" "$packed/seeds/$target" "$OUT/corpus/$target" "$OUT/findings" \
        "$(($1 * 60))" &
done
failed=0
for _ in "${workers[@]}"; do
    wait -n || failed=$((failed + 1))
done
"$here/summary.sh" "$OUT/findings" | tee "$OUT/summary.txt"
for folder in corpus findings; do
    tar -C "$OUT" --remove-files -czf "$OUT/$folder.tar.gz" "$folder"
done
echo "$failed of ${#workers[@]} have findings"
[ "$failed" -eq 0 ]
