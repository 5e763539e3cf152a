#include "backends/described/backend_description.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "integrators/all_integrators.h"
#include "platform/files.h"
#include "scene/fields/fields.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_words = 64;
/// Longest word of a command and value of a variable, in characters: a path, or a list of them.
constexpr std::size_t longest_word = 4096;
constexpr std::string_view cloth = "cloth", bodies = "bodies";
constexpr std::array<std::string_view, 2> scene_words{cloth, bodies};
constexpr std::string_view ranks = "ranks";
constexpr std::array<std::string_view, 2> process_words{"one", ranks};
constexpr std::string_view windows = "windows";
constexpr std::array<std::string_view, 2> state_words{"whole", windows};
constexpr std::string_view remedy = "give the description of a backend, NAME.json";

/// The fields of a description.
struct Description {
  std::vector<std::string> command, scenes, integrators;
  std::string text;
  std::vector<std::pair<std::string, std::string>> environment;
  std::optional<double> time_limit_s;
  std::string install;
  std::uint32_t processes = 0;  ///< index into process_words
  std::uint32_t states = 0;     ///< index into state_words
};

void visit(FieldVisitor& fields, Description& description) {
  std::string schema;  // for editors; not part of the description
  fields.text({"$schema", "Path of this schema, for editors; mssim ignores it."}, Presence::optional, schema);
  fields.texts(
      {"command", "The program, in PATH or with a slash relative to this file's folder, and its arguments."},
      most_words, longest_word, description.command);
  fields.text({"description", "One line for mssim list backends."}, Presence::optional, description.text);
  fields.choices({"scenes", "Kinds of scenes that it steps (default: both)."}, scene_words,
                 description.scenes);
  fields.choices({"integrators", "Supported integrators (default: all explicit ones)."},
                 mapped<std::string_view>(all_integrators, &Integrator::name), description.integrators);
  fields.named_texts({"environment", "Environment variables in addition to mssim's."}, most_words,
                     longest_word, description.environment);
  fields.optional_number({"time_limit_s", "Time limit of an answer, s (default: 120)."},
                         description.time_limit_s, above(0, longest_time_limit_s));
  fields.text({"install", "What to do if the program is missing."}, Presence::optional, description.install);
  fields.choice({"processes",
                 "ranks: it runs in MSSIM_RANKS processes and builds cloths from the file MSSIM_SCENE_FILE "
                 "(default: one)."},
                Presence::optional, process_words, description.processes);
  fields.choice({"states",
                 "windows: it can also restart a cloth by itself and return the states of some rows and "
                 "columns; with ranks only (default: whole)."},
                Presence::optional, state_words, description.states);
}

/// Sets the file to run, or why it is missing.
void find_file(BackendProgram& program, const fs::path& file) {
  const std::string& word = program.command.front();
  if (word.find('/') == std::string::npos) {
    if (const auto found = find_program(word))
      program.program = *found;
    else
      program.missing = fmt::format("there is no program {} in PATH", printable(word));
    return;
  }
  std::error_code error;
  program.program = program.folder / word;
  if (!fs::is_regular_file(program.program, error))
    program.missing = fmt::format("there is no file {} next to {}", printable(word), escaped(file.string()));
  else if (::access(program.program.c_str(), X_OK) != 0)
    program.missing = escaped(program.program.string()) + " is not executable; chmod +x it";
}

}  // namespace

BackendProgram parse_description(const fs::path& file, const std::string& text) {
  if (text.empty()) throw SceneError("{} is empty: {}", escaped(file.string()), remedy);
  Description description;
  read_fields(file, text, [&](FieldVisitor& fields) { visit(fields, description); });
  if (description.command.front().empty())
    refuse(file, "/command/0", "is empty: give the name of a program, or a path with a slash");
  BackendProgram program;
  program.name = file.stem().string();
  program.description = description.text;
  program.command = std::move(description.command);
  program.folder = fs::absolute(file).parent_path();
  if (!description.scenes.empty()) {
    const auto steps = [&](std::string_view word) {
      return std::ranges::find(description.scenes, word) != description.scenes.end();
    };
    program.steps_cloths = steps(cloth);
    program.steps_bodies = steps(bodies);
  }
  program.integrators = std::move(description.integrators);
  for (const auto& [name, value] : description.environment) {
    if (name.empty() || name.find('=') != std::string::npos || escaped(name) != name)
      refuse(file, "/environment", "has the name \"" + printable(name) + "\": give a variable's name");
    program.environment.push_back(name + '=' + value);
  }
  if (description.time_limit_s) program.time_limit_s = *description.time_limit_s;
  program.in_ranks = process_words.at(description.processes) == ranks;
  program.has_windows = state_words.at(description.states) == windows;
  if (program.has_windows && !program.in_ranks)
    refuse(file, "/states",
           "is \"windows\", which needs \"processes\": \"ranks\": add that, or leave it out");
  find_file(program, file);
  if (!program.missing.empty() && !description.install.empty())
    program.missing += "; " + printable(description.install, 300);
  return program;
}

std::string description_schema() {
  Description description;
  return json_schema("Backend of mssim", "Describes a program that is a backend, whose name is the file's.",
                     [&](FieldVisitor& fields) { visit(fields, description); });
}

BackendProgram read_description(const fs::path& file) {
  return parse_description(file, read_file_or<SceneError>(file, remedy, largest_description_bytes));
}

}  // namespace mssim
