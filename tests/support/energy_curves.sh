# Functions of the tests that hold traces against the reference curves, with those that all tests of the command line have. Sets $backends.
# shellcheck shell=bash
support=$(dirname -- "${BASH_SOURCE[0]}")
# shellcheck source=tests/support/command_line.sh
. "$support/command_line.sh"

# follows STATUS CURVE TOLERANCE SCENE BACKEND INTEGRATOR DURATION: check-energy on a run's trace and that curve must exit with STATUS
follows() {
  local status=0
  ends 0 run --scene "$4" --backend "$5" --integrator "$6" --threads 2 --duration "$7" --fps 100 --trace trace.h5
  "$source/scripts/check-energy" trace.h5 "$2" "$3" >verdict 2>&1 || status=$?
  echo "${*:4:3} against $2: $(cat verdict)"
  [ "$status" -eq "$1" ] || fail "check-energy exits with $status instead of $1"
}

# wrong SCENE TOLERANCE DURATION CHANGE: the scene, changed by a sed expression, does not follow its curve
wrong() {
  sed "$4" "$source/scenes/$1.json" >wrong.json
  ! cmp -s "$source/scenes/$1.json" wrong.json || fail "$4 changes nothing"
  follows 1 "$source/results/reference/$1.csv" "$2" wrong.json openmp rk4 "$3"
}

# Those of cloths and bodies. Without mpi and mpi-copies, whose steps are openmp's.
mapfile -t backends < <("$mssim" list backends --format csv | awk -F, '$2 ~ /^cloth[+]bodies/ && $1 !~ /^mpi/ { print $1 }')
[ "${#backends[@]}" -ge 5 ] || fail "${#backends[@]} backends"
