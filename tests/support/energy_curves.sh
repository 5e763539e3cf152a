# Functions of the tests that hold traces against the reference curves, with those that all tests of the command line have. Sets $backends.
# shellcheck shell=bash
support=$(dirname -- "${BASH_SOURCE[0]}")
# shellcheck source=tests/support/command_line.sh
. "$support/command_line.sh"

# follows STATUS CURVE TOLERANCE SCENE BACKEND INTEGRATOR DURATION: check-energy on a run's trace and that curve must exit with STATUS
follows() {
  ends 0 run --scene "$4" --backend "$5" --integrator "$6" --threads 2 --duration "$7" --fps 100 --trace trace.h5
  exits "$1" "$source/scripts/check-energy" trace.h5 "$2" "$3"
  echo "${*:4:3} against $2: $(cat out err)"
}

# wrong SCENE TOLERANCE DURATION CHANGE: the scene, changed by a sed expression, does not follow its curve
wrong() {
  make_scene wrong.json "$1" "$4"
  follows 1 "$source/results/reference/$1.csv" "$2" wrong.json openmp rk4 "$3"
}

# Those of cloths and bodies. Without mpi and mpi-copies, whose steps are openmp's.
mapfile -t backends < <(backends_for bodies)
[ "${#backends[@]}" -ge 5 ] || fail "${#backends[@]} backends"
