#!/usr/bin/env bash
# Threads that the system does not make, and more than make sense: one sentence, the other rows go on.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# row FOLDER BACKEND: the status of its rows
row() { of_backend "$1/timings.csv" status "$2" | sort -u; }

# expect_shortage BACKEND: of a bench beside serial in ./BACKEND
expect_shortage() {
  [ "$(row "$1" serial)" = ok ] || fail "serial has not gone on beside $1: $(cat err)"
  row "$1" "$1" | grep -Eq '^"?unavailable: 4 threads .* allows [1-3] .*--threads' || fail "$1 says: $(row "$1" "$1")"
}

# No thread of OpenMP can have such a stack.
# Two integrators: their references would take two threads.
bench=(bench --scene cloth2500 --integrator "semi-euler,rk4" --rounds 1)
for backend in openmp threads-mutex; do
  OMP_STACKSIZE=200000G exits 3 timeout 120 "$mssim" "${bench[@]}" --threads 4 --backend "serial,$backend" --out "$backend"
  expect_shortage "$backend"
  warns 'OMP_STACKSIZE.*200000G'
done

# Scenes are built and pictures are drawn all the same, by fewer threads.
OMP_STACKSIZE=200000G ends 0 render --scene cloth2500 --backend serial --duration 0.001 --out picture.png

# A limit of processes, which root is not subject to. The other user may not write where TMPDIR says.
as_other=(setpriv --reuid=54321 --regid=54321 --clear-groups)
# with_processes NUMBER ARGUMENTS...: mssim, as a user who may have so many
with_processes() {
  # shellcheck disable=SC2016 # the inner shell expands them
  env -u TMPDIR HOME="$work" "${as_other[@]}" bash -c 'ulimit -u "$0"; exec timeout 120 "$@"' "$1" "$mssim" "${@:2}"
}
if [ "$(id -u)" -eq 0 ] && chmod 777 . && "${as_other[@]}" "$mssim" --version >/dev/null 2>&1; then
  for backend in openmp threads-mutex; do
    exits 3 with_processes 4 "${bench[@]}" --backend "serial,$backend" --threads 8 --out "limited-$backend"
    [ "$(row "limited-$backend" serial)" = ok ] || fail "serial has not gone on under a limit of processes: $(cat err)"
  done
fi

# More than eight threads for each processor.
most=$((8 * $(nproc)))
for command in "bench --dry-run" "run --duration 0.001" "guide --out guide" "compare --ab $mssim $mssim" "render --out more.png"; do
  # shellcheck disable=SC2086 # words of their own
  expect 2 "--threads $((most + 1)) .*at most $most" $command --scene cloth2500 --threads $((most + 1))
done
ends 0 bench --scene cloth2500 --dry-run --threads $most
