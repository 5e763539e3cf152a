#!/usr/bin/env bash
# The backend mpi on bodies: the same bits as openmp's, with bodies whole or divided among any number of ranks.
set -euo pipefail
. "$2/tests/support/mpi_ranks.sh"
let_ranks_share

# box CELLS POINTS X Y DOWN: a body of so many cells in each direction and inner points, there, that falls with DOWN m/s
box() {
  echo "{\"shape\": \"box\", \"box\": {\"size_m\": [0.1, 0.1, 0.1], \"cells_x\": $1, \"cells_y\": $1, \"cells_z\": $1,
   \"interior\": {\"points\": $2, \"seed\": 1, \"jitter\": 0.1, \"margin\": 0.6}}, \"velocity_m_per_s\": [0.1, -$5, 0],
   \"spin_rad_per_s\": [1, 2, 0], \"swell_per_s\": 1, \"centre_m\": [$3, $4, 0]}"
}
# notes PATTERN: the rows of mpi say so
notes() { ! grep ',mpi,' bits/timings.csv | grep -v -- "$1" || fail "the note does not say \"$1\": $(cat bits/timings.csv)"; }

# One body, with every explicit integrator.
bodies_scene one.json 0 "$(box 3 20 0 0.3 0)"
for ranks in 1 2 3 4; do
  same_bits ./one.json "$ranks" 1 "$explicit" "$explicit_count"
  [ "$ranks" -eq 1 ] || notes ', 1 body divided"'
done
same_bits ./one.json 2 2 "$explicit" "$explicit_count"
same_bits sphere-medium 4 2 semi-euler,rk4 2
same_bits box-large 3 1 semi-euler,rk4 2

# Several: whole ones where that is even, and as few as possible divided elsewhere. The last one is small.
bodies_scene three.json 0 "$(box 3 20 0 0.3 0)" "$(box 3 20 0.3 0.3 0)" "$(box 3 20 0.6 0.3 0)"
for ranks in 1 3; do
  same_bits ./three.json "$ranks" 1 "$explicit" "$explicit_count"
  notes ', whole bodies"'
done
same_bits ./three.json 2 1 "$explicit" "$explicit_count"
notes ', 2 bodies whole, 1 divided"'
same_bits ./three.json 4 2 semi-euler,rk4 2
notes ', 3 bodies divided"'
bodies_scene unequal.json 0 "$(box 3 20 0 0.3 0)" "$(box 6 300 0.3 0.3 0)" "$(box 4 60 0.6 0.3 0)" "$(box 2 4 0.9 0.3 0)"
for ranks in 2 3 6; do same_bits ./unequal.json "$ranks" 1 semi-euler,midpoint,rk4,verlet 4; done
same_bits bodies7282 3 1 semi-euler,rk4 2
notes ', 2 bodies whole, 2 divided"'

# On the floor: bodies that bounce within the time have the same positions as openmp's.
bodies_scene bounce.json 0 "$(box 4 60 0 0.06 2)" "$(box 3 20 0.3 0.07 2)"
bodies_scene deep.json -9 "$(box 4 60 0 0.06 2)" "$(box 3 20 0.3 0.07 2)"
for integrator in semi-euler rk4; do
  for of in openmp_bounce mpi:3_bounce openmp_deep; do
    ends 0 run --scene "./${of#*_}.json" --backend "${of%_*}" --integrator "$integrator" --threads 1 --duration 0.02 --trace "${of/:3/}.h5"
  done
  h5diff -q openmp_bounce.h5 mpi_bounce.h5 "$(h5ls -r mpi_bounce.h5 | awk '/position\/value/ { print $1; exit }')" ||
    fail "$integrator: mpi has other positions than openmp on the floor"
  ! h5diff -q openmp_bounce.h5 openmp_deep.h5 "$(h5ls -r mpi_bounce.h5 | awk '/position\/value/ { print $1; exit }')" ||
    fail "$integrator: nothing bounces"
  rm ./*.h5
done

# A rank with a small body waits through most of a request for half a minute, and is not taken for lost.
bodies_scene two.json 0 "$(box 2 0 0 0.3 0)" "$(box 1 0 0.3 0.3 0)"
ends 0 run --scene ./two.json --backend mpi:2 --threads 1 --duration 50 --fps 0.02
half_a_minute=$(awk -v wall="$(value wall_s)" 'BEGIN { print 50 * 30 / wall }')
ends 0 run --scene ./two.json --backend mpi:2 --threads 1 --duration "$half_a_minute" --fps "$(awk -v s="$half_a_minute" 'BEGIN { print 1 / s }')"
echo "the long request took $(value wall_s) s"

# More ranks than parts.
ends 3 bench --scene ./one.json --backend openmp,mpi --integrator rk4 --ranks 9 --threads 1 --rounds 1 --out nine
fails_with 'unsupported: 1 body cannot be cut for 9 ranks: a part of a body has at least 16 nodes, so give at most 4 ranks"' nine

mixed_processors ./unequal.json 3 ./one.json
