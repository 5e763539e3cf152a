#include "commands/dry_run.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>

#include "commands/time_budget.h"
#include "output/listing.h"
#include "scene/scene_file.h"

namespace mssim {

std::vector<ExpectedTime> expected_times(const SceneJob& job, const std::vector<std::string>& scenes) {
  std::vector<ExpectedTime> times;
  for (const std::string& name : scenes) times.push_back(expected_time(job, size_of(find_scene(name))));
  return times;
}

void tell_plan(const BenchPlan& plan, std::optional<double> time_budget_s) {
  const std::vector<ExpectedTime> times = expected_times(plan.job, plan.timed);
  TimeBudget(time_budget_s, times);
  const auto total = [&](double rounds) {
    return std::accumulate(times.begin(), times.end(), 0.0, [&](double sum, const ExpectedTime& time) {
      return sum + time.preparation + rounds * time.round;
    });
  };
  double rounds = plan.job.rounds;
  if (time_budget_s) rounds = std::clamp((*time_budget_s - total(0)) / (total(1) - total(0)), 1.0, rounds);
  Listing listing;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const SceneSpec spec = find_scene(plan.timed[i]);
    const SceneSize size = size_of(spec);
    listing.push_back(
        {{"scene", spec.name},
         {"nodes", size.nodes},
         {"springs_unique", size.springs},
         {"combinations", combinations(plan.job)},
         {"rounds", std::lround(rounds)},
         {"expected_s", std::lround(std::ceil(times[i].preparation + rounds * times[i].round))}});
  }
  for (const std::string& name : plan.described)
    std::cout << name << ": nothing is timed, its structure is told\n";
  if (!listing.empty()) std::cout << to_text(listing, ListingFormat::table);
  std::cout << "about " << std::lround(std::ceil(total(rounds))) << " s in all\n";
}

}  // namespace mssim
