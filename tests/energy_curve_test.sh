#!/usr/bin/env bash
# The energies of every backend and integrator follow the reference curves, and wrong simulations do not.
# $1: mssim, $2: the source folder
set -euo pipefail
mssim=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export POCL_CACHE_DIR=$work/pocl
tolerance=0.0004 # the largest error of a right one is 0.00019, semi-euler's
failures=0

# trace SCENE BACKEND INTEGRATOR: writes $work/trace.h5
trace() {
  "$mssim" run --scene "$1" --backend "$2" --integrator "$3" --threads 2 --duration 0.1 --fps 100 \
    --trace "$work/trace.h5" --no-losses >"$work/log" || { echo "FAILED: mssim run of $*"; failures=$((failures + 1)); }
}

# expect STATUS WHAT: check-energy on $work/trace.h5 and the curve $curve must exit with STATUS
expect() {
  local status=0
  "$source/scripts/check-energy" "$work/trace.h5" "$source/results/reference/$curve.csv" $tolerance \
    >"$work/verdict" 2>&1 || status=$?
  echo "$2: $(cat "$work/verdict")"
  [ "$status" -eq "$1" ] || { echo "FAILED: exit status $status instead of $1"; failures=$((failures + 1)); }
}

mapfile -t backends < <("$mssim" list backends --format csv | awk -F, 'NR > 1 { print $1 }')
[ "${#backends[@]}" -eq 5 ] || { echo "FAILED: ${#backends[@]} backends"; exit 1; }
for curve in cloth2500 cloth4900; do
  for backend in "${backends[@]}"; do
    for integrator in semi-euler midpoint rk4; do
      trace "$curve" "$backend" "$integrator"
      expect 0 "$curve $backend $integrator"
    done
  done
done

# Wrong on purpose: another cloth, and the same with a little more drag, less damping, weaker bending.
curve=cloth2500
trace cloth4900 openmp rk4
expect 1 "another cloth"
for change in 's/"viscous_damping_per_s": 0.1/"viscous_damping_per_s": 0.5/' \
  's/"damping_n_s_per_m": 0.01}/"damping_n_s_per_m": 0.009}/' \
  's/"stiffness_n_per_m": 8,/"stiffness_n_per_m": 4,/'; do
  sed "$change" "$source/scenes/cloth2500.json" >"$work/wrong.json"
  if cmp -s "$source/scenes/cloth2500.json" "$work/wrong.json"; then
    echo "FAILED: $change changes nothing"
    exit 1
  fi
  trace "$work/wrong.json" openmp rk4
  expect 1 "$change"
done
[ "$failures" -eq 0 ] || { echo "$failures failures"; exit 1; }
