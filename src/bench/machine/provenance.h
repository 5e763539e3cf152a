#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "text/text.h"

namespace mssim {

/// How a program was built: the part of every provenance that is known before a run.
struct BuildInfo {
  std::string version;     ///< of the project, for example "0.1.0"
  std::string commit;      ///< 40 hex digits, or "unknown" when built outside a git repository
  bool dirty = false;      ///< whether the program's sources differed from that commit
  std::string compiler;    ///< name and version, for example "GNU 12.2.0"
  std::string flags;       ///< compiler flags of all timed code
  std::string build_type;  ///< CMake's, for example "Release"
};

/// Whether the commit is known.
inline bool knows_commit(const BuildInfo& build) { return build.commit != "unknown"; }

/// BuildInfo of the running program.
const BuildInfo& build_info();

/// Name of the processor's design, for example "Zen 4" or "Sapphire Rapids", from its numbers in
/// /proc/cpuinfo. On x86-64 `maker` is the vendor's identification. On Arm it is the implementer's number as
/// the kernel writes it ("0x41"), `model` is the part's number, and `family` is zero. Names such as "AMD
/// EPYC", which virtual machines often report, do not show how fast a processor is. Empty if the table has no
/// entry.
std::string_view cpu_generation(std::string_view maker, int family, int model);

/// A kind of cache, by level and type; the machine may have several of it.
struct Cache {
  int level = 0;
  std::string type;         ///< "Data", "Instruction" or "Unified"
  std::uint64_t bytes = 0;  ///< size of one
  int count = 0;            ///< in the machine
  int sharing = 0;          ///< logical CPUs that share one
};

/// Properties of a Linux machine that can be read without privileges. Unknown ones are empty or zero.
struct Machine {
  std::string cpu_model;
  std::string cpu_generation;           ///< its design
  int logical_cpus = 0;                 ///< online
  std::optional<bool> smt;              ///< whether cores have several logical CPUs
  int numa_nodes = 0;                   ///< parts of the memory that are nearer to some CPUs
  double cpu_mhz = 0;                   ///< present frequency of the first CPU
  std::vector<Cache> caches;            ///< by level, then type
  std::optional<std::string> governor;  ///< of the first CPU; none in most virtual machines
  std::optional<bool> turbo;            ///< whether the frequency may exceed the nominal one, if known
  std::vector<double> load_average;     ///< over 1, 5 and 15 minutes
  std::uint64_t memory_bytes = 0;
  std::optional<double> cpu_quota;                  ///< CPUs' worth of time that a container may use
  std::optional<std::uint64_t> memory_limit_bytes;  ///< of a container
  std::string operating_system;                     ///< the distribution's name for itself
  std::string kernel;                               ///< system, release and architecture
};

/// "MODEL, GENERATION", without what is unknown.
inline std::string cpu_name(const Machine& machine) {
  return machine.cpu_generation.empty() ? machine.cpu_model
                                        : machine.cpu_model + ", " + machine.cpu_generation;
}

/// Reads the properties of this machine, as they are now. `root` is put before /proc, /sys and /etc, so that
/// tests can supply a made-up machine.
Machine read_machine(const std::filesystem::path& root = "/");

/// A scene and the hash of its file's text; equal hashes mean that two runs simulated the same scene.
struct SceneHash {
  std::string name;
  std::uint64_t fnv1a_64 = 0;
  /// Of what the files made that it names (SceneParts); none if it names none, or if it is not known.
  std::optional<std::uint64_t> files_fnv1a_64 = {};
};

/// A file that a program was run from, named as in its command.
struct FileHash {
  std::string name;
  std::uint64_t fnv1a_64 = 0;

  friend bool operator==(const FileHash& a, const FileHash& b) = default;
};

/// A user's program that is a backend.
struct BackendProgramRecord {
  std::string name;
  std::vector<std::string> command = {};  ///< as its user wrote it
  std::vector<FileHash> files = {};       ///< the program, and its arguments that are files, by name
  /// Variables that its description sets, by name. The user's home folder is ~.
  std::vector<std::pair<std::string, std::string>> environment = {};
  int ranks = 0;              ///< processes that it runs in; 0: one, with the run's number of threads
  int rank_threads = 0;       ///< per process
  std::string launcher = {};  ///< the command that starts them; empty: the default

