#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# shellcheck disable=SC2317 # functions that are called by name
# choose_device.sh SOURCES PROGRAM: run.sh's choice of a device, with a stand-in for `sdfgi info`. Prints TAP.
set -euo pipefail
source "$1/scripts/packages.sh"
count=0 failed=0

# Stands in for lavapipe, which this machine may lack.
choose_lavapipe() {
    export VK_DRIVER_FILES=lavapipe
}

# program DEVICES: prints them like sdfgi info; a device is "NAME|TYPE|usable or not". None: fails, as without
# a driver.
program() {
    local index=0 device name type usable
    [ $# -gt 0 ] || return 1
    printf 'memory, 4 cascades\n  total 1 bytes\n'
    for device in "$@"; do
        IFS='|' read -r name type usable <<<"$device"
        printf 'device %d: %s\n  type       %s\n  driver     any 1.0\n' "$index" "$name" "$type"
        printf '  libsdfgi   supported\n  program    %s\n' "$usable"
        index=$((index + 1))
    done
}

# chosen DRIVERS DEVICE...: what choose_device says and the drivers in force after it.
chosen() (
    export VK_DRIVER_FILES=$1
    unset VK_ICD_FILENAMES
    shift
    devices=("$@")
    stand_in() { program "${devices[@]}"; }
    choose_device stand_in 2>&1
    echo "drivers: $VK_DRIVER_FILES"
)

# claim NAME OUTPUT PATTERN: the output matches the pattern of the shell.
claim() {
    count=$((count + 1))
    # shellcheck disable=SC2053
    if [[ $2 == $3 ]]; then
        echo "ok $count - $1"
    else
        echo "not ok $count - $1"
        echo "# $2"
        failed=1
    fi
}

llvmpipe='llvmpipe (LLVM 15.0.6, 256 bits)|cpu|usable'
none='*with lavapipe*drivers: lavapipe'
claim a_gpu_is_preferred_to_the_cpu "$(chosen '' "$llvmpipe" 'GPU: 1|discrete|usable')" \
    '*on GPU: 1 (discrete)*drivers: '
claim a_discrete_gpu_is_preferred_to_others \
    "$(chosen '' 'V|virtual|usable' 'D|discrete|usable' 'I|integrated|usable')" '*on D (discrete)*drivers: '
claim an_integrated_gpu_will_do "$(chosen '' 'I|integrated|usable' "$llvmpipe")" \
    '*on I (integrated)*drivers: '
claim the_cpu_alone_is_lavapipe "$(chosen '' "$llvmpipe")" "$none"
claim a_gpu_that_will_not_do_is_left_out "$(chosen '' 'Old|discrete|not usable: old' "$llvmpipe")" "$none"
claim without_any_driver_it_is_lavapipe "$(chosen '')" "$none"
claim the_users_drivers_win "$(chosen /mine.json 'D|discrete|usable')" \
    '*the driver of /mine.json*drivers: /mine.json'

# The stand-in looks like the real list, if this machine has a device to list.
real=$2
as_gpu() { "$real" info | sed 's/^  type .*/  type       discrete/'; }
if "$real" info >/dev/null 2>&1; then
    claim the_real_list_is_understood "$(best_device as_gpu)" '?* (discrete)'
fi
echo "1..$count"
exit $failed
