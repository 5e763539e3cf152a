#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "integrators/integrator.h"

namespace mssim {

/// The backend of that name. Throws UsageError naming the nearest or listing the known.
const BackendInfo& require_backend(const std::string& name);

/// The same among `known` ones.
const BackendInfo& require_backend(const std::string& name, const std::vector<const BackendInfo*>& known);

/// The integrator of that name. Throws like require_backend.
const Integrator& require_integrator(const std::string& name);

/// Accepts finite numbers above zero, and says so in words.
CLI::Validator positive_number();

/// Declares --threads, --device and --memory. `options` must outlive the parsing.
void declare_execution(CLI::App& app, ExecutionOptions& options);

/// `threads` as given or, for 0, one for every processor that this process may use.
ExecutionOptions complete(ExecutionOptions options);

}  // namespace mssim
