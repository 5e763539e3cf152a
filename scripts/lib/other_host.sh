# shellcheck shell=bash
# Another machine for programs that MPI starts: a network namespace of this machine with its own name and address, connected by a pair of
# virtual network devices. Sourced after lib/mpi.sh. Needs root.

# make_other_host FOLDER [DELAY_US]: makes it, and sets `hosts`, the launcher of MPI for a rank here and one there. A file in FOLDER
# replaces ssh. Each rank gets its own processor if there are two. Messages are delayed by DELAY_US microseconds each way, if the kernel
# supports that. If something is not permitted, prints a message and returns 1; remove_other_host may be called then too.
make_other_host() {
  local command network=10.$((64 + $$ % 64)).$(($$ / 64 % 256)) last=$(($(nproc) - 1))
  other_space=mssim$$ other_near=msa$$
  local far=msb$$
  command -v ip >/dev/null || { echo "there is no ip: install iproute2" >&2; return 1; }
  ip netns add "$other_space" 2>/dev/null || { echo "namespaces need root" >&2; return 1; }
  ip link add "$other_near" type veth peer name "$far" netns "$other_space" 2>/dev/null ||
    { echo "there are no virtual networks" >&2; return 1; }
  ip addr add "$network.1/24" dev "$other_near"
  ip link set "$other_near" up
  for command in "addr add $network.2/24 dev $far" "link set $far up" "link set lo up"; do
    # shellcheck disable=SC2086 # they are words
    ip netns exec "$other_space" ip $command
  done
  if ((${2-0} > 0)); then
    for command in "tc qdisc add dev $other_near" "ip netns exec $other_space tc qdisc add dev $far"; do
      # shellcheck disable=SC2086 # they are words
      $command root netem delay "$2us" 2>/dev/null || { echo "this kernel delays no messages: it has no netem" >&2; return 1; }
    done
  fi
  # Runs a command there. ssh's options and the host's name come before it.
  cat >"$1/agent" <<END
#!/bin/bash
while [[ \$1 == -* ]]; do shift; done
shift
exec taskset -c $last ip netns exec $other_space unshare -u bash -c 'hostname othernode; eval "\$1"' sh "\$*"
END
  chmod +x "$1/agent"
  let_ranks_share
  export OMPI_MCA_plm_rsh_agent=$1/agent OMPI_MCA_oob_tcp_if_include=$network.0/24 OMPI_MCA_btl_tcp_if_include=$network.0/24
  # shellcheck disable=SC2034 # for who has sourced this
  hosts="taskset -c 0 mpirun --host localhost:1,$network.2:1"
}

remove_other_host() {
  ip netns del "$other_space" 2>/dev/null || true
  ip link del "$other_near" 2>/dev/null || true
}
