#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/machine/build_info.h"
#include "bench/machine/machine.h"

namespace mssim {

/// A scene and a hash of its file's text, by which two runs can tell whether they simulated the same.
struct SceneHash {
  std::string name;
  std::uint64_t fnv1a_64 = 0;
};

/// A file that a program was run from, as its command names it.
struct FileHash {
  std::string name;
  std::uint64_t fnv1a_64 = 0;

  friend bool operator==(const FileHash& a, const FileHash& b) = default;
};

/// A program of the user's that is a backend.
struct BackendProgramRecord {
  std::string name;
  std::vector<std::string> command = {};  ///< as its user wrote it
  std::vector<FileHash> files = {};       ///< the program, and those of its arguments that are files, by name
  int ranks = 0;              ///< processes that it runs in; 0: one, of as many threads as are asked for
  int rank_threads = 0;       ///< of each of them
  std::string launcher = {};  ///< the command that starts them; empty: the usual one

  friend bool operator==(const BackendProgramRecord& a, const BackendProgramRecord& b) = default;
};

/// Where numbers come from: enough to judge them and to measure them again. Names neither the user nor the
/// host, and of the environment only what steers threads.
struct Provenance {
  BuildInfo build;
  std::optional<std::uint64_t> program_fnv1a_64;  ///< hash of the program's file; an older mssim did not tell
  Machine machine;                                ///< when the run started
  int threads = 0;                                ///< asked for
  std::vector<int> allowed_cpus;                  ///< process_cpus()
  /// OMP_ and GOMP_ variables, by name.
  std::vector<std::pair<std::string, std::string>> thread_environment;
  std::string device_memory;  ///< how backends with a device exchange data, where that was asked of them
  std::vector<std::string> opencl_devices;  ///< platform, device and driver, as the caller describes them
  std::string tetgen;  ///< version and hash of the TetGen that meshes bodies here; empty when there is none
  std::vector<std::string> noise;  ///< what makes times here longer or less certain
  std::vector<SceneHash> scenes;
  std::vector<BackendProgramRecord> backend_programs;  ///< by name
  std::vector<std::string>
      command_line;  ///< the program without its folder; the home folder reads ~; escaped()
  std::vector<std::string> earlier_starts_utc;  ///< of runs that this one goes on with, as below
  std::string started_utc;                      ///< ISO 8601, for example "2026-01-31T12:00:00Z"
};

/// Gathers all that can be known at the start; scenes, OpenCL devices and TetGen are the caller's to add.
/// `arguments` are main's.
Provenance gather_provenance(const std::vector<std::string>& arguments, int threads);

/// Processors that a row of this backend was asked to use.
inline int asked_processors(const Provenance& provenance, std::string_view backend) {
  for (const BackendProgramRecord& program : provenance.backend_programs)
    if (program.name == backend && program.ranks > 0) return program.ranks * program.rank_threads;
  return provenance.threads;
}

/// Adds a program that is a backend, `record`, to which the hashes of its files are added: `program` is the
/// file of the command's first word, `folder` the one it runs in.
void add_program(Provenance& provenance, BackendProgramRecord record, const std::filesystem::path& program,
                 const std::filesystem::path& folder);

/// Adds the hash of a scene file's text.
void add_scene(Provenance& provenance, std::string_view name, std::string_view file_text);

/// What makes times on this machine longer, or different from run to run: one sentence each with what to do,
/// from the machine's load, governor and turbo and from the threads asked for and where they may run. What
/// the system does not tell is no noise.
std::vector<std::string> noise_of(const Provenance& provenance);

}  // namespace mssim
