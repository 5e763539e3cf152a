#include "bench/results/comparability.h"

#include <algorithm>

#include "text/text.h"

namespace mssim {
namespace {

/// Adds "WHAT was BEFORE and is NOW" where they differ, each sentence once.
void add(std::vector<std::string>& sentences, const std::string& what, const std::string& before,
         const std::string& now) {
  if (before == now) return;
  std::string sentence = what + " was " + before + " and is " + now;
  if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(std::move(sentence));
}

/// `with_generation`: an mssim that did not know generations wrote results that can be compared all the same.
std::string cpu_of(const Machine& machine, bool with_generation) {
  return (with_generation ? cpu_name(machine) : machine.cpu_model) + " with " +
         std::to_string(machine.logical_cpus) + " logical CPUs";
}

std::string size_of(const ResultRow& row) {
  return "one of " + std::to_string(row.nodes) + " nodes and " + std::to_string(row.springs_unique) +
         " springs";
}

}  // namespace

std::vector<std::string> differences(const Provenance& before, const Provenance& now) {
  std::vector<std::string> sentences;
  const bool generations = !before.machine.cpu_generation.empty() && !now.machine.cpu_generation.empty();
  add(sentences, "the CPU", cpu_of(before.machine, generations), cpu_of(now.machine, generations));
  add(sentences, "the compiler", before.build.compiler, now.build.compiler);
  add(sentences, "the build type", before.build.build_type, now.build.build_type);
  add(sentences, "the compiler flags", '"' + before.build.flags + '"', '"' + now.build.flags + '"');
  add(sentences, "the number of threads", std::to_string(before.threads), std::to_string(now.threads));
  for (const SceneHash& scene : before.scenes)
    if (const auto same = std::ranges::find(now.scenes, scene.name, &SceneHash::name);
        same != now.scenes.end())
      add(sentences, "the hash of scene " + scene.name, to_hex(scene.fnv1a_64), to_hex(same->fnv1a_64));
  return sentences;
}

std::vector<std::string> differences(std::span<const ResultRow> before, std::span<const ResultRow> now) {
  std::vector<std::string> sentences;
  for (const ResultRow& row : before) {
    const auto same = std::ranges::find_if(
        now, [&](const ResultRow& candidate) { return same_combination(candidate, row); });
    if (same == now.end() || !row.ms_per_step || !same->ms_per_step) continue;
    add(sentences, "the device of " + row.backend, row.device, same->device);
    add(sentences, "scene " + row.scene, size_of(row), size_of(*same));
  }
  return sentences;
}

}  // namespace mssim
