#!/usr/bin/env bash
# The backend mpi on two machines, which are network namespaces of this one with names of their own: the same bits over TCP, and a
# sentence where a rank of the other machine is killed, and where nothing reaches it any more.
# $1: mssim, $2: the source folder
set -euo pipefail
mssim=$1
# shellcheck source=tests/support/command_line.sh
. "$2/tests/support/command_line.sh"
# shellcheck source=scripts/lib/mpi.sh
. "$2/scripts/lib/mpi.sh"
# shellcheck source=tests/support/mpi_ranks.sh
. "$2/tests/support/mpi_ranks.sh"
need_mpi
command -v ip >/dev/null || { echo "there is no ip"; exit 77; }
space=mssim$$ near=msa$$ far=msb$$ network=10.$((64 + $$ % 64)).$(($$ / 64 % 256))
ip netns add "$space" 2>/dev/null || { echo "namespaces need root"; exit 77; }
trap 'ip netns del "$space"; ip link del "$near" 2>/dev/null; rm -rf "$work"' EXIT
ip link add "$near" type veth peer name "$far" netns "$space" 2>/dev/null || { echo "there are no virtual networks"; exit 77; }
ip addr add "$network.1/24" dev "$near"
ip link set "$near" up
for command in "addr add $network.2/24 dev $far" "link set $far up" "link set lo up"; do
  # shellcheck disable=SC2086 # they are words
  ip netns exec "$space" ip $command
done
cd "$work"

# What stands for ssh: runs a command there. Its options and the host's name come before it.
cat >agent <<END
#!/bin/bash
while [[ \$1 == -* ]]; do shift; done
shift
exec ip netns exec $space unshare -u bash -c 'hostname othernode; eval "\$1"' sh "\$*"
END
chmod +x agent
let_ranks_share
export OMPI_MCA_plm_rsh_agent=$work/agent OMPI_MCA_oob_tcp_if_include=$network.0/24 OMPI_MCA_btl_tcp_if_include=$network.0/24
hosts="mpirun --host localhost:1,$network.2:1"

succeed bench --scene cloth2500 --backend openmp,mpi --integrator semi-euler,rk4 --ranks 2 --threads 1 --rounds 2 --launcher "$hosts" --out two
[ "$(column_of two/timings.csv device | sort | uniq -c | xargs)" = "2 2 hosts 2 $(column_of two/timings.csv device | head -n 1)" ] ||
  fail "mpi did not run on two hosts: $(cat two/timings.csv)"
[ "$(hashes two | wc -l)" -eq 2 ] || fail "two hosts have other bits: $(cat two/timings.csv)"
succeed bench --scene box-small --backend openmp,mpi --integrator rk4 --ranks 2 --threads 1 --rounds 1 --launcher "$hosts" --out body
[ "$(column_of body/timings.csv verified | sort | uniq -c | xargs)" = '2 true' ] || fail "a body on two hosts: $(cat body/timings.csv)"
[ "$(hashes body | wc -l)" -eq 1 ] || fail "a body has other bits on two hosts: $(cat body/timings.csv)"

# broken kill|cut PATTERN: while a bench runs, a rank of the other machine is killed, or its network is cut; within 30 s the row of
# mpi says so
broken() {
  local bench seconds
  rm -rf broken
  "$mssim" bench --scene cloth40k --integrator semi-euler --backend openmp,mpi --ranks 2 --threads 1 --rounds 60 --launcher "$hosts" --out broken \
    >/dev/null 2>err &
  bench=$!
  rank=$(rank_of 1 "^OMPI_MCA_plm_rsh_agent=$work/agent")
  sleep 3
  if [ "$1" = kill ]; then kill -KILL "$rank"; else ip link set "$near" down; fi
  seconds=$SECONDS
  wait "$bench" && fail "a bench with a row that failed is content"
  # openmp's samples go on for some seconds.
  [ $((SECONDS - seconds)) -lt 45 ] || fail "the bench ends $((SECONDS - seconds)) s after its row has failed"
  grep ',mpi,' broken/timings.csv | grep -q -- "$2" || fail "the row of mpi does not say \"$2\": $(cat broken/timings.csv)"
  grep -q ',openmp,.*,true,ok,' broken/timings.csv || fail "the row of openmp is missing: $(cat broken/timings.csv)"
  ! pgrep -f "^[^ ]*/mssim-mpi rank$" | xargs -I PID grep -lzx "OMPI_MCA_plm_rsh_agent=$work/agent" /proc/PID/environ 2>/dev/null ||
    fail "a rank stays behind"
}
broken kill 'rank 1 .* on node .* exited on signal 9'
broken cut 'has heard nothing for 20 seconds from rank 1 on othernode'
exit $((failures > 0))
