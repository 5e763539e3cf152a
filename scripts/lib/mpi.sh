# shellcheck shell=bash
# Settings for Open MPI. Sourced; sets environment variables, unless the user has set them.

# As root, for example in a container, mpirun refuses to run unless two variables allow it.
allow_root_ranks() {
  if [ "$(id -u)" -eq 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=${OMPI_ALLOW_RUN_AS_ROOT-1} OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=${OMPI_ALLOW_RUN_AS_ROOT_CONFIRM-1}
  fi
}

# Also lets mpirun start more ranks than there are processors: mssim verifies such rows without timing them.
allow_ranks() {
  allow_root_ranks
  export OMPI_MCA_rmaps_base_oversubscribe=${OMPI_MCA_rmaps_base_oversubscribe-1}
}

# Also for tests: waiting ranks yield to others. Messages are copied through shared memory, because containers forbid reading the memory of
# another process.
let_ranks_share() {
  allow_ranks
  export OMPI_MCA_mpi_yield_when_idle=${OMPI_MCA_mpi_yield_when_idle-1}
  export OMPI_MCA_btl_vader_single_copy_mechanism=${OMPI_MCA_btl_vader_single_copy_mechanism-none}
}
