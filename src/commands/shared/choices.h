#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "backends/backends.h"
#include "integrators/integrator.h"
#include "output/tables/listing.h"

namespace mssim {

/// The backend of that name. Throws UsageError naming the nearest or listing the known.
const BackendInfo& require_backend(const std::string& name);

/// The same among `known` ones.
const BackendInfo& require_backend(const std::string& name, const std::vector<const BackendInfo*>& known);

/// The integrator of that name. Throws like require_backend.
const Integrator& require_integrator(const std::string& name);

/// What an option's value must be. Each says in words what the value is not; the sentence around it, with the
/// option's name, is usage_error.h's. (CLI11's own checks put types and capitals into the sentence.)

/// Finite and above zero.
CLI::Validator positive_number();
/// From `low` to `high`.
CLI::Validator number_between(double low, double high);
CLI::Validator whole_number(std::int64_t low, std::int64_t high);
/// One of these words, in any case; an option that is transformed by it gets the word as it stands here.
/// `what` is what they name.
CLI::Validator one_of(std::string what, std::vector<std::string> words);

/// More host threads than this are a typing error, and would only fail later and less clearly.
inline constexpr int most_threads = 4096;

/// Declares an option that takes one of these words, in any case, and sets `target` to what the word stands
/// for. Both must outlive the parsing.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& target,
                        const std::map<std::string, Value>& choices, const std::string& description) {
  std::vector<std::string> words;
  for (const auto& [word, value] : choices) words.push_back(word);
  return app
      .add_option_function<std::string>(
          name, [&target, choices](const std::string& word) { target = choices.at(word); }, description)
      ->transform(one_of("value", std::move(words)))
      ->type_name("WORD");
}

/// Declares an option, or an argument, that takes scenes apart as scenes_in does. `target` must outlive the
/// parsing.
CLI::Option* add_scenes(CLI::App& app, const std::string& name, std::vector<std::string>& target,
                        const std::string& description);

/// Declares --format of a listing. `target` must outlive the parsing.
void declare_listing_format(CLI::App& app, ListingFormat& target);

/// Declares --threads, --device and --memory. `options` must outlive the parsing.
void declare_execution(CLI::App& app, ExecutionOptions& options);

/// The word for it that --memory takes.
std::string name_of(DeviceMemory memory);

/// `threads` as given or, for 0, one for every processor that this process may use; OpenMP then gives as
/// many, whatever OMP_DYNAMIC says. Throws UsageError where OMP_THREAD_LIMIT is lower.
ExecutionOptions complete(ExecutionOptions options);

}  // namespace mssim
