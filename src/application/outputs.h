#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "application/prepared_scene.h"
#include "backends/backends.h"
#include "bench/machine/provenance.h"
#include "output/traces/h5md_trace.h"

namespace mssim {

/// A file of a command: its role, as in messages, and its path.
struct NamedFile {
  std::string role;  ///< for example "--trace"
  std::filesystem::path path;
};

/// Throws UsageError unless every file that a command writes differs from all others and from those that it
/// reads. Considers temporary names too, and resolves links and "." in paths.
void require_distinct(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

/// Throws UsageError if the name of a file with `content`, for example "PNG", has an extension other than
/// `extensions`. The message proposes the first of these.
void require_extension(const NamedFile& file, const std::string& content,
                       const std::vector<std::string_view>& extensions);

/// Keeps main's arguments for the provenance of written files. Must be called once, first.
void remember_arguments(int argc, char** argv);

/// The provenance of this run. `uses_device`: includes the machine's OpenCL devices; only then drivers are
/// queried. Scenes are added with add_scene.
Provenance run_provenance(int threads, bool uses_device);

/// The header of a trace of `scene`, stepped by `backend`, which is of the row `info`, in the run of that
/// provenance.
TraceHeader trace_header(const PreparedScene& scene, const Backend& backend, const BackendInfo& info,
                         const Integrator& integrator, const Provenance& provenance);

}  // namespace mssim
