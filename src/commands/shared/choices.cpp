#include "commands/shared/choices.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "commands/shared/scene_list.h"
#include "integrators/all_integrators.h"
#include "platform/machine.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

const std::map<std::string, DeviceMemory> device_memories{{"copy", DeviceMemory::copy},
                                                          {"shared", DeviceMemory::shared}};

/// Those that the process may use, or as many as a container's quota of processor time amounts to.
int usable_processors() {
  const int processors = omp_get_num_procs();
  const std::optional<double> quota = container_limits().processors;
  return quota ? std::min(processors, static_cast<int>(std::ceil(*quota))) : processors;
}

}  // namespace

const Integrator& require_integrator(const std::string& name) {
  if (const Integrator* integrator = find_integrator(name)) return *integrator;
  std::vector<std::string_view> names;
  for (const Integrator* integrator : all_integrators) names.push_back(integrator->name);
  throw UsageError(unknown_name("integrator", name, names));
}

std::vector<const Integrator*> chosen_integrators(const std::vector<std::string>& asked,
                                                  std::span<const std::string_view> by_default) {
  const std::vector<std::string> names =
      asked.empty() ? std::vector<std::string>(by_default.begin(), by_default.end()) : asked;
  if (names == std::vector<std::string>{"all"}) return {all_integrators.begin(), all_integrators.end()};
  std::vector<const Integrator*> named, chosen;
  for (const std::string& name : names) named.push_back(&require_integrator(name));
  for (const Integrator* integrator : all_integrators)
    if (std::ranges::find(named, integrator) != named.end()) chosen.push_back(integrator);
  return chosen;
}

Argument add_scenes(Arguments& arguments, const std::string& name, std::vector<std::string>& target,
                    const std::string& description) {
  return arguments
      .add_list(name, target,
                description + ", separated by commas (but not at a comma in the name of an existing file)",
                names_and_files_in)
      .value_name("NAME|FILE,...");
}

void declare_listing_format(Arguments& arguments, ListingFormat& target) {
  arguments.add_choice<ListingFormat>(
      "--format", target,
      {{"table", ListingFormat::table}, {"csv", ListingFormat::csv}, {"json", ListingFormat::json}},
      "What to print: table, csv or json (default: table)");
}

void declare_execution(Arguments& arguments, ExecutionOptions& options) {
  arguments
      .add_number(
          "--threads", options.threads,
          "Threads, and compute units of an OpenCL device that is a processor (default: one for every "
          "processor)",
          whole_number(1, most_threads))
      .value_name("N");
  arguments
      .add_number("--ranks", options.ranks,
                  "Processes of the backend mpi, of --threads threads each; mpi:N says it of one row "
                  "(default: as many as --threads, of one thread each)",
                  whole_number(1, most_ranks))
      .value_name("N");
  arguments
      .add("--launcher", options.launcher,
           "Command that starts the processes of the backend mpi, to which `-n N PROGRAM` is added (default: "
           "mpirun)")
      .value_name("COMMAND");
  arguments
      .add("--device", options.device,
           "OpenCL device: its number or a part of its name or platform (see mssim list devices)")
      .value_name("N|NAME");
  arguments.add_choice<DeviceMemory>(
      "--memory", options.memory, device_memories,
      "How host and OpenCL device exchange data: shared, without copying where the device can, or copy "
      "(default: shared)");
  arguments.add_choice<Roots>(
      "--roots", options.roots, {{"exact", Roots::exact}, {"fast", Roots::fast}},
      "How openmp and gather-vectors find the lengths of springs: fast, with AVX-512 by an estimate and a "
      "Newton step, or "
      "exact, "
      "which gives the same bits on every processor that has multiply-adds (default: fast)");
}

std::string name_of(DeviceMemory memory) {
  return std::ranges::find(device_memories, memory, [](const auto& choice) { return choice.second; })->first;
}

void require_few_threads(int threads) {
  constexpr int most_a_processor = 8;
  const int processors = omp_get_num_procs();
  if (threads > most_a_processor * processors)
    throw UsageError("--threads " + std::to_string(threads) + " is too many for the " +
                     pluralize(static_cast<std::uint64_t>(processors), "processor") +
                     " that this process may use; ask for at most " +
                     std::to_string(most_a_processor * processors) + ", " + std::to_string(most_a_processor) +
                     " for each");
}

ExecutionOptions complete(ExecutionOptions options) {
  const int limit = omp_get_thread_limit();
  options.threads_given = options.threads > 0;
  if (!options.threads_given) options.threads = std::min(usable_processors(), limit);
  if (options.launcher.empty()) require_few_threads(options.threads);  // a launcher's hosts may have more
  if (options.threads > limit)
    throw UsageError("--threads " + std::to_string(options.threads) +
                     " is more than OMP_THREAD_LIMIT allows, " + std::to_string(limit) +
                     "; ask for fewer, or unset it");
  omp_set_dynamic(0);
  return options;
}

}  // namespace mssim
