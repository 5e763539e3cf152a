#!/usr/bin/env bash
# A cloth of which nobody has the whole: verified in windows.
set -euo pipefail
. "$2/tests/support/mpi_ranks.sh"
let_ranks_share

for ranks in 1 2 3; do
  ends 0 bench --scene cloth40k --backend mpi --integrator semi-euler,rk4,verlet --ranks "$ranks" --threads 1 --rounds 1 --windows 9 --out "r$ranks"
  all_verified "r$ranks" 3
  [ "$(grep -c 'verified in 9 windows, 14 % of the nodes' "r$ranks/timings.csv")" -eq 3 ] || fail "the note does not say the share: $(cat "r$ranks/timings.csv")"
  [ -z "$(hashes "r$ranks")" ] || fail "windows have a state_hash"
done
[ "$(nproc)" -lt 2 ] || [ "$(grep -c ',true,ok,' r2/timings.csv)" -eq 3 ] || fail "two ranks are not timed: $(cat r2/timings.csv)"

# Stretches of frames end where windows are compared: ten frames of 7 steps do, and none of 33.
frames=(bench --scene cloth40k --backend mpi --integrator semi-euler --ranks 2 --threads 1 --rounds 1 --windows 9)
ends 0 "${frames[@]}" --fps 2857.14 --out frames7
grep -Eq ',true,ok,.*,7,[0-9.]+,[0-9.]+,[0-9.]+,,,,$' frames7/timings.csv || fail "frames of 7 steps: $(cat frames7/timings.csv)"
ends 0 "${frames[@]}" --fps 606.06 --out frames33
grep -q 'frames of 33 steps are not timed: .*windows are not compared' frames33/timings.csv || fail "frames of 33 steps: $(cat frames33/timings.csv)"

# A wrong result is noticed: ranks that step a cloth with one kind of spring 2 % too stiff.
make_scene stiff.json cloth40k 's/"stiffness_n_per_m": 200/"stiffness_n_per_m": 204/'
make_program stiff <<<"MSSIM_SCENE_FILE=$work/stiff.json exec $(realpath "${mssim%/*}/../libexec/mssim/mssim-mpi")"
echo '{"command": ["./stiff"], "processes": "ranks", "states": "windows"}' >stiffer.json
ends 1 bench --scene cloth40k --backend stiffer --backend-folder "$work" --integrator semi-euler --ranks 2 --threads 1 --rounds 1 --windows 9 --out stiff_out
grep -q 'failed: position error .* of a rest length exceeds .* in the window that starts at row' stiff_out/timings.csv || fail "stiffer springs: $(cat stiff_out/timings.csv)"
! grep -q 'verified in' stiff_out/timings.csv || fail "a row that has failed says that it is verified"

# What does not go together is refused.
expect 2 'backends that have windows' bench --scene cloth40k --backend serial,mpi --windows 9
expect 2 'give at least 5' bench --scene cloth40k --backend mpi --ranks 4 --windows 3
expect 2 '--trace needs the whole' bench --scene cloth40k --backend mpi --ranks 2 --windows 9 --trace --out traced

# Too little memory for the whole, not for windows; and too little for the ranks.
runs_limited || exit 0
make_scene large.json cloth40k 's/"rows": 200/"rows": 2000/; s/"columns": 200/"columns": 2000/'
kilobytes=1600000
(ulimit -v "$kilobytes" && "$mssim" bench --scene ./large.json --backend serial,mpi --integrator semi-euler --ranks 2 --threads 1 --rounds 1 >out 2>err) &&
  fail "the whole fits into $kilobytes KiB"
warns 'needs at least .*; a cloth with --backend mpi alone can be verified in windows'
(ulimit -v "$kilobytes" && "$mssim" bench --scene ./large.json --backend mpi --integrator semi-euler --ranks 2 --threads 1 --rounds 1 --out large >out 2>err) ||
  fail "windows do not do: $(cat err)"
grep -q ',mpi,.*,true,.*verified in 10 windows, 4.1 % of the nodes' large/timings.csv || fail "windows: $(cat large/timings.csv)"
# shellcheck disable=SC2016 # the program expands it
make_program limited <<<'ulimit -v 450000; exec mpirun "$@"'
ends 3 bench --scene ./large.json --backend mpi --integrator semi-euler --ranks 2 --threads 1 --rounds 1 --windows 4 --launcher "$work/limited" --out small
grep -q "unavailable: rank 0 on $(uname -n) with the others there needs at least .* of memory, but .* are available: take more machines" small/timings.csv ||
  fail "ranks without memory: $(cat small/timings.csv)"
