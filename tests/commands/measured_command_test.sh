#!/usr/bin/env bash
# What mssim bench writes, and what it says of its own time and of the machine's limits. A neighbour would spoil it: nothing
# runs beside it.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# column NAME: of the results
column() { column_of "$work/results/timings.csv" "$1"; }

start=$(date +%s%N)
ends 0 bench --scene cloth2500,cloth4900 --backend serial,opencl --integrator semi-euler --threads 1 --time-budget 12
spent=$((($(date +%s%N) - start) / 1000000))
# What the check of the samples takes can only be expected: a second or three, on a machine whose speed changes from one to the next.
[ "$spent" -ge 10800 ] && [ "$spent" -le 13200 ] || fail "a time budget of 12 s was $spent ms"

# A bench of every backend with the usual three integrators: what it writes, and how near it comes to the limits.
ends 0 bench --scene cloth2500 --rounds 2 --threads 2 --trace --out "$work/results"
cat "$work/out"
rows=$((3 * $(backends_for cloth | wc -l)))
[ "$(column nodes | sort -u)" = 2500 ] || fail "nodes"
[ "$(column springs_published | sort -u)" = 29004 ] || fail "springs"
[ "$(column verified | grep -c true)" -eq "$rows" ] || fail "not $rows verified rows"
for file in timings.csv samples.csv table1.csv table1.md benchmark.json provenance.json; do
  [ -s "$work/results/$file" ] || fail "$file is missing"
done
[ "$(find "$work/results/traces" -name '*.h5' | wc -l)" -eq "$rows" ] || fail "not $rows traces"
[ "$(awk -F, 'NR > 1' "$work/results/samples.csv" | wc -l)" -eq $((2 * rows)) ] || fail "not two samples a row"
[ "$(column roofline_fraction | awk '$1 > 0 && $1 <= 1.05' | wc -l)" -eq "$rows" ] ||
  fail "not every row has a fraction of the machine's limit: $(cat "$work/results/timings.csv")"
