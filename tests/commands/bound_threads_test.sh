#!/usr/bin/env bash
# Where OpenMP binds its threads, which a noise warning advises, PoCL's threads and the processes that mssim starts
# still have all the process's CPUs, and the provenance names them all.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# The tests set it to be quick on few processors. Without it, as users have it, mssim starts anew to set how long threads spin.
unset OMP_WAIT_POLICY

cpus=$(nproc --all)
[ "$cpus" -ge 2 ] && [ "$(nproc)" -eq "$cpus" ] || skip "needs a process with all of several CPUs"

all=$(awk '/^Cpus_allowed_list/ { print $2 }' /proc/self/status)

# are_free LEAST: at least so many threads of $process may use all CPUs
are_free() { [ "$(cat "/proc/$process/task"/*/status | grep -xc "Cpus_allowed_list:[[:space:]]*$all")" -ge "$1" ]; }
# expect_free LEAST ARGUMENTS...: in mssim ARGUMENTS, which runs for long, at least LEAST threads may use all CPUs
expect_free() {
  OMP_PROC_BIND=true POCL_AFFINITY=0 begins "${@:2}"
  soon 30 are_free "$1" || fail "${*:2}: not $1 threads may use all of $all: $(cat "$work/err")"
  kill -INT "$process" 2>/dev/null || true
  wait "$process" || true
}

# PoCL inherits what its threads may use; with POCL_AFFINITY it would narrow that again.
expect_free 2 bench --scene cloth2500 --backend opencl --integrator semi-euler --threads 1 --rounds 2000

# A program that says what it may use instead of measuring.
make_program program <<END
sed -n 's/^Cpus_allowed_list:[[:space:]]*//p' /proc/self/status >>"$work/allowed"
exit 1
END
OMP_PROC_BIND=true "$mssim" compare --ab "$work/program" "$work/program" --scene cloth2500 --backend openmp \
  --integrator semi-euler --threads 2 >"$work/out" 2>"$work/err" && fail "compare with a program that fails succeeds"
[ "$(sort -u "$work/allowed")" = "$all" ] || fail "programs of compare may use $(cat "$work/allowed"), not $all"

OMP_PROC_BIND=true ends 0 bench --scene cloth2500 --backend serial --integrator semi-euler --rounds 5 \
  --out "$work/bound"
named=$(sed -n '/"allowed_cpus"/,/]/p' "$work/bound/provenance.json" | tr -cd '0-9,' | tr ',' '\n' | grep -c .)
[ "$named" -eq "$cpus" ] || fail "the provenance names $named of $cpus CPUs"
asked_for=$(sed -n 's/.*"asked_for": \([0-9]*\).*/\1/p' "$work/bound/provenance.json")
[ "$asked_for" = "$cpus" ] || fail "bound threads are $asked_for by default, on $cpus CPUs"
