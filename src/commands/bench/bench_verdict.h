#pragma once

#include <string>
#include <vector>

#include "bench/results/result.h"
#include "text/error.h"

namespace mssim {

/// How a bench ends, and why.
struct BenchVerdict {
  /// 1 when a measured row is wrong; 3 when a backend or integrator that was asked for by name could not run.
  ExitCode exit_code = exit_ok;
  std::vector<std::string> reasons;  ///< a sentence for each row that led to it
};

/// `asked_backends` and `asked_integrators`: by name.
BenchVerdict verdict_of(const std::vector<ResultRow>& rows, const std::vector<std::string>& asked_backends,
                        const std::vector<std::string>& asked_integrators);

}  // namespace mssim
