#include "bench/machine/noise.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "text/text.h"

namespace mssim {
namespace {

/// Programs that compute beside the bench, on the average of the last minute, before they are worth a word.
constexpr double least_load = 0.25;

bool binds_threads(const Provenance& provenance) {
  return std::ranges::any_of(provenance.thread_environment, [](const auto& variable) {
    const auto& [name, value] = variable;
    return name == "GOMP_CPU_AFFINITY" || name == "OMP_PLACES" ||
           (name == "OMP_PROC_BIND" && value != "false" && value != "FALSE");
  });
}

std::string one_decimal(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

}  // namespace

std::vector<std::string> noise_of(const Provenance& provenance) {
  const Machine& machine = provenance.machine;
  std::vector<std::string> noise;
  if (!machine.load_average.empty() && machine.load_average.front() >= least_load)
    noise.push_back("other programs are running (load " + one_decimal(machine.load_average.front()) +
                    " over the last minute): end them or wait");
  if (machine.governor && *machine.governor != "performance")
    noise.push_back("the frequency governor is \"" + *machine.governor +
                    "\": choose \"performance\" (cpupower frequency-set -g performance)");
  if (machine.turbo.value_or(false))
    noise.emplace_back(
        "turbo is on, so that the frequency depends on temperature and neighbours: turn it off");
  const std::size_t cpus = provenance.allowed_cpus.size();
  if (provenance.threads > 1 && cpus > 0 && static_cast<std::size_t>(provenance.threads) > cpus)
    noise.push_back(std::to_string(provenance.threads) + " threads share " + pluralize(cpus, "logical CPU") +
                    ": ask for fewer with --threads");
  if (machine.cpu_quota && provenance.threads > *machine.cpu_quota)
    noise.push_back(
        "a quota of this container lets " +
        pluralize(static_cast<std::uint64_t>(provenance.threads), "thread") + " run for the time of " +
        one_decimal(*machine.cpu_quota) + " processors and then stops them: " +
        (provenance.threads > 1 ? "ask for fewer with --threads, or raise the quota" : "raise the quota"));
  if (provenance.threads > 1 && !binds_threads(provenance))
    noise.emplace_back("threads may move from CPU to CPU: set OMP_PROC_BIND=true");
  return noise;
}

}  // namespace mssim
