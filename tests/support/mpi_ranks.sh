# Functions of the tests of the backend mpi, with those that all tests of the command line have. Skips the test where mssim has been built
# without MPI, or nothing starts its ranks.
# shellcheck shell=bash
support=$(dirname -- "${BASH_SOURCE[0]}")
# shellcheck source=tests/support/command_line.sh
. "$support/command_line.sh"
# shellcheck source=scripts/lib/mpi.sh
. "$support/../../scripts/lib/mpi.sh"

[ -x "${mssim%/*}/../libexec/mssim/mssim-mpi" ] || skip "mssim was built without MPI"
command -v mpirun >/dev/null || skip "there is no mpirun"
export TMPDIR=$work/tmp
mkdir tmp

# ranks_here: the processes of all ranks that this test has started, which have folders in $work
ranks_here() {
  local pid
  for pid in $(pgrep -f "^[^ ]*/mssim-mpi rank"); do
    grep -qz -- "^TMPDIR=$work/" "/proc/$pid/environ" 2>/dev/null && echo "$pid"
  done
  return 0
}

# rank_of NUMBER PATTERN: the process of that rank, once it is there, of the ranks with a variable that matches
rank_of() {
  local pid i
  for ((i = 0; i < 900; ++i)); do  # a sanitizer's take their time
    for pid in $(pgrep -f "^[^ ]*/mssim-mpi rank$"); do
      grep -qz -- "$2" "/proc/$pid/environ" 2>/dev/null || continue
      grep -qzx "OMPI_COMM_WORLD_RANK=$1" "/proc/$pid/environ" 2>/dev/null && echo "$pid" && return
    done
    sleep 0.1
  done
}

# hashes FOLDER: of the states of all integrators, each once; notes before them hold commas
hashes() { sed -nE 's/^([^,]*,){7}([^,]*),.*,([0-9a-f]{16}),.*/\2 \3/p' "$1/timings.csv" | sort -u; }

# All explicit integrators, and how many they are.
# shellcheck disable=SC2034 # tests use them
explicit=$(explicit_integrators | paste -sd,) explicit_count=$(explicit_integrators | wc -l)

# same_bits SCENE RANKS THREADS INTEGRATORS COUNT: mpi is verified with each of these COUNT integrators, and has the bits of openmp;
# the results are in the folder bits
same_bits() {
  rm -rf bits
  ends 0 bench --scene "$1" --backend openmp,mpi --integrator "$4" --ranks "$2" --threads "$3" --rounds 1 --out bits
  all_verified bits $((2 * $5))
  [ "$(hashes bits | wc -l)" -eq "$5" ] || fail "$1 with $2 ranks of $3 threads has other bits"
}

# fails_with PATTERN FOLDER: the row of mpi has failed with that sentence, and the one of openmp is verified
fails_with() {
  grep -q ',openmp,.*,true,ok,' "$2/timings.csv" || fail "the row of openmp is missing: $(cat "$2/timings.csv")"
  grep ',mpi,' "$2/timings.csv" | grep -q -- "$1" || fail "the row of mpi does not say \"$1\": $(grep ',mpi,' "$2/timings.csv")"
}

# mixed_processors SCENE RANKS REFUSED: ranks on processors of different instruction sets have the bits of exact roots, or are refused
mixed_processors() {
  [ "$(uname -m)" = x86_64 ] || return 0
  # The ranks but the first one have the instruction set of the variable SET.
  make_program mixed <<'END'
exec mpirun -n "$2" sh -c '[ "$OMPI_COMM_WORLD_RANK" = 0 ] || export MSSIM_INSTRUCTION_SET=$SET; exec "$@"' sh "${@:3}"
END
  ends 0 bench --scene "$1" --backend openmp --integrator rk4 --threads 1 --rounds 1 --roots exact --out exact
  SET=AVX2 ends 0 bench --scene "$1" --backend mpi --integrator rk4 --ranks "$2" --threads 1 --rounds 1 --launcher "$work/mixed" --out mixed_bits
  [ "$(hashes exact)" = "$(hashes mixed_bits)" ] || fail "AVX-512 and AVX2: $(cat mixed_bits/timings.csv)"
  SET=SSE4 ends 3 bench --scene "$3" --backend openmp,mpi --integrator rk4 --ranks 2 --threads 1 --rounds 1 --launcher "$work/mixed" --out sse
  fails_with "unsupported: rank 0 on .* and rank 1 on $(uname -n) SSE4, which round differently" sse
}
