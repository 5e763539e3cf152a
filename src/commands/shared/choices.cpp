#include "commands/shared/choices.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "backends/backends.h"
#include "commands/shared/exit_code.h"
#include "commands/shared/scene_list.h"
#include "integrators/integrators.h"
#include "text/nearest_name.h"
#include "text/printable.h"

namespace mssim {
namespace {

const std::map<std::string, DeviceMemory> device_memories{{"copy", DeviceMemory::copy},
                                                          {"shared", DeviceMemory::shared}};

/// The text as a number; none where it is anything else.
template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number number = 0;
  return CLI::detail::lexical_cast(text, number) ? std::optional(number) : std::nullopt;
}

/// A check that names the value and what it should have been.
CLI::Validator wanted(std::string what, std::function<bool(const std::string&)> accepts) {
  return CLI::Validator(
      [what = std::move(what), accepts = std::move(accepts)](const std::string& text) -> std::string {
        return accepts(text) ? "" : "\"" + printable(text) + "\" is not " + what;
      },
      "");
}

std::vector<std::string_view> views_of(const std::vector<std::string>& words) {
  return {words.begin(), words.end()};
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
  throw UsageError(unknown_name("backend", name, names));
}

const Integrator& require_integrator(const std::string& name) {
  if (const Integrator* integrator = find_integrator(name)) return *integrator;
  std::vector<std::string_view> names;
  for (const Integrator& integrator : integrators) names.push_back(integrator.name);
  throw UsageError(unknown_name("integrator", name, names));
}

CLI::Validator positive_number() {
  return wanted("a positive number", [](const std::string& text) {
    const auto number = number_in<double>(text);
    return number && std::isfinite(*number) && *number > 0;
  });
}

CLI::Validator number_between(double low, double high) {
  std::ostringstream range;
  range << "a number from " << low << " to " << high;
  return wanted(range.str(), [low, high](const std::string& text) {
    const auto number = number_in<double>(text);
    return number && *number >= low && *number <= high;
  });
}

CLI::Validator whole_number(std::int64_t low, std::int64_t high) {
  return wanted("a whole number from " + std::to_string(low) + " to " + std::to_string(high),
                [low, high](const std::string& text) {
                  const auto number = number_in<std::int64_t>(text);
                  return number && *number >= low && *number <= high;
                });
}

CLI::Validator one_of(std::string what, std::vector<std::string> words) {
  return CLI::Validator(
      [what = std::move(what), words = std::move(words)](std::string& text) -> std::string {
        const std::string asked = CLI::detail::to_lower(text);
        const auto match = std::ranges::find(words, asked);
        if (match == words.end()) return unknown_name(what, text, views_of(words));
        text = *match;
        return "";
      },
      "");
}

CLI::Option* add_scenes(CLI::App& app, const std::string& name, std::vector<std::string>& target,
                        const std::string& description) {
  const auto take = [&target](const std::vector<std::string>& arguments) {
    for (const std::string& argument : arguments)
      std::ranges::copy(scenes_in(argument), std::back_inserter(target));
  };
  return app
      .add_option_function<std::vector<std::string>>(
          name, take,
          description + ", separated by commas (but not at a comma in the name of an existing file)")
      ->type_name("NAME|FILE,...");
}

void declare_listing_format(CLI::App& app, ListingFormat& target) {
  add_choice<ListingFormat>(
      app, "--format", target,
      {{"table", ListingFormat::table}, {"csv", ListingFormat::csv}, {"json", ListingFormat::json}},
      "What to print: table, csv or json (default: table)");
}

void declare_execution(CLI::App& app, ExecutionOptions& options) {
  app.add_option("--threads", options.threads,
                 "Threads, and compute units of an OpenCL device that is a processor (default: one for every "
                 "processor)")
      ->check(whole_number(1, most_threads))
      ->type_name("N");
  app.add_option("--device", options.device,
                 "OpenCL device: its number or a part of its name (see mssim list devices)")
      ->type_name("N|NAME");
  add_choice<DeviceMemory>(
      app, "--memory", options.memory, device_memories,
      "How host and OpenCL device exchange data: shared, without copying where the device can, or copy "
      "(default: shared)");
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
