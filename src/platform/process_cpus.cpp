#include "platform/process_cpus.h"

#include <omp.h>

#include <algorithm>

namespace mssim {

std::vector<int> process_cpus() {
  std::vector<int> cpus;
  const bool bound = omp_get_proc_bind() != omp_proc_bind_false;
  for (int place = 0; bound && place < omp_get_num_places(); ++place) {
    std::vector<int> ids(static_cast<std::size_t>(omp_get_place_num_procs(place)));
    omp_get_place_proc_ids(place, ids.data());
    cpus.insert(cpus.end(), ids.begin(), ids.end());
  }
  if (cpus.empty()) {
    cpu_set_t mask;
    CPU_ZERO(&mask);
    if (sched_getaffinity(0, sizeof mask, &mask) != 0) return cpus;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
      if (CPU_ISSET(static_cast<std::size_t>(cpu), &mask)) cpus.push_back(cpu);
  }
  std::sort(cpus.begin(), cpus.end());
  cpus.erase(std::unique(cpus.begin(), cpus.end()), cpus.end());
  return cpus;
}

OnAllProcessCpus::OnAllProcessCpus() {
  cpu_set_t all;
  CPU_ZERO(&all);
  for (const int cpu : process_cpus()) CPU_SET(static_cast<std::size_t>(cpu), &all);
  changed_ = sched_getaffinity(0, sizeof before_, &before_) == 0 && !CPU_EQUAL(&all, &before_) &&
             sched_setaffinity(0, sizeof all, &all) == 0;
}

OnAllProcessCpus::~OnAllProcessCpus() {
  if (changed_) sched_setaffinity(0, sizeof before_, &before_);
}

}  // namespace mssim
