#!/usr/bin/env bash
# The backend mpi on two machines, which are network namespaces of this one with names of their own: the same bits over TCP, and a
# sentence where a rank of the other machine is killed, and where nothing reaches it any more.
set -euo pipefail
# shellcheck source=scripts/lib/other_host.sh
. "$2/scripts/lib/other_host.sh"
. "$2/tests/support/mpi_ranks.sh"
trap 'finish $? remove_other_host' EXIT
make_other_host "$work" || exit 77

ends 0 bench --scene cloth2500 --backend openmp,mpi --integrator semi-euler,rk4 --ranks 2 --threads 1 --rounds 2 --launcher "$hosts" --out two
[ "$(column_of two/timings.csv device | sort | uniq -c | xargs)" = "2 2 hosts of $(column_of two/timings.csv device | head -n 1) 2 $(column_of two/timings.csv device | head -n 1)" ] ||
  fail "mpi did not run on two hosts: $(cat two/timings.csv)"
[ "$(hashes two | wc -l)" -eq 2 ] || fail "two hosts have other bits: $(cat two/timings.csv)"
ends 0 bench --scene box-small --backend openmp,mpi --integrator rk4 --ranks 2 --threads 1 --rounds 1 --launcher "$hosts" --out body
all_verified body 2
[ "$(hashes body | wc -l)" -eq 1 ] || fail "a body has other bits on two hosts: $(cat body/timings.csv)"

# broken kill|cut PATTERN: while a bench runs, a rank of the other machine is killed, or its network is cut; within 30 s the row of
# mpi says so
broken() {
  local bench rank near
  rm -rf broken
  "$mssim" bench --scene cloth40k --integrator semi-euler --backend openmp,mpi --ranks 2 --threads 1 --rounds 30 --launcher "$hosts" --out broken \
    >/dev/null 2>err &
  bench=$!
  rank=$(rank_of 1 "^OMPI_MCA_plm_rsh_agent=$OMPI_MCA_plm_rsh_agent")
  near=$(rank_of 0 "^OMPI_MCA_plm_rsh_agent=$OMPI_MCA_plm_rsh_agent")
  sleep 3
  if [ "$1" = kill ]; then kill -KILL "$rank"; else ip link set "$other_near" down; fi
  # The row has failed once mssim has ended its rank here; how long openmp goes on is the machine's affair.
  soon 45 is_gone "$near" || fail "45 s after the other rank was lost, rank 0 is still there"
  wait "$bench" && fail "a bench with a row that failed is content"
  fails_with "$2" broken
  ! pgrep -f "^[^ ]*/mssim-mpi rank$" | xargs -I PID grep -lzx "OMPI_MCA_plm_rsh_agent=$OMPI_MCA_plm_rsh_agent" /proc/PID/environ 2>/dev/null ||
    fail "a rank stays behind"
}
broken kill 'rank 1 .* on node .* exited on signal 9'
broken cut 'has received nothing for 20 seconds from rank 1 on othernode'
