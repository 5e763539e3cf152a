#!/usr/bin/env bash
# The energies of every backend follow the reference curves of bodies through their first bounce, and wrong simulations do
# not. The floor acts once a step, so that a bounce depends on dt and on what the integrator does within it: RK4, the
# curves' own, is held to what single precision costs, the others to how they differ from it.
# $1: mssim, $2: the source folder
set -euo pipefail
mssim=$1
source=$2
# shellcheck source=tests/energy_curves.sh
. "$source/tests/energy_curves.sh"
declare -A tolerance=([rk4]=0.0001 [midpoint]=0.003 [semi-euler]=0.012) # found: 2e-5, 1.8e-3, 8.4e-3
duration=0.4

for curve in box-small sphere-small torus-small; do
  for backend in "${backends[@]}"; do
    trace "$curve" "$backend" rk4 $duration
    expect 0 "$curve" "${tolerance[rk4]}" "$curve $backend rk4"
  done
  for integrator in midpoint semi-euler; do
    trace "$curve" openmp "$integrator" $duration
    expect 0 "$curve" "${tolerance[$integrator]}" "$curve openmp $integrator"
  done
done

# Wrong on purpose: another shape, and a little less damping, bounce, friction, and spin.
trace torus-small openmp rk4 $duration
expect 1 box-small "${tolerance[rk4]}" "another body"
for change in 's/"damping_n_s_per_m": 2}/"damping_n_s_per_m": 1.96}/' 's/"restitution": 0.5/"restitution": 0.49/' \
  's/"friction": 0.4/"friction": 0.39/' 's/"spin_rad_per_s": \[0.81/"spin_rad_per_s": [0.91/'; do
  wrong_scene box-small "$change"
  trace "$work/wrong.json" openmp rk4 $duration
  expect 1 box-small "${tolerance[rk4]}" "$change"
done
[ "$failures" -eq 0 ] || { echo "$failures failures"; exit 1; }
