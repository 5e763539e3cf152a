#!/usr/bin/env bash
# The energies of every backend and integrator follow the reference curve of a cloth, those of every backend that of a larger
# one, and wrong simulations do not.
# $1: mssim, $2: the source folder
set -euo pipefail
mssim=$1
source=$2
# shellcheck source=tests/support/energy_curves.sh
. "$source/tests/support/energy_curves.sh"
tolerance=0.0004 # the largest error of a right one is 0.00019, semi-euler's

# follows CURVE BACKEND INTEGRATOR
follows() {
  trace "$1" "$2" "$3" 0.1
  expect 0 "$source/results/reference/$1.csv" $tolerance "$*"
}
for backend in "${backends[@]}"; do
  for integrator in semi-euler midpoint rk4; do follows cloth2500 "$backend" "$integrator"; done
  follows cloth4900 "$backend" rk4
done

# Wrong on purpose: another cloth, and the same with a little more drag, less damping, weaker bending.
trace cloth4900 openmp rk4 0.1
expect 1 "$source/results/reference/cloth2500.csv" $tolerance "another cloth"
for change in 's/"viscous_damping_per_s": 0.1/"viscous_damping_per_s": 0.5/' \
  's/"damping_n_s_per_m": 0.01}/"damping_n_s_per_m": 0.009}/' \
  's/"stiffness_n_per_m": 8,/"stiffness_n_per_m": 4,/'; do
  wrong_scene cloth2500 "$change"
  trace "$work/wrong.json" openmp rk4 0.1
  expect 1 "$source/results/reference/cloth2500.csv" $tolerance "$change"
done
[ "$failures" -eq 0 ] || { echo "$failures failures"; exit 1; }
