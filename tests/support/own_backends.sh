# Functions of the tests that run backends of a user's. Sourced after command_line.sh; they run in $work.

# A body small enough for a minute of Python.
cat >"$work/block.json" <<END
{"kind": "bodies", "description": "of a test", "dt_s": 5e-5, "gravity_m_per_s2": 9.81, "viscous_damping_per_s": 0.1,
 "floor": {"height_m": 0, "restitution": 0.5, "friction": 0.4},
 "bodies": {"density_kg_per_m3": 1000, "springs": {"stiffness_n_per_m": 10000, "damping_n_s_per_m": 0.5}, "list": [
   {"shape": "box", "box": {"size_m": [0.1, 0.1, 0.1], "cells_x": 3, "cells_y": 3, "cells_z": 3,
    "interior": {"points": 20, "seed": 1, "jitter": 0.1, "margin": 0.6}},
    "centre_m": [0, 0.3, 0], "velocity_m_per_s": [0.1, 0, 0], "spin_rad_per_s": [1, 2, 0], "swell_per_s": 1}]}}
END

# verified_everywhere PROGRAM NAME: with every explicit integrator, on a cloth and on a body, the rows of PROGRAM, named NAME, are
# verified; with every other it is said that it has none
verified_everywhere() {
  local program=$1 name=$2 scene integrators explicit
  "$mssim" list integrators --format csv >integrators.csv
  integrators=$(tail -n +2 integrators.csv | wc -l)
  explicit=$(column_of integrators.csv force_evaluations | grep -c '[0-9]')
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
