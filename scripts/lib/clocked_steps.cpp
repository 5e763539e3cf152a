// Cycles that openmp takes for sixteen nodes and for sixteen springs, for scripts/port-bound:
//   clocked_steps SCENE...
// with one thread and semi-euler. Steps alternate with a chain of operations of known length, because the
// clock frequency changes from one millisecond to the next, and drops while the widest vector units are busy.
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <span>
#include <vector>

#include "application/prepared_scene.h"
#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "scene/scene_file.h"
#include "statistics/statistics.h"

namespace {

using namespace mssim;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A chain of operations, each of which depends on the previous one.
struct Chain {
  std::size_t cycles;  ///< of the whole chain
  void (*run)();
};
constexpr std::size_t turns_of_chain = 12'000, operations = 16;  // about 60 microseconds

/// An addition takes one cycle. It uses two registers, because Intel's newer processors add constants before
/// the units, several per cycle.
void add() {
  unsigned long sum = 1;
  const unsigned long summand = 3;
  for (std::size_t i = 0; i < turns_of_chain; ++i)
#if defined(__x86_64__)
    asm volatile(".rept 16\n add %1, %0\n .endr" : "+r"(sum) : "r"(summand));
#elif defined(__aarch64__)
    asm volatile(".rept 16\n add %0, %0, %1\n .endr" : "+r"(sum) : "r"(summand));
#else
#error "a chain of additions of this processor"
#endif
}

#if defined(__x86_64__)
constexpr std::size_t multiply_add_cycles = 4;
/// Multiply-adds of 512 bits take four cycles on every processor that has them (Intel since Skylake, AMD
/// since Zen 4). The registers are set to zero, because they may have denormal numbers, with which some
/// processors take many more cycles.
void multiply_add() {
  asm volatile(
      "vpxord %zmm16, %zmm16, %zmm16\n vpxord %zmm17, %zmm17, %zmm17\n vpxord %zmm18, %zmm18, %zmm18");
  for (std::size_t i = 0; i < turns_of_chain / multiply_add_cycles; ++i)
    asm volatile(".rept 16\n vfmadd231ps %zmm16, %zmm17, %zmm18\n .endr");
}
#endif

Chain chain_of_this_processor() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return {turns_of_chain * operations, multiply_add};
#endif
  return {turns_of_chain * operations, add};
}

void measure(const char* file, const Chain& chain) {
  constexpr std::size_t turns = 600;
  constexpr double turn_s = 1e-3;
  const PreparedScene scene = prepare_scene(load_scene(file));
  ExecutionOptions one_thread;
  one_thread.threads = 1;
  const auto backend = make_backend(*find_backend("openmp"), scene.system, *find_integrator("semi-euler"),
                                    scene.dt_s, one_thread);
  backend->set_state(scene.system.start);
  int steps = 1;
  while (seconds_of([&] { backend->step(steps); }) < turn_s) steps *= 2;

  std::vector<double> step_s, cycle_s, cycles;
  for (std::size_t turn = 0; turn < turns; ++turn) {
    const double before_s = seconds_of(chain.run);
    step_s.push_back(seconds_of([&] { backend->step(steps); }) / steps);
    cycle_s.push_back((before_s + seconds_of(chain.run)) / 2 / static_cast<double>(chain.cycles));
    cycles.push_back(step_s.back() / cycle_s.back());
  }
  const double nodes = static_cast<double>(scene.system.nodes()) / 16;
  const double springs = static_cast<double>(scene.system.springs.size()) / 16;
  std::printf(
      "%s: %.4g ms per step with one thread at %.2f GHz, %.1f cycles for sixteen nodes "
      "(half of the turns: %.1f to %.1f), %.1f for sixteen springs\n",
      scene.spec.name.c_str(), median(step_s) * 1e3, 1e-9 / median(cycle_s), median(cycles) / nodes,
      quantile(cycles, 0.25) / nodes, quantile(cycles, 0.75) / nodes, median(cycles) / springs);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Chain chain = chain_of_this_processor();
    for (const char* file : std::span(argv, static_cast<std::size_t>(argc)).subspan(1)) measure(file, chain);
  } catch (const std::exception& error) {
    std::cerr << "clocked_steps: " << error.what() << '\n';
    return 1;
  }
}
