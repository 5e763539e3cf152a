#!/usr/bin/env bash
# What mssim bench says of its own time and of the machine's limits. A neighbour would spoil it: nothing runs beside it.
# $1: mssim, $2: the source folder
set -euo pipefail
mssim=$1
# shellcheck source=tests/support/command_line.sh
. "$2/tests/support/command_line.sh"

start=$(date +%s%N)
"$mssim" bench --scene cloth2500,cloth4900 --backend serial,opencl --integrator semi-euler --threads 1 --time-budget 8 >"$work/out" 2>"$work/err" ||
  fail "a bench with a time budget exits with $?: $(cat "$work/err")"
spent=$((($(date +%s%N) - start) / 1000000))
[ "$spent" -ge 7200 ] && [ "$spent" -le 8800 ] || fail "a time budget of 8 s was $spent ms"

"$mssim" bench --scene cloth2500 --rounds 2 --threads 2 --out "$work/results" >"$work/out" 2>"$work/err" ||
  fail "a bench exits with $?: $(cat "$work/err")"
[ "$(column_of "$work/results/timings.csv" roofline_fraction | awk '$1 > 0 && $1 <= 1.05' | wc -l)" -eq 15 ] ||
  fail "not 15 rows have a fraction of the machine's limit: $(cat "$work/results/timings.csv")"
[ "$failures" -eq 0 ] || { echo "$failures failures"; exit 1; }
