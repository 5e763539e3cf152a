#!/usr/bin/env bash
# Where OpenMP binds its threads, which a noise warning advises, PoCL's threads still have all the process's CPUs, and
# the provenance names them all. $1: mssim, $2: the source folder
set -euo pipefail
mssim=$1
# shellcheck source=tests/support/command_line.sh
. "$2/tests/support/command_line.sh"

cpus=$(nproc --all)
if [ "$cpus" -lt 2 ] || [ "$(nproc)" -ne "$cpus" ]; then
  echo "skipped: needs a process with all of several CPUs"
  exit 77
fi

# PoCL inherits what its threads may use; with POCL_AFFINITY it would narrow that again.
all=$(awk '/^Cpus_allowed_list/ { print $2 }' /proc/self/status)
env --default-signal=INT OMP_PROC_BIND=true POCL_AFFINITY=0 "$mssim" bench --scene cloth2500 --backend opencl \
  --integrator semi-euler --threads 1 --rounds 2000 >"$work/out" 2>"$work/err" &
bench=$!
threads=0
for ((try = 0; try < 300 && threads < 2; ++try)); do
  sleep 0.1
  kill -0 $bench 2>/dev/null || break
  threads=$(cat /proc/$bench/task/*/status 2>/dev/null | grep -xc "Cpus_allowed_list:[[:space:]]*$all" || true)
done
kill -INT $bench 2>/dev/null || true
wait $bench || true
[ "$threads" -ge 2 ] || fail "$threads threads may use all of $all: $(cat "$work/err")"

OMP_PROC_BIND=true "$mssim" bench --scene cloth2500 --backend serial --integrator semi-euler --rounds 5 \
  --out "$work/bound" >"$work/out" 2>"$work/err" || fail "a bench with bound threads exits with $?"
named=$(sed -n '/"allowed_cpus"/,/]/p' "$work/bound/provenance.json" | tr -cd '0-9,' | tr ',' '\n' | grep -c .)
[ "$named" -eq "$cpus" ] || fail "the provenance names $named of $cpus CPUs"
[ "$failures" -eq 0 ]
