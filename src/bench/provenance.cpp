#include "bench/provenance.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/noise.h"
#include "model/fnv1a.h"

namespace mssim {
namespace {

using nlohmann::json;

std::vector<int> allowed_cpus() {
  std::vector<int> cpus;
  cpu_set_t mask;
  CPU_ZERO(&mask);
  if (sched_getaffinity(0, sizeof mask, &mask) != 0) return cpus;
  for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(cpu, &mask)) cpus.push_back(static_cast<int>(cpu));
  return cpus;
}

std::vector<std::pair<std::string, std::string>> thread_environment() {
  std::vector<std::pair<std::string, std::string>> variables;
  for (char** entry = environ; entry && *entry; ++entry) {
    const std::string_view text = *entry;
    const std::size_t equals = text.find('=');
    if (equals != std::string_view::npos && (text.starts_with("OMP_") || text.starts_with("GOMP_")))
      variables.emplace_back(text.substr(0, equals), text.substr(equals + 1));
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

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, sizeof "2026-01-31T12:00:00Z"> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

json caches_json(const std::vector<Cache>& caches) {
  json list = json::array();
  for (const Cache& cache : caches)
    list.push_back({{"level", cache.level},
                    {"type", cache.type},
                    {"bytes", cache.bytes},
                    {"count", cache.count},
                    {"logical_cpus_sharing", cache.sharing}});
  return list;
}

}  // namespace

Provenance gather_provenance(const std::vector<std::string>& arguments, int threads) {
  Provenance provenance;
  provenance.build = build_info();
  provenance.machine = read_machine();
  provenance.threads = threads;
  provenance.allowed_cpus = allowed_cpus();
  provenance.thread_environment = thread_environment();
  for (const std::string& argument : arguments)
    provenance.command_line.push_back(provenance.command_line.empty()
                                          ? std::filesystem::path(argument).filename().string()
                                          : without_home(argument));
  provenance.noise = noise_of(provenance);
  provenance.started_utc = now_utc();
  return provenance;
}

void add_scene(Provenance& provenance, std::string_view name, std::string_view file_text) {
  provenance.scenes.push_back({std::string(name), fnv1a_64(file_text)});
}

json to_json(const Provenance& provenance) {
  const BuildInfo& build = provenance.build;
  const Machine& machine = provenance.machine;
  json environment = json::object(), scenes = json::object();
  for (const auto& [name, value] : provenance.thread_environment) environment[name] = value;
  for (const SceneHash& scene : provenance.scenes) scenes[scene.name] = hexadecimal(scene.fnv1a_64);
  return {{"started_utc", provenance.started_utc},
          {"command_line", provenance.command_line},
          {"build",
           {{"version", build.version},
            {"commit", build.commit},
            {"dirty", build.dirty},
            {"compiler", build.compiler},
            {"flags", build.flags},
            {"build_type", build.build_type}}},
          {"cpu",
           {{"model", machine.cpu_model},
            {"logical_cpus", machine.logical_cpus},
            {"mhz", machine.cpu_mhz},
            {"governor", machine.governor ? json(*machine.governor) : json()},
            {"turbo", machine.turbo ? json(*machine.turbo) : json()},
            {"caches", caches_json(machine.caches)}}},
          {"memory_bytes", machine.memory_bytes},
          {"load_average", machine.load_average},
          {"operating_system", machine.operating_system},
          {"kernel", machine.kernel},
          {"threads",
           {{"asked_for", provenance.threads},
            {"allowed_cpus", provenance.allowed_cpus},
            {"environment", environment}}},
          {"opencl_devices", provenance.opencl_devices},
          {"tetgen", provenance.tetgen.empty() ? json() : json(provenance.tetgen)},
          {"noise", provenance.noise},
          {"scenes_fnv1a_64", scenes}};
}

}  // namespace mssim
