#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Packs the fuzz programs of build-fuzz/ with their libraries, for a machine that has little but bash and tar.
#   tests/fuzz/pack.sh FOLDER        then there: OUT=FINDINGS FOLDER/run16.sh MINUTES
set -euo pipefail
[ $# -eq 1 ] || { sed -n '3,4s/^# \{0,1\}//p' "$0"; exit 2; }
out=$(readlink -m "$1")
cd "$(dirname "$(readlink -f "$0")")/../.."
programs=build-fuzz/tests/fuzz
rm -rf "$out"
mkdir -p "$out/lib" "$out/seeds"
for target in "$programs"/seeds/*; do
    name=$(basename "$target")
    strip --strip-debug -o "$out/fuzz_$name" "$programs/fuzz_$name"
    ldd "$programs/fuzz_$name" | grep -o '/[^ ]*' | xargs -I '{}' cp -Lu '{}' "$out/lib/"
    cp -r "$target" "$out/seeds/"
    # What was found to reach new code, smallest files first.
    if [ -d "build-fuzz/corpus/$name" ]; then
        find "build-fuzz/corpus/$name" -type f -size -8k -printf '%s %p\n' | sort -n | sed -n 1,500p |
            cut -d ' ' -f 2- | xargs -r cp -t "$out/seeds/$name"
    fi
done
tar -C "$out" -czf "$out/lib.tar.gz" lib # Embree alone has 42 MiB
rm -r "$out/lib"
cp tests/fuzz/feed.sh tests/fuzz/run16.sh "$out/"
du -sh "$out" >&2
