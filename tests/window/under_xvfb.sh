#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs a program under an X server of its own; skips, with 77, where there is none to start.
#
# usage: under_xvfb.sh PROGRAM [ARGUMENT...]
set -eu

if ! command -v xvfb-run >/dev/null || ! command -v xauth >/dev/null; then
    echo "skipped: install xvfb and xauth"
    exit 77
fi
exec xvfb-run -a -s '-screen 0 1024x768x24' "$@"
