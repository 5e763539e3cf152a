#pragma once

#include <sched.h>

#include <future>
#include <vector>

namespace mssim {

/// Numbers of the logical CPUs that the process may use, in ascending order; empty where the system does not
/// tell. Not the calling thread's affinity mask, unless OpenMP binds no threads: with OMP_PROC_BIND or
/// OMP_PLACES it binds the first one to a CPU of its own before main begins.
std::vector<int> process_cpus();

/// While it lives, the calling thread may move to all of process_cpus(), and the threads and processes that
/// it starts inherit that: they would otherwise share the one CPU that OpenMP has bound this thread to.
class OnAllProcessCpus {
 public:
  OnAllProcessCpus();
  ~OnAllProcessCpus();
  OnAllProcessCpus(const OnAllProcessCpus&) = delete;
  OnAllProcessCpus& operator=(const OnAllProcessCpus&) = delete;

 private:
  cpu_set_t before_{};
  bool changed_ = false;
};

/// How std::async starts what should run beside the caller: in a thread, or where the system makes none, in
/// that which waits for it.
inline constexpr std::launch as_the_system_can = std::launch::async | std::launch::deferred;

}  // namespace mssim
