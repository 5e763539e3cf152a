// Times steps of cloths on openmp with 1, 2, 4, ... steps per pass, with and without processes that take
// memory bandwidth, for scripts/steps-a-pass:
//   steps_a_pass THREADS THIEVES SCENE...
// A thief is a process that streams through an array. The variants are timed in turn. Each time is printed
// with the one that the model of steps_per_pass_for (src/backends/layouts/band_grid.cpp) predicts.
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "application/prepared_scene.h"
#include "backends/layouts/band_grid.h"
#include "backends/vectors/step_kernels.h"
#include "integrators/all_integrators.h"
#include "scene/scene_file.h"
#include "statistics/statistics.h"

namespace {

using namespace mssim;

/// Processes that take memory bandwidth between SIGCONT and SIGSTOP; they end with this one.
class Thieves {
 public:
  explicit Thieves(int count) {
    for (int i = 0; i < count; ++i) {
      const pid_t child = fork();
      if (child == 0) steal(i);
      // kill() would take -1 for every process.
      if (child < 0) {
        send(SIGKILL);
        throw std::system_error(errno, std::generic_category(), "a process cannot be made");
      }
      children_.push_back(child);
    }
  }
  ~Thieves() { send(SIGKILL); }
  bool none() const { return children_.empty(); }
  void send(int signal) const {
    for (const pid_t child : children_) kill(child, signal);
  }

 private:
  /// Uses the last processors; on a processor that steps, it would take time instead of bandwidth.
  [[noreturn]] static void steal(int before) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    cpu_set_t own;
    CPU_ZERO(&own);
    CPU_SET(static_cast<std::size_t>(sysconf(_SC_NPROCESSORS_ONLN) - 1 - before), &own);
    sched_setaffinity(0, sizeof own, &own);
    raise(SIGSTOP);
    std::vector<double> array(std::size_t{64} << 20);  // 512 MiB: larger than a last-level cache
    for (;;) {
      for (double& number : array) number += 1;
      asm volatile("" ::"r"(array.data()) : "memory");  // keep the loop
    }
  }
  std::vector<pid_t> children_;
};

struct Way {
  std::size_t steps_a_pass;
  std::unique_ptr<BandGrid> bands;
  std::vector<double> alone{}, beside{};  ///< ns per node and step
};

void measure(const char* file, std::size_t threads, const Thieves& thieves) {
  constexpr int rounds = 15;
  constexpr double sample_s = 0.05;
  const PreparedScene scene = prepare_scene(load_scene(file));
  const Integrator& euler = *find_integrator("semi-euler");
  const StepKernel<BandGrid> kernel = best_kernel(step_kernels<BandGrid>(euler), Roots::fast);
  std::vector<Way> ways;
  for (std::size_t steps = 1; steps <= stages_under_way; steps *= 2) {
    ways.push_back({steps, std::make_unique<BandGrid>(
                               scene.system, std::get<GridPatch>(scene.system.topology), euler, scene.dt_s,
                               kernel.lanes, threads, BandCut{.steps_per_pass = steps})});
    ways.back().bands->set_state(scene.system.start);
  }
  const auto ns = [&](Way& way) {
    const auto start = std::chrono::steady_clock::now();
    double seconds = 0;
    int steps = 0;
    for (; seconds < sample_s; steps += static_cast<int>(stages_under_way)) {
      kernel.step(*way.bands, static_cast<int>(stages_under_way));
      seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    return 1e9 * seconds / steps / static_cast<double>(scene.system.nodes());
  };
  for (int round = 0; round < rounds; ++round) {
    for (Way& way : ways) way.alone.push_back(ns(way));
    if (thieves.none()) continue;
    thieves.send(SIGCONT);
    for (Way& way : ways) way.beside.push_back(ns(way));
    thieves.send(SIGSTOP);
  }
  for (const bool beside : {false, true}) {
    if (beside && thieves.none()) break;
    const auto time = [&](const Way& way) { return median(beside ? way.beside : way.alone); };
    const double memory = 2 * (time(ways.at(0)) - time(ways.at(1))), rest = time(ways.at(0)) - memory;
    std::printf("%s, %s: ", scene.spec.name.c_str(), beside ? "with thieves" : "alone");
    for (const Way& way : ways)
      std::printf("%zu per pass %.2f ns (model %.2f)  ", way.steps_a_pass, time(way),
                  rest + memory / static_cast<double>(way.steps_a_pass));
    std::printf("memory %.2f ns, the rest %.2f ns\n", memory, rest);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::span<char*> words(argv, static_cast<std::size_t>(argc));
    const Thieves thieves(std::stoi(words[2]));  // before any thread
    for (const char* file : words.subspan(3)) measure(file, std::stoul(words[1]), thieves);
  } catch (const std::exception& error) {
    std::cerr << "steps_a_pass: " << error.what() << '\n';
    return 1;
  }
}
