#include "commands/bench/planned_scenes.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <variant>

#include "bench/bench_memory.h"
#include "output/tables/listing.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"

namespace mssim {

SceneSize size_of(const SceneSpec& spec, const SceneCounts& counts) {
  return {counts.nodes, counts.springs_unique, std::holds_alternative<ClothSpec>(spec.body),
          std::holds_alternative<GarmentSpec>(spec.body)};
}

std::vector<PlannedScene> planned_scenes(const BenchPlan& plan) {
  std::vector<PlannedScene> scenes;
  for (const std::string& name : plan.timed) {
    const SceneSpec spec = find_scene(name);
    const SceneCounts counts = counts_of(spec);
    const SceneSize size = size_of(spec, counts);
    require_memory(spec, counts, bench_memory_needed(plan.job, size),
                   "name fewer with --backend or --integrator, or make the scene smaller");
    scenes.push_back({spec.name, size, expected_time(plan.job, size)});
  }
  return scenes;
}

std::vector<ExpectedTime> times_of(const std::vector<PlannedScene>& scenes) {
  std::vector<ExpectedTime> times;
  for (const PlannedScene& scene : scenes) times.push_back(scene.time);
  return times;
}

void tell_plan(const BenchPlan& plan, const std::vector<PlannedScene>& scenes,
               std::optional<double> time_budget_s) {
  const ExpectedTime all = total(times_of(scenes));
  double rounds = plan.job.rounds;
  if (time_budget_s) rounds = std::min(rounds, rounds_within(*time_budget_s, all));
  const auto seconds = [&](const ExpectedTime& time) {
    return std::lround(std::ceil(time.preparation + rounds * time.round));
  };
  Listing listing;
  for (const PlannedScene& scene : scenes)
    listing.push_back({{"scene", scene.name},
                       {"nodes", scene.size.nodes},
                       {"springs_unique", scene.size.springs},
                       {"combinations", combinations(plan.job)},
                       {"rounds", std::lround(rounds)},
                       {"expected_s", seconds(scene.time)}});
  for (const std::string& name : plan.described)
    std::cout << name << ": nothing is timed, its structure is told\n";
  if (!listing.empty()) std::cout << to_text(listing, ListingFormat::table);
  std::cout << "about " << seconds(all) << " s in all\n";
}

}  // namespace mssim
