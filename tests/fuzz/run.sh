#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the fuzz programs into build-fuzz/ and runs each for a while; all of them if none is named. Prints a
# table and exits with 1 if there was a finding.
#   tests/fuzz/run.sh [--jobs N] [MINUTES] [TARGET...]      1 minute each, one at a time
# Corpora grow in build-fuzz/corpus, and findings are kept in build-fuzz/findings.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

jobs=1 minutes=1 install=true
targets=()
while [ $# -gt 0 ]; do
    case $1 in
    --jobs) jobs=${2:?} && shift ;;
    --as-test) install=false ;; # skips, with 77, where packages are missing
    --help) sed -n '3,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) die "unknown option $1; see --help" ;;
    [0-9]*) minutes=$1 ;;
    *) targets+=("$1") ;;
    esac
    shift
done

packages+=("${fuzz_packages[@]}")
if [ "$install" = true ]; then
    install_packages
elif [ -n "$(missing_packages)" ]; then
    say "skipped: fuzzing needs the packages $(missing_packages | tr '\n' ' ')"
    exit 77
fi
build_fuzzers build-fuzz >&2
programs=build-fuzz/tests/fuzz
if [ "${#targets[@]}" -eq 0 ]; then
    mapfile -t targets < <(cd "$programs/seeds" && ls)
fi
for target in "${targets[@]}"; do
    [ -x "$programs/fuzz_$target" ] ||
        die "there is no target $target; there are $(cd "$programs/seeds" && echo *)"
done

say "$minutes min each of ${targets[*]}"
printf '%-10s %12s %10s   %s\n' target executions coverage findings
printf '%s\0' "${targets[@]}" | nice -n 19 xargs -0 -P "$jobs" -I '{}' tests/fuzz/feed.sh \
    "$programs/fuzz_{}" "$programs/seeds/{}" "build-fuzz/corpus/{}" build-fuzz/findings \
    "$(awk "BEGIN { print int($minutes * 60) }")" && exit
tests/fuzz/summary.sh build-fuzz/findings "$programs"
die "findings: see build-fuzz/findings"
