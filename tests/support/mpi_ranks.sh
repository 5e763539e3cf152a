# Functions of the tests of the backend mpi. Sourced after command_line.sh, which sets `mssim`.
# shellcheck shell=bash
: "${mssim:?}"

# need_mpi: skips the test where mssim has been built without MPI, or nothing starts its ranks
need_mpi() {
  [ -x "${mssim%/*}/../libexec/mssim/mssim-mpi" ] || { echo "mssim was built without MPI"; exit 77; }
  command -v mpirun >/dev/null || { echo "there is no mpirun"; exit 77; }
}

# rank_of NUMBER PATTERN: the process of that rank, once it is there, of the ranks with a variable that matches
rank_of() {
  local pid i
  for ((i = 0; i < 100; ++i)); do
    for pid in $(pgrep -f "^[^ ]*/mssim-mpi rank$"); do
      grep -qz -- "$2" "/proc/$pid/environ" 2>/dev/null || continue
      grep -qzx "OMPI_COMM_WORLD_RANK=$1" "/proc/$pid/environ" 2>/dev/null && echo "$pid" && return
    done
    sleep 0.1
  done
}

# hashes FOLDER: of the states of all integrators, each once; notes before them hold commas
hashes() { sed -nE 's/^([^,]*,){7}([^,]*),.*,([0-9a-f]{16}),.*/\2 \3/p' "$1/timings.csv" | sort -u; }
