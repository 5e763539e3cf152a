# Functions of the tests that hold traces against the reference curves. Needs $mssim and $source; sets $work (a folder that
# goes away), $backends and $failures.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export POCL_CACHE_DIR=${mssim%/*}/../pocl  # kernels compile for seconds
failures=0

# trace SCENE BACKEND INTEGRATOR DURATION: writes $work/trace.h5
trace() {
  "$mssim" run --scene "$1" --backend "$2" --integrator "$3" --threads 2 --duration "$4" --fps 100 \
    --trace "$work/trace.h5" >"$work/log" || { echo "FAILED: mssim run of $*"; failures=$((failures + 1)); }
}

# expect STATUS CURVE.csv TOLERANCE WHAT: check-energy on $work/trace.h5 and that curve must exit with STATUS
expect() {
  local status=0
  "$source/scripts/check-energy" "$work/trace.h5" "$2" "$3" >"$work/verdict" 2>&1 ||
    status=$?
  echo "$4: $(cat "$work/verdict")"
  [ "$status" -eq "$1" ] || { echo "FAILED: exit status $status instead of $1"; failures=$((failures + 1)); }
}

# wrong_scene SCENE CHANGE: writes $work/wrong.json, the scene changed by a sed expression
wrong_scene() {
  sed "$2" "$source/scenes/$1.json" >"$work/wrong.json"
  if cmp -s "$source/scenes/$1.json" "$work/wrong.json"; then
    echo "FAILED: $2 changes nothing"
    exit 1
  fi
}

# Those of cloths and bodies. Without mpi and mpi-copies, whose steps are openmp's.
mapfile -t backends < <("$mssim" list backends --format csv | awk -F, '$2 ~ /^cloth[+]bodies/ && $1 !~ /^mpi/ { print $1 }')
[ "${#backends[@]}" -ge 5 ] || { echo "FAILED: ${#backends[@]} backends"; exit 1; }
