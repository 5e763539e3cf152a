#pragma once

namespace mssim {

/// What mssim starts: runs the launcher of MPI (MSSIM_LAUNCHER, default `mpirun`) with MSSIM_RANKS times
/// `mssim-mpi rank`, or `mssim-mpi rank copies`, passes on what they print, and waits for its end. Where they
/// fail, the last line on stderr is the sentence that says why. Returns the exit code.
int launch_ranks(bool copies);

/// What a launcher of MPI starts as many times as there are ranks (`mssim-mpi rank`): steps a part of the
/// scene, or (`mssim-mpi rank copies`) the whole; rank 0 speaks with mssim. Returns the exit code. Where a
/// rank fails, its sentence is on stderr, and all ranks are ended.
int run_rank(int argc, char** argv);

}  // namespace mssim
