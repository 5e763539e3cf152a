#pragma once

namespace mssim {

/// What a launcher of MPI starts as many times as there are ranks (`mssim-mpi rank`): steps a part of the
/// scene, or (`mssim-mpi rank copies`) the whole; rank 0 speaks with mssim. Returns the exit code. Where a
/// rank fails, its sentence is on stderr, and all ranks are ended.
int run_rank(int argc, char** argv);

}  // namespace mssim
