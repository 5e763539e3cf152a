#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "integrators/integrator.h"

namespace mssim {

/// The backend of that name. Throws UsageError naming the nearest or listing the known.
const BackendInfo& require_backend(const std::string& name);

/// The same among `known` ones.
const BackendInfo& require_backend(const std::string& name, const std::vector<const BackendInfo*>& known);

/// The integrator of that name. Throws like require_backend.
const Integrator& require_integrator(const std::string& name);

/// Accepts finite numbers above zero, and says so in words.
CLI::Validator positive_number();

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
      ->transform(CLI::IsMember(words, CLI::ignore_case));
}

/// Declares --threads, --device and --memory. `options` must outlive the parsing.
void declare_execution(CLI::App& app, ExecutionOptions& options);

/// The word for it that --memory takes.
std::string name_of(DeviceMemory memory);

/// `threads` as given or, for 0, one for every processor that this process may use; OpenMP then gives as
/// many, whatever OMP_DYNAMIC says. Throws UsageError where OMP_THREAD_LIMIT is lower.
ExecutionOptions complete(ExecutionOptions options);

}  // namespace mssim
