#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "text/text.h"

namespace mssim {

/// What a program was built from and how: the part of every provenance that is known before a run.
struct BuildInfo {
  std::string version;     ///< of the project, for example "0.1.0"
  std::string commit;      ///< 40 hex digits, or "unknown" when built outside a git repository
  bool dirty = false;      ///< the program's sources differed from that commit
  std::string compiler;    ///< name and version, for example "GNU 12.2.0"
  std::string flags;       ///< given to the compiler for all that is timed
  std::string build_type;  ///< CMake's, for example "Release"
};

/// What the running program was built from.
const BuildInfo& build_info();

/// What a processor says of itself in /proc/cpuinfo. On x86-64 `maker` is the vendor's identification; on Arm
/// it is the implementer's number as the kernel writes it ("0x41"), `model` the part's, and `family` zero.
struct CpuIdentification {
  std::string_view maker;
  int family = 0;
  int model = 0;
};

/// The design behind the name, for example "Zen 4" or "Sapphire Rapids": names such as "AMD EPYC", which
/// virtual machines often give, say nothing of how fast a processor is. Empty where the table has none.
std::string_view cpu_generation(const CpuIdentification& cpu);

/// A cache of one level and type, of which the machine may have several.
struct Cache {
  int level = 0;
  std::string type;         ///< "Data", "Instruction" or "Unified"
  std::uint64_t bytes = 0;  ///< of one
  int count = 0;            ///< in the machine
  int sharing = 0;          ///< logical CPUs that share one
};

/// What can be known about a Linux machine without asking for rights. What cannot be read is empty or zero.
struct Machine {
  std::string cpu_model;
  std::string cpu_generation;           ///< its design
  int logical_cpus = 0;                 ///< online
  std::optional<bool> smt;              ///< whether cores have several of them
  int numa_nodes = 0;                   ///< parts of the memory that are nearer to some of them
  double cpu_mhz = 0;                   ///< of the first CPU, now
  std::vector<Cache> caches;            ///< by level, then type
  std::optional<std::string> governor;  ///< of the first CPU's frequency; none in most virtual machines
  std::optional<bool> turbo;         ///< whether the frequency may exceed the nominal one, where it is said
  std::vector<double> load_average;  ///< over 1, 5 and 15 minutes
  std::uint64_t memory_bytes = 0;
  std::optional<double> cpu_quota;                  ///< processors' time that a container has
  std::optional<std::uint64_t> memory_limit_bytes;  ///< of a container
  std::string operating_system;                     ///< the distribution's name for itself
  std::string kernel;                               ///< system, release and architecture
};

/// "MODEL, GENERATION", as far as they are known.
inline std::string cpu_name(const Machine& machine) {
  return machine.cpu_generation.empty() ? machine.cpu_model
                                        : machine.cpu_model + ", " + machine.cpu_generation;
}

/// The machine that this runs on, as it is now. `root` stands before /proc, /sys and /etc; tests put a
/// made-up machine there.
Machine read_machine(const std::filesystem::path& root = "/");

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

/// What a row's backend is, and the processors that it was asked to use.
struct AskedProcessors {
  std::string_view backend;  ///< without the threads that the row's name says: "openmp" of "openmp:2"
  int count = 0;
};
inline AskedProcessors asked_processors(const Provenance& provenance, std::string_view row_name) {
  for (const BackendProgramRecord& program : provenance.backend_programs)
    if (program.name == row_name)
      return {row_name, program.ranks > 0 ? program.ranks * program.rank_threads : provenance.threads};
  const std::size_t colon = std::min(row_name.rfind(':'), row_name.size() - 1);
  const std::optional<int> threads = number_in<int>(row_name.substr(colon + 1));
  return threads ? AskedProcessors{row_name.substr(0, colon), *threads}
                 : AskedProcessors{row_name, provenance.threads};
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
