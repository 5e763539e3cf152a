#!/usr/bin/env bash
# Oclgrind, a simulator of an OpenCL device, runs every kernel and looks for data races, reads of uninitialised or
# foreign memory and wrong API calls. $1: mssim, $2: the source folder
set -euo pipefail
. "$2/tests/support/command_line.sh"
tests=$(dirname -- "$mssim")/mssim_tests

command -v oclgrind >/dev/null || skip "there is no oclgrind, which Debian 12 has and 13 has not"

# simulate FILTER OPTION...: runs those of the tests in the simulator; what it finds is a failure.
simulate() {
  # Oclgrind knows no marks of what does not alias, which inlining leaves behind: nothing is inlined.
  oclgrind "${@:2}" --compute-units 3 --check-api --max-errors 20 \
    --build-options '-cl-opt-disable -Dalways_inline=noinline' "$tests" --gtest_filter="$1" 2>findings || fail "$1 fails"
  [ ! -s findings ] || fail "$1: $(cat findings)"
}

simulate '*OpenclKernels.*' --data-races --uniform-writes
# It takes parts of vectors for uninitialised that are not, and crashes (its issue 126), hence one lane: the same text.
simulate '*OpenclKernels.*_1_lanes' --uninitialized
