#!/usr/bin/env bash
# The energies of every backend follow the reference curves of bodies through their first bounce, and wrong simulations do
# not. The floor acts once a step, so that a bounce depends on what the integrator does within a step: the curves are RK4's,
# and the other integrators are held against their own double-precision runs.
set -euo pipefail
. "$2/tests/support/energy_curves.sh"
# A right simulation is 0.00001 to 0.0001 off; where rounding lets one node land a step earlier or later, 0.0004.
tolerance=0.001
duration=0.3  # each has bounced by then: the last one, the torus, is pressed hardest at 0.25 s

curves=$source/results/reference

for curve in box-small sphere-small torus-small; do
  for backend in "${backends[@]}"; do follows 0 "$curves/$curve.csv" $tolerance "$curve" "$backend" rk4 $duration; done
  for integrator in midpoint semi-euler; do
    ends 0 run --scene "$curve" --backend serial --precision double --integrator "$integrator" --duration $duration --fps 1000 \
      --energy-curve curve.csv
    follows 0 curve.csv $tolerance "$curve" openmp "$integrator" $duration
  done
done

# Wrong on purpose: another shape, and a little less damping, bounce and friction, and another spin.
follows 1 "$curves/box-small.csv" $tolerance torus-small openmp rk4 $duration
for change in 's/"damping_n_s_per_m": 2}/"damping_n_s_per_m": 1.8}/' 's/"restitution": 0.5/"restitution": 0.49/' \
  's/"friction": 0.4/"friction": 0.39/' 's/"spin_rad_per_s": \[0.81/"spin_rad_per_s": [0.91/'; do
  wrong box-small $tolerance $duration "$change"
done
