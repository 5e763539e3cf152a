#!/usr/bin/env bash
# `mssim run` says what has been taken from the energy, in its row and in a trace, and that the sum stays constant.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# run ARGUMENTS...: nothing else than what is written may be said on stderr
run() {
  ends 0 run --backend serial --duration 0.06 --fps 200 "$@"
  cat "$work/out"
  ! grep -v '^mssim: wrote ' "$work/err" || fail "stderr says $(cat "$work/err")"
}

# values OBSERVABLE: of the trace, one a line
values() { numbers_of trace.h5 "/observables/$1/value"; }

# A small cloth without pins that soon lands on the floor, sliding for its ripple.
make_scene cloth.json cloth2500 \
  's/"rows": 50/"rows": 10/; s/"columns": 50/"columns": 12/; s/"ceiling_height_m": [0-9.]*/"ceiling_height_m": 0.003/; /"pins"/d'

run --scene "$work/cloth.json" --integrator rk4 --losses --trace "$work/trace.h5"
losses=(damping friction bounce integration)
for loss in "${losses[@]}"; do
  [ "$(values "${loss}_loss" | wc -l)" -eq 13 ] || fail "the trace has not 13 values of ${loss}_loss"
  in_trace=$(values "${loss}_loss" | tail -1)
  awk -v a="$in_trace" -v b="$(value "${loss}_loss_j")" 'BEGIN { exit !(a - b <= 1e-3 * (b < 0 ? -b : b) && b - a <= 1e-3 * (b < 0 ? -b : b)) }' ||
    fail "${loss}_loss ends with $in_trace in the trace and $(value "${loss}_loss_j") in the row"
done
for loss in damping friction bounce; do
  value "${loss}_loss_j" | are 'x > 0' || fail "no ${loss}_loss"
done
value energy_imbalance | are 'x < 1e-3 && x > -1e-3' || fail "energy_imbalance"
paste <(values total_energy) <(values damping_loss) <(values friction_loss) <(values bounce_loss) <(values integration_loss) \
  <(values kinetic_energy) |
  awk '{ sum = $1 + $2 + $3 + $4 + $5
         if (NR == 1) first = sum
         off = sum - first; if (off < 0) off = -off
         if (off > worst) worst = off
         if ($6 > kinetic) kinetic = $6 }
       END { print "largest imbalance " worst " J beside " kinetic " J of kinetic energy"; exit !(worst < 1e-3 * kinetic) }' ||
  fail "the sum over the trace does not stay constant"

run --scene "$work/cloth.json" --losses --energy-curve "$work/curve.csv"
[ "$(value damping_loss_j)" != - ] || fail "--losses gives an energy curve no losses"
[ "$(sed -n 2p "$work/curve.csv")" = time_s,kinetic_j,elastic_j,gravitational_j,total_j ] || fail "the curve's header"
run --scene "$work/cloth.json" --trace "$work/trace.h5"
if h5dump -n "$work/trace.h5" | grep _loss >/dev/null; then fail "losses in a trace that nobody asked for"; fi
[ "$(value damping_loss_j) $(value energy_imbalance)" = '- -' ] || fail "losses in a row that nobody asked for"
run --scene "$work/cloth.json" --losses
[ "$(value damping_loss_j)" != - ] || fail "--losses needs a file"

# Who would wait long learns what it costs. The run itself is cut short.
begins run --scene cloth2500 --losses --duration 1000 --trace "$work/long.h5"
is_ended 143 TERM 60 grep -q -- '--losses takes a double-precision step for every step, about [0-9]* s in all' "$work/err"
