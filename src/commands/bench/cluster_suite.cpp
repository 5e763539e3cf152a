#include "commands/bench/cluster_suite.h"

#include <algorithm>

#include "output/tables/cluster_rows.h"
#include "platform/machine.h"

namespace mssim {
namespace {

/// 1, 2, 4, ... and the largest.
std::vector<int> rank_counts(const ExecutionOptions& execution) {
  constexpr int fewest = 4;
  const auto processors = static_cast<int>(process_cpus().size());
  const int threads = execution.threads_given ? execution.threads : 1;
  const int most = execution.ranks > 0 ? execution.ranks : std::max(fewest, processors / threads);
  std::vector<int> counts;
  for (int ranks = 1; ranks < most; ranks *= 2) counts.push_back(ranks);
  counts.push_back(most);
  return counts;
}

}  // namespace

std::vector<std::string> cluster_programs(const ExecutionOptions& execution) {
  std::vector<std::string> names;
  for (const int ranks : rank_counts(execution)) names.push_back(name_in_ranks(ranks_backend, ranks));
  for (const int ranks : rank_counts(execution))
    if (ranks > 1) names.push_back(name_in_ranks(copies_backend, ranks));
  return names;
}

bool is_in_cluster(std::string_view scene, std::string_view backend) {
  const WideScene wide = wide_scene(scene);
  return wide.times == 1 || backend == name_in_ranks(ranks_backend, wide.times);
}

}  // namespace mssim
