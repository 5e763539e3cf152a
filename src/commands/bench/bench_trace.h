#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/bench_scene.h"
#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "commands/shared/prepared_scene.h"

namespace mssim {

/// Traces every combination whose row is ok, from the start over as many steps as it was verified with, into
/// FOLDER/STEM.h5, `stems` being those of the rows' files: what `mssim bench --trace` does after the timing.
/// Files that are there already stay when `keep_existing`. `provenance`: the bench's. Ends between two traces
/// when it is asked to. A row has failed where the program behind its backend fails now; returns whether one
/// has. Throws WriteError.
bool write_bench_traces(const SceneJob& job, const PreparedScene& scene, std::vector<ResultRow>& rows,
                        const std::vector<std::string>& stems, const Provenance& provenance,
                        const std::filesystem::path& folder, bool keep_existing, const BenchWatch& watch);

}  // namespace mssim
