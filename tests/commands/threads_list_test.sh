#!/usr/bin/env bash
# --threads 1,2: a row for each number, the table of them, the same bits, and a run that goes on.
set -euo pipefail
. "$2/tests/support/command_line.sh"

bench=(bench --scene cloth2500 --backend "serial,threads-mutex,openmp" --integrator semi-euler)
ends 0 "${bench[@]}" --threads 1,2 --rounds 2 --out list
[ "$(column_of list/timings.csv backend threads | paste -sd,)" = 'serial 1,threads-mutex:1 1,threads-mutex 2,openmp:1 1,openmp 2' ] ||
  fail "rows: $(cat list/timings.csv)"
[ "$(column_of list/timings.csv backend state_hash | sed -nE 's/^openmp(:1)? //p' | sort -u | wc -l)" -eq 1 ] || fail "the bits of openmp differ: $(cat list/timings.csv)"
[ "$(column_of list/threads.csv threads | tr '\n' ' ')" = "1 2 1 2 " ] || fail "threads.csv: $(cat list/threads.csv)"
# Two rounds have no interval.
grep -q '^| .openmp. | 1 | .* | 1.00× | – | 1.00 |' list/threads.md || fail "threads.md: $(cat list/threads.md)"
says 'openmp:1 .*✓\|openmp:1 .*yes'

# Goes on with the same list in another order only, and one number makes no table.
ends 0 "${bench[@]}" --threads 2,1 --rounds 3 --resume --out list
[ "$(column_of list/timings.csv rounds | sort -u)" = 3 ] || fail "after --resume: $(cat list/timings.csv)"
warning 'list has other backends or integrators' ends 2 "${bench[@]}" --threads 2 --rounds 3 --resume --out list
ends 0 "${bench[@]}" --threads 2 --rounds 1 --overwrite --out list
[ ! -e list/threads.csv ] || fail "there is a table of one number of threads"
ends 0 compare list list
