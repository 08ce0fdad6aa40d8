#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs one fuzz program for some seconds, again after each finding, and prints one line: target, executions,
# coverage (edges of the program's graph) and findings, by kind. Exits with 1 if there are any.
#   feed.sh PROGRAM SEEDS CORPUS FINDINGS SECONDS
# Findings are files in the folder FINDINGS, TARGET-RUN-NUMBER-KIND-HASH, each with its log beside it. Kinds are
# libFuzzer's crash, timeout, oom (out of memory) and leak, or exitSTATUS without a file. Where a program needs
# a loader of its own, FUZZ_LOADER holds that command. Programs write each input to a file in TMPDIR first: one
# that lies in memory is faster.
set -euo pipefail
[ $# -eq 5 ] || { sed -n '3,8s/^# \{0,1\}//p' "$0"; exit 2; }
program=$1 seeds=$2 corpus=$3 findings=$4 seconds=$5
target=$(basename "$program")
target=${target#fuzz_}
most_findings=5

# Every file that is read is written before; and what a program leaves there when it crashes goes away.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$corpus" "$findings"

# A file may take 5 s: sanitizers and a busy machine make of one second about that.
options=(-timeout=5 -rss_limit_mb=2048 -max_len=65536 -reload=1 -print_final_stats=1 -verbosity=1)
[ "$target" != cli ] || options+=(-close_fd_mask=3) # it prints usage and errors
read -ra loader <<<"${FUZZ_LOADER:-}"

statistic() {
    sed -n "s/^stat::$1: *//p" "$scratch/log" | tail -n 1
}

# Of the finding of the run that has just ended with that status.
kind() {
    local file
    for file in "$findings/$name"-*-*; do
        [ -e "$file" ] || break
        file=${file#"$findings/$name-"}
        echo "${file%-*}"
        return
    done
    echo "exit$1"
}

executions=0 coverage=0 kinds=()
end=$((SECONDS + seconds))
while [ $((end - SECONDS)) -gt 0 ] && [ "${#kinds[@]}" -lt "$most_findings" ]; do
    name=$target-$$-${#kinds[@]}
    if TMPDIR=$scratch "${loader[@]}" "$program" "${options[@]}" -max_total_time=$((end - SECONDS)) \
        -artifact_prefix="$findings/$name-" "$corpus" "$seeds" >"$scratch/log" 2>&1; then
        status=0
    else
        status=$?
    fi
    executed=$(statistic number_of_executed_units)
    executions=$((executions + ${executed:-0}))
    coverage=$(sed -n 's/^#.* cov: \([0-9]*\) .*/\1/p' "$scratch/log" | tail -n 1)
    [ "$status" -ne 0 ] || break
    kinds+=("$(kind "$status")")
    sed '/^#[0-9]/d' "$scratch/log" >"$findings/$name-${kinds[-1]}.log" # without its progress
done
table=$(printf '%s\n' "${kinds[@]}" | sort | uniq -c | sed 's/^ *//' | paste -sd , | sed 's/,/, /g')
[ "${#kinds[@]}" -gt 0 ] || table=none
printf '%-10s %12d %10s   %s\n' "$target" "$executions" "${coverage:-0}" "$table"
[ "${#kinds[@]}" -eq 0 ]
