#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds everything and runs the tests. The last line counts test cases: "N passed, N failed, N skipped".
#   ./test.sh [--full] [SUITE...]     --full also runs what takes minutes
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")"
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

# Suites that only --full runs. They are left out when no suite is named.
slow_suites=(full bench)

# Reads meson's log of the run and prints one line per failed case, then the counts. cmocka programs write
# TAP; a program without TAP counts as one case.
count_cases() {
    python3 - "$1" <<'PYTHON'
import json
import re
import sys

case = re.compile(r"^(not ok|ok) \d+ - (.*?)(\s+# SKIP\b.*)?$", re.IGNORECASE)
totals = {"passed": 0, "failed": 0, "skipped": 0}
for line in open(sys.argv[1], encoding="utf-8"):
    test = json.loads(line)
    cases = [m for m in map(case.match, test.get("stdout", "").splitlines()) if m]
    kinds = ["skipped" if m[3] else "passed" if m[1].lower() == "ok" else "failed" for m in cases]
    for match, kind in zip(cases, kinds):
        if kind == "failed":
            print(f"FAILED {test['name']}: {match[2]}")
    if any(text.startswith("validation: ") for text in test.get("stderr", "").splitlines()):
        kinds.append("failed")
        print(f"FAILED {test['name']}: messages from the validation layer")
    good = test["result"] in ("OK", "SKIP", "EXPECTEDFAIL")
    if not good and "failed" not in kinds:
        kinds.append("failed")  # crashed, timed out or failed outside of its cases
        print(f"FAILED {test['name']}: {test['result']}")
    if not kinds:
        kinds.append("skipped" if test["result"] == "SKIP" else "passed")
    for kind in kinds:
        totals[kind] += 1
print(", ".join(f"{count} {kind}" for kind, count in totals.items()))
sys.exit(1 if totals["failed"] or not totals["passed"] else 0)
PYTHON
}

full=false
suites=()
for argument in "$@"; do
    case $argument in
    --full) full=true ;;
    --help) sed -n '3,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) die "unknown option $argument; see --help" ;;
    *) suites+=(--suite "$argument") ;;
    esac
done
if [ "$full" = false ] && [ "${#suites[@]}" -eq 0 ]; then
    for suite in "${slow_suites[@]}"; do
        suites+=(--no-suite "$suite")
    done
fi

[ "$full" = false ] || packages+=("${fuzz_packages[@]}")
install_packages
configure_and_build build -Dtests=enabled -Db_ndebug=false
choose_lavapipe
export CMOCKA_MESSAGE_OUTPUT=TAP SDFGI_VALIDATION=1
unset CMOCKA_XML_FILE
# Meson has glibc fill what is allocated and freed. That is device memory, too, with a software driver: it takes
# a tenth of the time. Contexts of a test reuse memory that is full of other values anyway. With --full the
# programs of the default suites have it filled.
[ "$full" = true ] || export MALLOC_PERTURB_=0
# What is freed stays with the program, in huge pages: a software driver's memory is then mapped once. Without it
# the system takes up to a fifth of the time.
export GLIBC_TUNABLES=glibc.malloc.hugetlb=1 MALLOC_MMAP_MAX_=0 MALLOC_TRIM_THRESHOLD_=8589934592

say "testing"
rm -f build/meson-logs/testlog.json
# Its exit code is not needed: the counts below come from the log and decide.
# Two programs at a time: software drivers use all cores while they draw, and one while they compile. More
# would run into their time limits.
meson test -C build --no-rebuild --quiet --num-processes 2 --timeout-multiplier 2 "${suites[@]}" >&2 || true
[ -s build/meson-logs/testlog.json ] || die "no test ran"
count_cases build/meson-logs/testlog.json
