#!/usr/bin/env bash
# Oclgrind, a simulator of an OpenCL device, runs every kernel and looks for data races, reads of uninitialised or
# foreign memory and wrong API calls. $1: mssim, $2: the source folder
set -euo pipefail
tests=$(dirname -- "$1")/mssim_tests
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if ! command -v oclgrind >/dev/null; then
  echo "skipped: there is no oclgrind, which Debian 12 has and 13 has not"
  exit 77
fi

# simulate FILTER OPTION...: runs those of the tests in the simulator; what it finds is a failure.
failures=0
simulate() {
  local filter=$1
  shift
  # Oclgrind knows no marks of what does not alias, which inlining leaves behind: nothing is inlined.
  oclgrind "$@" --compute-units 3 --check-api --max-errors 20 \
    --build-options '-cl-opt-disable -Dalways_inline=noinline' "$tests" --gtest_filter="$filter" 2>"$work/findings" ||
    failures=$((failures + 1))
  if [ -s "$work/findings" ]; then
    cat "$work/findings"
    failures=$((failures + 1))
  fi
}

simulate '*OpenclKernels.*' --data-races --uniform-writes
# It takes parts of vectors for uninitialised that are not, and crashes (its issue 126), hence one lane: the same text.
simulate '*OpenclKernels.*_1_lanes' --uninitialized
[ "$failures" -eq 0 ]
