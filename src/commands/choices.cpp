#include "commands/choices.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backends/backends.h"
#include "commands/exit_code.h"
#include "integrators/integrators.h"
#include "scene/nearest_name.h"

namespace mssim {
namespace {

/// More threads than this are a typing error, and would only fail later and less clearly.
constexpr int most_threads = 4096;

const std::map<std::string, DeviceMemory> device_memories{{"copy", DeviceMemory::copy},
                                                          {"shared", DeviceMemory::shared}};

UsageError unknown(const std::string& what, const std::string& name,
                   const std::vector<std::string_view>& known) {
  const std::string_view nearest = nearest_name(name, known);
  const std::string remedy = nearest.empty() ? "" : "did you mean " + std::string(nearest) + "? ";
  return UsageError("unknown " + what + " \"" + name + "\": " + remedy + "Known are " + listed(known));
}

}  // namespace

const BackendInfo& require_backend(const std::string& name) {
  std::vector<const BackendInfo*> known;
  for (const BackendInfo& backend : backends()) known.push_back(&backend);
  return require_backend(name, known);
}

const BackendInfo& require_backend(const std::string& name, const std::vector<const BackendInfo*>& known) {
  std::vector<std::string_view> names;
  for (const BackendInfo* backend : known) {
    if (backend->name == name) return *backend;
    names.push_back(backend->name);
  }
  throw unknown("backend", name, names);
}

const Integrator& require_integrator(const std::string& name) {
  if (const Integrator* integrator = find_integrator(name)) return *integrator;
  std::vector<std::string_view> names;
  for (const Integrator& integrator : integrators) names.push_back(integrator.name);
  throw unknown("integrator", name, names);
}

CLI::Validator positive_number() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0) return "";
        return "\"" + text + "\" is not a positive number";
      },
      "POSITIVE");
}

void declare_execution(CLI::App& app, ExecutionOptions& options) {
  app.add_option("--threads", options.threads,
                 "Threads, and compute units of an OpenCL device that is a processor (default: one for every "
                 "processor)")
      ->check(CLI::Range(1, most_threads));
  app.add_option("--device", options.device,
                 "OpenCL device: its number or a part of its name (see mssim list devices)");
  app.add_option_function<std::string>(
         "--memory", [&options](const std::string& name) { options.memory = device_memories.at(name); },
         "How host and OpenCL device exchange data: shared, without copying where the device can, or copy "
         "(default: shared)")
      ->check(CLI::IsMember(&device_memories));
}

std::string name_of(DeviceMemory memory) {
  return std::ranges::find(device_memories, memory, [](const auto& choice) { return choice.second; })->first;
}

ExecutionOptions complete(ExecutionOptions options) {
  const int limit = omp_get_thread_limit();
  if (options.threads == 0) options.threads = std::min(omp_get_num_procs(), limit);
  if (options.threads > limit)
    throw UsageError("--threads " + std::to_string(options.threads) +
                     " is more than OMP_THREAD_LIMIT allows, " + std::to_string(limit) +
                     "; ask for fewer, or unset it");
  omp_set_dynamic(0);
  return options;
}

}  // namespace mssim
