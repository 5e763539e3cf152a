#pragma once

#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/process/backend_program.h"

namespace mssim {

/// NAME=VALUE: what the program finds in its environment beside this process's. `socket`: where mssim
/// listens.
std::vector<std::string> environment_of(const BackendProgram& program, const std::string& socket,
                                        const Integrator& integrator, const ExecutionOptions& options);

/// The first of the processors that mssim may use; none where the program may use all of them.
std::vector<int> first_cpus(int threads);

}  // namespace mssim
