# Functions of the tests that run backends of a user's. Sourced after command_line.sh; they run in $work.

# A body small enough for a minute of Python.
bodies_scene "$work/block.json" 0 '{"shape": "box", "box": {"size_m": [0.1, 0.1, 0.1], "cells_x": 3, "cells_y": 3, "cells_z": 3,
  "interior": {"points": 20, "seed": 1, "jitter": 0.1, "margin": 0.6}},
  "centre_m": [0, 0.3, 0], "velocity_m_per_s": [0.1, 0, 0], "spin_rad_per_s": [1, 2, 0], "swell_per_s": 1}'

# verified_everywhere PROGRAM NAME: with every explicit integrator, on a cloth and on a body, the rows of PROGRAM, named NAME, are
# verified; with every other it is said that it has none
verified_everywhere() {
  local program=$1 name=$2 scene integrators explicit
  integrators=$(names_of integrators | wc -l)
  explicit=$(explicit_integrators | wc -l)
  for scene in cloth2500 block.json; do
    rm -rf results
    ends 0 bench --scene "$scene" --backend "$program" --integrator all --threads 1 --rounds 1 --format csv --out results
    column_of results/timings.csv backend >rows
    [ "$(grep -cx -- "$name" rows)" -eq "$integrators" ] || fail "$scene has other rows than $integrators of $name: $(cat rows)"
    column_of results/timings.csv verified >rows
    [ "$(grep -cx true rows)" -eq "$explicit" ] || fail "$scene with $program is not verified: $(cat results/timings.csv)"
    [ "$(grep -c 'unsupported: it has no ' results/timings.csv)" -eq $((integrators - explicit)) ] ||
      fail "$scene: of what $program has not is said: $(cat results/timings.csv)"
  done
}