  friend bool operator==(const BackendProgramRecord& a, const BackendProgramRecord& b) = default;
};

/// Origin of measured numbers, in enough detail to judge them and to repeat the measurement. Names neither
/// the user nor the host, and only those environment variables that control threads or that descriptions of
/// programs set.
struct Provenance {
  BuildInfo build;
  std::optional<std::uint64_t> program_fnv1a_64;  ///< of the program's file; none from older versions
  Machine machine;                                ///< when the run started
  int threads = 0;                                ///< requested
  std::vector<int> allowed_cpus;                  ///< process_cpus()
  /// OMP_ and GOMP_ variables, by name.
  std::vector<std::pair<std::string, std::string>> thread_environment;
  /// CPUs of each place to which OpenMP binds threads; empty if it binds none. No file has them.
  std::vector<std::vector<int>> thread_places;
  /// How backends with a device exchange data, how vector code computes roots ("fast" or "exact"), and its
  /// instruction set, if one was requested; empty from older versions.
  std::string device_memory, roots, instruction_set;
  std::vector<std::string> opencl_devices;  ///< platform, device and driver, as the caller describes them
  std::string tetgen;  ///< version and hash of the TetGen that meshes bodies here, or that it cannot be
                       ///< started; or empty
  std::vector<std::string> noise;  ///< conditions that make times longer or less certain
  std::vector<SceneHash> scenes;
  std::vector<BackendProgramRecord> backend_programs;  ///< by name
  std::vector<std::string> command_line;  ///< without the program's folder; the home folder is ~; escaped()
  std::vector<std::string> earlier_starts_utc;  ///< of the runs that this one continues
  std::string started_utc;                      ///< ISO 8601, for example "2026-01-31T12:00:00Z"
};

/// A setting of backends in a provenance.
struct RecordedSetting {
  const char* option;  ///< by which a user gives it
  const char* member;  ///< of provenance.json
  std::string Provenance::*value;
};
inline constexpr std::array<RecordedSetting, 3> recorded_settings{
    {{"--memory", "device_memory", &Provenance::device_memory},
     {"--roots", "roots", &Provenance::roots},
     {"--instruction-set", "instruction_set", &Provenance::instruction_set}}};

/// Gathers everything that is known at the start. The caller adds scenes, OpenCL devices and TetGen.
/// `arguments` are main's.
Provenance gather_provenance(const std::vector<std::string>& arguments, int threads);

/// A row's backend and the number of processors that it was told to use.
struct AskedProcessors {
  std::string_view backend;  ///< without the threads in the row's name: "openmp" for "openmp:2"
  int count = 0;
};
/// The backend and the requested processors of a row, from its name and the provenance.
inline AskedProcessors asked_processors(const Provenance& provenance, std::string_view row_name) {
  for (const BackendProgramRecord& program : provenance.backend_programs)
    if (program.name == row_name)
      return {row_name, program.ranks > 0 ? program.ranks * program.rank_threads : provenance.threads};
  const std::size_t colon = std::min(row_name.rfind(':'), row_name.size() - 1);
  const std::optional<int> threads = number_in<int>(row_name.substr(colon + 1));
  return threads ? AskedProcessors{row_name.substr(0, colon), *threads}
                 : AskedProcessors{row_name, provenance.threads};
}

/// Whether a row is of a program that is a backend, from the row's name and the provenance.
inline bool is_of_program(const Provenance& provenance, std::string_view row_name) {
  const std::string_view backend = asked_processors(provenance, row_name).backend;
  return std::ranges::find(provenance.backend_programs, backend, &BackendProgramRecord::name) !=
         provenance.backend_programs.end();
}

/// Adds `record`, a program that is a backend, with the hashes of its files: of an argument's file above 64
/// MiB, only of its size and the time of its last change. `program` is the file of the command's first word,
/// `folder` the working folder.
void add_program(Provenance& provenance, BackendProgramRecord record, const std::filesystem::path& program,
                 const std::filesystem::path& folder);

/// Adds the hash of a scene file's text, and that of the files that it names.
void add_scene(Provenance& provenance, std::string_view name, std::string_view file_text,
               std::optional<std::uint64_t> files_fnv1a_64 = {});

/// Conditions that make times on this machine longer or less repeatable: one sentence each, with a remedy.
/// Considers load, governor and turbo of the machine, the requested threads, the CPUs where they may run, and
/// the places to which they are bound.
/// Conditions that the system does not report are ignored.
std::vector<std::string> noise_of(const Provenance& provenance);

}  // namespace mssim
