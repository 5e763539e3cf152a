#!/usr/bin/env bash
# Rows as published: NAME:each steps one body after the other, and suites have more threads than processors.
set -euo pipefail
. "$2/tests/support/command_line.sh"

bench=(bench --scene bodies3858 --backend "serial,serial:each,threads-mutex,threads-mutex:each" --integrator semi-euler --threads 2)
ends 0 "${bench[@]}" --rounds 3 --out one
[ "$(column_of one/timings.csv verified status | sort -u)" = 'true ok' ] || fail "rows: $(cat one/timings.csv)"
# hash BACKEND: of its state after the verification
hash() { of_backend one/timings.csv state_hash "$1"; }
[ -n "$(hash serial)" ] || fail "serial has no hash"
[ "$(hash serial)" = "$(hash serial:each)" ] || fail "serial has other bits body by body"
[ "$(column_of one/timings.csv backend paper_ms | sort | paste -sd,)" = \
  'serial 33.43,serial:each 33.43,threads-mutex 24.94,threads-mutex:each 24.94' ] || fail "published: $(cat one/timings.csv)"
grep -q '^| .threads-mutex:each., \*\*measured\*\* | \*\*' one/table3.md || fail "table3.md: $(cat one/table3.md)"

# What reads such rows.
ends 0 "${bench[@]}" --rounds 1 --verified one --out two
grep -q 'verified by an earlier process' two/timings.csv || fail "--verified: $(cat two/timings.csv)"
saying 'serial:each' ends 0 compare one one
ends 0 report one --no-runs --out report.html
grep '^{"name":"together-with-threads","outcome":"\(held\|not held\|undecided\)"' report.html >/dev/null ||
  fail "the report does not judge objects one after the other"

# Only bodies can be stepped so.
ends 3 bench --scene cloth2500 --backend serial,openmp:each --integrator semi-euler --rounds 1 --out cloth
[ "$(column_of cloth/timings.csv status | sed -n 1p)" = ok ] || fail "serial has not gone on: $(cat cloth/timings.csv)"
warns 'openmp:each.*unsupported: it steps the bodies .* name the backend without'
expect 2 'steps the bodies of a scene .* name the backend without' run --scene cloth2500 --backend serial:each --duration 0.001
expect 2 'openmp:each:x: .*from 1 to' run --scene bodies3858 --backend openmp:each:x
expect 2 'own backends' bench --scene bodies3858 --backend mpi:each

# On one processor ten threads are too many, and nothing else is left out for that. A user who says threads gets no other rows.
# combinations ARGUMENTS...: of the first scene that a bench would measure
combinations() { taskset -c "$cpu" "$mssim" bench --dry-run --integrator semi-euler "$@" | awk 'NR == 2 { print $4 }'; }
cpu=$(taskset -cp $$ | sed 's/.*: //; s/[-,].*//')
[ "$(combinations --suite table1)" -gt "$(combinations --suite table1 --threads 1)" ] || fail "table1 has no rows as published"
[ "$(combinations --suite table3)" -gt "$(combinations --suite table3 --threads 1)" ] || fail "table3 has no rows as published"
