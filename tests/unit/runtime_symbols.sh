#!/bin/sh
# SPDX-License-Identifier: MIT
# runtime_symbols.sh NM FILE...: no global name in archives of the program begins like those of the library.
nm=$1
shift
[ $# -gt 0 ] || exit 1
names=$("$nm" --defined-only --extern-only --format=posix "$@") || exit 1
if printf '%s\n' "$names" | grep -E '^(sdfgi|gpu|module)_'; then
    echo "these names belong to the library" >&2
    exit 1
fi
