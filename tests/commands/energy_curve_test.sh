#!/usr/bin/env bash
# The energies of every backend and integrator follow the reference curve of a cloth, those of every backend that of a larger
# one, and wrong simulations do not.
set -euo pipefail
. "$2/tests/support/energy_curves.sh"
tolerance=0.0004 # the largest error of a right one is 0.00019, semi-euler's

curves=$source/results/reference

for backend in "${backends[@]}"; do
  for integrator in semi-euler midpoint rk4; do follows 0 "$curves/cloth2500.csv" $tolerance cloth2500 "$backend" "$integrator" 0.1; done
  follows 0 "$curves/cloth4900.csv" $tolerance cloth4900 "$backend" rk4 0.1
done

# Wrong on purpose: another cloth, and the same with a little more drag, less damping, weaker bending.
follows 1 "$curves/cloth2500.csv" $tolerance cloth4900 openmp rk4 0.1
for change in 's/"viscous_damping_per_s": 0.1/"viscous_damping_per_s": 0.5/' \
  's/"damping_n_s_per_m": 0.01}/"damping_n_s_per_m": 0.009}/' \
  's/"stiffness_n_per_m": 8,/"stiffness_n_per_m": 4,/'; do
  wrong cloth2500 $tolerance 0.1 "$change"
done
