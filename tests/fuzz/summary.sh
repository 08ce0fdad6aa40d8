#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Prints what lies in a folder of findings, once for each kind and stack: how many, the first of them, what its
# log says, and its innermost calls.
#   summary.sh FINDINGS [PROGRAMS]
# Logs of a machine without a symbolizer hold addresses. The folder PROGRAMS, build-fuzz/tests/fuzz where they
# were built, makes names of them.
set -euo pipefail
[ $# -ge 1 ] || { sed -n '3,7s/^# \{0,1\}//p' "$0"; exit 2; }
findings=$1 programs=${2:-}
most_calls=10

# The first stack of a log, one call a line: FUNCTION PLACE or FILE+ADDRESS. A program that a loader of its own
# has started goes by the loader's name.
stack() {
    sed -n '/^ *#0 /,/^ *$/p' "$1" | sed '/^ *$/q' | sed -n \
        -e 's/ (BuildId.*//' -e 's/^ *#[0-9]* 0x[0-9a-f]* in \(.*\)$/\1/p' \
        -e 's/^ *#[0-9]* 0x[0-9a-f]* *(.*\/\([^/]*+0x[0-9a-f]*\))$/\1/p'
}

# What a sanitizer calls itself is left out.
named() {
    local call
    while read -r call; do
        case $call in
        ld-linux*+0x*) [ -z "$1" ] || call=$(addr2line -Cfpse "$1" "${call##*+}") ;;
        esac
        case $call in
        __sanitizer* | __asan* | __ubsan* | __interceptor* | fuzzer::*) ;;
        *) echo "$call" ;;
        esac
    done
}

declare -A count first calls
keys=()
for log in "$findings"/*.log; do
    [ -e "$log" ] || break
    name=$(basename "$log" .log)
    target=${name%%-*} kind=${name##*-}
    all=$(stack "$log")
    # A timeout may strike anywhere below the call that takes so long.
    key="$target $kind $(if [ "$kind" = timeout ]; then tail -n 15; else cat; fi <<<"$all")"
    count[$key]=$((${count[$key]:-0} + 1))
    [ -z "${first[$key]:-}" ] || continue
    keys+=("$key")
    first[$key]=$log
    calls[$key]=$(named "${programs:+$programs/fuzz_$target}" <<<"$all")
done

for key in ${keys[@]+"${keys[@]}"}; do
    log=${first[$key]}
    read -r target kind _ <<<"$key"
    printf '%s: %d %s: ' "$target" "${count[$key]}" "$kind"
    (cd "$findings" && ls -d "$(basename "$log" .log)"-* 2>/dev/null) || echo "no file, $(basename "$log")"
    grep -m 1 -E 'ERROR: |CHECK failed|runtime error|error: ' "$log" | sed 's/^/    /' | cut -c 1-150 || true
    sed -n -e 's/^./        &/p' -e "$most_calls"q <<<"${calls[$key]}" | cut -c 1-110
done
