#!/usr/bin/env bash
# --suite cluster: every row verified, what messages cost, and the table.
set -euo pipefail
. "$2/tests/support/mpi_ranks.sh"
let_ranks_share

ends 0 bench --suite cluster --ranks 2 --backend openmp,mpi:1,mpi:2,mpi-copies:2 --rounds 1 --out two
[ "$(column_of two/cluster.csv scaling | sort | uniq -c | xargs)" = '4 copies 4 one process 8 strong 2 weak' ] || fail "rows: $(cat two/cluster.csv)"
[ "$(column_of two/cluster.csv verified | sort -u)" = true ] || fail "not every row is verified: $(cat two/cluster.csv)"
grep -q '^weak,cloth350k-x2,700000,semi-euler,mpi:2,2,2,' two/cluster.csv || fail "there is no weak scaling: $(cat two/cluster.csv)"
! grep -q 'x4' two/timings.csv || fail "a cloth for four processes is measured with two"
if [ "$(nproc)" -ge 2 ]; then
  # shellcheck disable=SC2016 # Markdown's code
  grep -q '^| `mpi:2` on `cloth10k-x2` | \*\*[0-9.]*\*\* |' two/cluster.md || fail "the page says: $(cat two/cluster.md)"
  grep -q '^The model is within .* % of the measured time in all 5 rows' two/cluster.md || fail "the page says: $(cat two/cluster.md)"
fi
"$mssim" bench --suite cluster --dry-run >plan
[ "$(grep -c '^cloth.*-x[24] ' plan)" -ge 4 ] || fail "four processes are not planned: $(cat plan)"
