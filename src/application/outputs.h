#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "application/prepared_scene.h"
#include "backends/interface/backend.h"
#include "bench/machine/provenance.h"
#include "output/traces/h5md_trace.h"

namespace mssim {

/// A file of a command: what it is, as messages call it, and where.
struct NamedFile {
  std::string role;  ///< for example "--trace"
  std::filesystem::path path;
};

/// Throws UsageError unless every file that a command writes, also under the name that it has until it is
/// whole, is another one than all others and than those that the command reads; links and "." in paths are
/// seen through.
void require_distinct(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

/// Throws UsageError where the name of a file that gets `content`, for example "PNG", ends as that of
/// another kind of file does: neither in nothing nor in one of these, the first of which is proposed.
void require_extension(const NamedFile& file, const std::string& content,
                       const std::vector<std::string_view>& extensions);

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
