# shellcheck shell=bash
# What Open MPI needs to be told here. Sourced; sets variables of the environment, which the user's own go before.

# As root, in a container say, mpirun runs nothing unless it is told twice that it may.
allow_root_ranks() {
  if [ "$(id -u)" -eq 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=${OMPI_ALLOW_RUN_AS_ROOT-1} OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=${OMPI_ALLOW_RUN_AS_ROOT_CONFIRM-1}
  fi
}

# The same, and mpirun starts more ranks than there are processors: mssim verifies such rows, and gives them no time.
allow_ranks() {
  allow_root_ranks
  export OMPI_MCA_rmaps_base_oversubscribe=${OMPI_MCA_rmaps_base_oversubscribe-1}
}

# The same, as tests have it: ranks let each other run while they wait. Messages are copied through shared memory, because
# containers forbid reading the memory of another process.
let_ranks_share() {
  allow_ranks
  export OMPI_MCA_mpi_yield_when_idle=${OMPI_MCA_mpi_yield_when_idle-1}
  export OMPI_MCA_btl_vader_single_copy_mechanism=${OMPI_MCA_btl_vader_single_copy_mechanism-none}
}
