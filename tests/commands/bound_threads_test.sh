#!/usr/bin/env bash
# Where OpenMP binds its threads, which a noise warning advises, PoCL's threads and the processes that mssim starts
# still have all the process's CPUs, and the provenance names them all.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# The tests set it to be quick on few processors. Without it, as users have it, mssim starts anew to set how long threads spin.
unset OMP_WAIT_POLICY

cpus=$(nproc --all)
if [ "$cpus" -lt 2 ] || [ "$(nproc)" -ne "$cpus" ]; then
  echo "skipped: needs a process with all of several CPUs"
  exit 77
fi

all=$(awk '/^Cpus_allowed_list/ { print $2 }' /proc/self/status)

# expect_free LEAST ARGUMENTS...: in mssim ARGUMENTS, which runs for long, at least LEAST threads may use all CPUs
expect_free() {
  local least=$1 threads=0 try bench
  shift
  env --default-signal=INT OMP_PROC_BIND=true POCL_AFFINITY=0 "$mssim" "$@" >"$work/out" 2>"$work/err" &
  bench=$!
  for ((try = 0; try < 300 && threads < least; ++try)); do
    sleep 0.1
    kill -0 $bench 2>/dev/null || break
    threads=$(cat /proc/$bench/task/*/status 2>/dev/null | grep -xc "Cpus_allowed_list:[[:space:]]*$all" || true)
  done
  kill -INT $bench 2>/dev/null || true
  wait $bench || true
  [ "$threads" -ge "$least" ] || fail "$*: $threads threads may use all of $all: $(cat "$work/err")"
}

# PoCL inherits what its threads may use; with POCL_AFFINITY it would narrow that again.
expect_free 2 bench --scene cloth2500 --backend opencl --integrator semi-euler --threads 1 --rounds 2000

# A program that says what it may use instead of measuring.
cat >"$work/program" <<END
#!/bin/sh
sed -n 's/^Cpus_allowed_list:[[:space:]]*//p' /proc/self/status >>"$work/allowed"
exit 1
END
chmod +x "$work/program"
OMP_PROC_BIND=true "$mssim" compare --ab "$work/program" "$work/program" --scene cloth2500 --backend openmp \
  --integrator semi-euler --threads 2 >"$work/out" 2>"$work/err" && fail "compare with a program that fails succeeds"
[ "$(sort -u "$work/allowed")" = "$all" ] || fail "programs of compare may use $(cat "$work/allowed"), not $all"

OMP_PROC_BIND=true ends 0 bench --scene cloth2500 --backend serial --integrator semi-euler --rounds 5 \
  --out "$work/bound"
named=$(sed -n '/"allowed_cpus"/,/]/p' "$work/bound/provenance.json" | tr -cd '0-9,' | tr ',' '\n' | grep -c .)
[ "$named" -eq "$cpus" ] || fail "the provenance names $named of $cpus CPUs"
asked_for=$(sed -n 's/.*"asked_for": \([0-9]*\).*/\1/p' "$work/bound/provenance.json")
[ "$asked_for" = "$cpus" ] || fail "bound threads are $asked_for by default, on $cpus CPUs"
