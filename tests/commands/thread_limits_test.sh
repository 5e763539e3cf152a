#!/usr/bin/env bash
# Threads that the system does not make, and more than make sense: one sentence, the other rows go on.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# row FOLDER BACKEND: the status of its rows
row() { awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) c[$i] = i; next } $c["backend"] == name { print $c["status"] }' "$1/timings.csv" | sort -u; }

# expect_shortage BACKEND: of a bench beside serial in ./BACKEND, whose exit code is $status
expect_shortage() {
  [ "$status" -eq 3 ] || fail "$1 without threads exits with $status instead of 3: $(cat err)"
  [ "$(row "$1" serial)" = ok ] || fail "serial has not gone on beside $1: $(cat err)"
  row "$1" "$1" | grep -Eq '^"?unavailable: 4 threads .* allows [1-3] .*--threads' || fail "$1 says: $(row "$1" "$1")"
}

# No thread can have such a stack.
# Two integrators: their references would take two threads.
bench=(bench --scene cloth2500 --integrator "semi-euler,rk4" --rounds 1)
status=0
OMP_STACKSIZE=200000G timeout 120 "$mssim" "${bench[@]}" --threads 4 --backend serial,openmp --out openmp >out 2>err || status=$?
expect_shortage openmp
grep -q 'OMP_STACKSIZE.*200000G' err || fail "the stack's size is not named: $(cat err)"

# Scenes are built and pictures are drawn all the same, by fewer threads.
OMP_STACKSIZE=200000G ends 0 render --scene cloth2500 --backend serial --duration 0.001 --out picture.png

# A limit of processes, which root is not subject to. The other user may not write where TMPDIR says.
if [ "$(id -u)" -eq 0 ] && chmod 777 . && setpriv --reuid=54321 --regid=54321 --clear-groups "$mssim" --version >/dev/null 2>&1; then
  for backend in openmp threads-mutex; do
    status=0
    env -u TMPDIR HOME="$work" setpriv --reuid=54321 --regid=54321 --clear-groups bash -c \
      'ulimit -u 4; exec timeout 120 "$@"' bash "$mssim" "${bench[@]}" --backend "serial,$backend" --threads 8 --out "limited-$backend" \
      >out 2>err || status=$?
    [ "$status" -eq 3 ] || fail "$backend under a limit of processes exits with $status: $(cat err)"
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
