#pragma once

#include <span>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "bench/machine/provenance.h"
#include "commands/shared/prepared_scene.h"
#include "output/traces/h5md_trace.h"

namespace mssim {

/// Remembers main's arguments for the provenance of what the program writes. Called once, first.
void remember_arguments(int argc, char** argv);

/// Where this run's numbers come from, with the OpenCL devices of the machine where one may be used:
/// only then are drivers asked. Scenes are added with add_scene.
Provenance run_provenance(int threads, bool uses_device);

/// Its command line in one line, quoted where a shell needs it.
std::string command_line(const Provenance& provenance);

/// The header of a trace of `scene`, stepped by `backend` (called `backend_name` in the table) in the run of
/// that provenance.
TraceHeader trace_header(const PreparedScene& scene, const Backend& backend, const std::string& backend_name,
                         const Integrator& integrator, const Provenance& provenance);

}  // namespace mssim
