#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Packs the fuzz programs of build-fuzz/ with their libraries, for a machine that has little but bash and tar.
#   tests/fuzz/pack.sh FOLDER        then there: OUT=FINDINGS FOLDER/run16.sh MINUTES
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3,4s/^# \{0,1\}//p' "$0"; exit 2; }
out=$(readlink -m "$1")
cd "$(dirname "$(readlink -f "$0")")/../.."
programs=build-fuzz/tests/fuzz
packed=$(mktemp -d)
trap 'rm -rf "$packed"' EXIT
mkdir -p "$out" "$packed/lib" "$packed/seeds"
for target in "$programs"/seeds/*; do
    name=$(basename "$target")
    strip --strip-debug -o "$packed/fuzz_$name" "$programs/fuzz_$name"
    ldd "$programs/fuzz_$name" | grep -o '/[^ ]*' | xargs -I '{}' cp -Lu '{}' "$packed/lib/"
    cp -r "$target" "$packed/seeds/"
    # What was found to reach new code, smallest files first.
    if [ -d "build-fuzz/corpus/$name" ]; then
        find "build-fuzz/corpus/$name" -type f -size -8k -printf '%s %p\n' | sort -n | sed -n 1,500p |
            cut -d ' ' -f 2- | xargs -r cp -t "$packed/seeds/$name"
    fi
done
tar -C "$packed" -czf "$out/programs.tar.gz" .
cp tests/fuzz/{feed,run16,summary}.sh "$out/"
du -sh "$out" >&2
