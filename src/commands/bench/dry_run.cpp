#include "commands/bench/dry_run.h"

#include <cmath>
#include <iostream>

#include "output/tables/table.h"

namespace mssim {

void tell_plan(const BenchPlan& plan) {
  const ExpectedTime all = total(times_of(plan.timed));
  const double rounds = expected_rounds(plan);
  const auto seconds = [&](const ExpectedTime& time) { return std::lround(std::ceil(time.with(rounds))); };
  Table table;
  for (const PlannedScene& scene : plan.timed)
    table.add({{"scene", scene.spec.name},
               {"nodes", scene.size.nodes},
               {"springs_unique", scene.size.springs},
               {"combinations", scene.backends.size() * plan.settings.integrators.size()},
               {"rounds", std::lround(rounds)},
               {"expected_s", seconds(scene.time)}});
  for (const UnbuiltScene& scene : plan.described)
    std::cout << scene.spec.name << ": not timed; its structure is shown\n";
  std::cout << to_text(table);
  std::cout << "about " << seconds(all) << " s in all\n";
}

}  // namespace mssim
