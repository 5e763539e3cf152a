#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"

namespace mssim {

/// Why times of two runs may not be held against each other: a sentence for each thing that is not the same,
/// such as "the CPU was A with 2 logical CPUs and is B with 4 logical CPUs"; none when they may.

/// CPU, compiler (with its build type and flags), threads, and the text of scenes that both runs have.
std::vector<std::string> differences(const Provenance& before, const Provenance& now);

/// For the combinations that both runs have: the device, and how large the scene came out (another TetGen
/// makes another mesh of the same file). Rows that nothing was measured for don't count.
std::vector<std::string> differences(std::span<const ResultRow> before, std::span<const ResultRow> now);

}  // namespace mssim
