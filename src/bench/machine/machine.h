#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mssim {

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

}  // namespace mssim
