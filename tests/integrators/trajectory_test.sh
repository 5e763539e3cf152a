#!/usr/bin/env bash
# A cloth moves as SciPy's solver says of forces that are written anew (trajectory.py): every integrator comes to that trajectory
# with its order, with damping and without. SciPy may be missing: see readers_test.sh.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# Nodes move by some millimetres, and springs are compressed as well as stretched.
cat >damped.json <<'END'
{"kind": "cloth", "description": "Small and strained", "dt_s": 1e-5, "gravity_m_per_s2": 9.81, "viscous_damping_per_s": 0.5,
  "floor": {"height_m": 0, "restitution": 0, "friction": 0},
  "cloth": {"rows": 7, "columns": 8, "spacing_m": 0.01, "areal_density_kg_per_m2": 0.2, "ceiling_height_m": 1,
    "pins": {"row": 0, "every_columns": 7}, "ripple": {"height_m": 0.0015, "wavelength_m": 0.05, "speed_m_per_s": 0.4},
    "springs": {"structural": {"stiffness_n_per_m": 200, "damping_n_s_per_m": 0.01},
      "shear": {"stiffness_n_per_m": 60, "damping_n_s_per_m": 0.003},
      "bending": {"stiffness_n_per_m": 8, "damping_n_s_per_m": 0.0004}}}}
END
sed 's/\("[a-z_]*damping[a-z_]*"\): [0-9.]*/\1: 0/g' damped.json >undamped.json

# trajectories INTEGRATOR DT_S HALF_OF_IT
trajectories() {
  for scene in damped undamped; do
    for dt in "$2" "$3"; do
      ends 0 run --scene "$scene.json" --backend serial --precision double --integrator "$1" --dt "$dt" --duration 0.008 --fps 125 \
        --trace "$scene-$1-$dt.h5"
    done
  done
}
trajectories rk4 4e-5 2e-5
trajectories midpoint 2e-5 1e-5
trajectories verlet 8e-6 4e-6
for integrator in semi-euler implicit-euler newton-euler; do trajectories $integrator 1e-6 5e-7; done
run_python "$2" integrators/trajectory.py rk4:4:4 midpoint:2:2 verlet:1:2 semi-euler:1:1 implicit-euler:1:1 newton-euler:1:1
