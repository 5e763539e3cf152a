#include "bench/machine/provenance.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <sstream>

#include "platform/files.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {

namespace {

std::vector<std::pair<std::string, std::string>> thread_environment() {
  std::vector<std::pair<std::string, std::string>> variables;
  for (char** entry = environ; entry && *entry; ++entry) {
    const std::string_view text = *entry;
    const std::size_t equals = text.find('=');
    if (equals != std::string_view::npos && (text.starts_with("OMP_") || text.starts_with("GOMP_")))
      variables.emplace_back(escaped(text.substr(0, equals)), escaped(text.substr(equals + 1)));
  }
  std::sort(variables.begin(), variables.end());
  return variables;
}

/// The home folder's name is the user's name more often than not.
std::string without_home(std::string_view argument) {
  const char* home = std::getenv("HOME");
  const std::string_view folder = home ? home : "";
  if (folder.size() < 2) return std::string(argument);
  std::string result;
  for (std::size_t at = 0; at < argument.size();) {
    const std::string_view rest = argument.substr(at);
    if (rest.starts_with(folder) && (rest.size() == folder.size() || rest[folder.size()] == '/')) {
      result += '~';
      at += folder.size();
    } else {
      result += argument[at++];
    }
  }
  return result;
}

/// Hash of the running program's file; none where it cannot be read.
std::optional<std::uint64_t> program_hash() {
  try {
    return fnv1a_64(read_file("/proc/self/exe"));
  } catch (const ReadError&) {
    return std::nullopt;
  }
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, sizeof "2026-01-31T12:00:00Z"> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

}  // namespace

Provenance gather_provenance(const std::vector<std::string>& arguments, int threads) {
  Provenance provenance;
  provenance.build = build_info();
  provenance.program_fnv1a_64 = program_hash();
  provenance.machine = read_machine();
  provenance.threads = threads;
  provenance.allowed_cpus = process_cpus();
  provenance.thread_environment = thread_environment();
  for (const std::string& argument : arguments)
    provenance.command_line.push_back(provenance.command_line.empty()
                                          ? escaped(std::filesystem::path(argument).filename().string())
                                          : escaped(without_home(argument)));
  provenance.noise = noise_of(provenance);
  provenance.started_utc = now_utc();
  return provenance;
}

void add_program(Provenance& provenance, BackendProgramRecord record, const std::filesystem::path& program,
                 const std::filesystem::path& folder) {
  // Larger ones are data, and reading them would take longer than a step.
  constexpr std::size_t largest_file = std::size_t{64} << 20;
  for (std::string& word : record.command) {
    const bool is_program = &word == &record.command.front();
    const std::filesystem::path file = is_program ? program : folder / word;
    const std::string& shown = word = escaped(without_home(word));
    try {
      record.files.push_back({shown, fnv1a_64(read_file(file, largest_file))});
    } catch (const ReadError&) {
      continue;  // an argument that is no file
    }
  }
  const auto same_name = [](const FileHash& a, const FileHash& b) { return a.name == b.name; };
  std::ranges::sort(record.files, {}, &FileHash::name);
  record.files.erase(std::unique(record.files.begin(), record.files.end(), same_name), record.files.end());
  provenance.backend_programs.push_back(std::move(record));
  std::ranges::sort(provenance.backend_programs, {}, &BackendProgramRecord::name);
}

void add_scene(Provenance& provenance, std::string_view name, std::string_view file_text) {
  provenance.scenes.push_back({std::string(name), fnv1a_64(file_text)});
}

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
