#pragma once

namespace mssim {

/// What mssim starts: runs the launcher of MPI (MSSIM_LAUNCHER, default `mpirun`) with MSSIM_RANKS times
/// `mssim-mpi rank`, or `mssim-mpi rank copies`, passes on what they print, and waits for its end. Where they
/// fail, the last line on stderr is the sentence that says why. Returns the exit code.
int launch_ranks(bool copies);

}  // namespace mssim
