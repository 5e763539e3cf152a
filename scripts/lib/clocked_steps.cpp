// Cycles that openmp takes for sixteen nodes and for sixteen springs, for scripts/port-bound:
//   clocked_steps SCENE...
// with one thread and semi-euler. Steps alternate with a chain of operations of known length, because the
// clock frequency changes from one millisecond to the next, and drops while the widest vector units are busy.
// They also alternate with instructions that wait for nothing: a core's other thread, which may be another
// virtual machine's, takes up to half of a core's instructions and leaves the chain as it is. Only turns in
// which the core was free before and after count.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
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
constexpr std::size_t turns_of_chain = 4'000, operations = 16;  // about 20 microseconds

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

/// Instructions that do nothing and wait for nothing: a core takes as many per cycle as it can issue.
void issue() {
  for (std::size_t i = 0; i < turns_of_chain; ++i) asm volatile(".rept 16\n nop\n .endr");
}

Chain chain_of_this_processor() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return {turns_of_chain * operations, multiply_add};
#endif
  return {turns_of_chain * operations, add};
}

/// Steps between two measurements of the clock and of the core.
struct Turn {
  double cycle_s, step_s;
  double issued;  ///< instructions per cycle, the smaller of both measurements
  double cycles() const { return step_s / cycle_s; }
};

/// The turns of a scene.
struct Measurement {
  std::string scene;
  std::size_t nodes, springs;
  std::vector<Turn> turns;  ///< in which the clock was steady
};

Measurement measure(const char* file, const Chain& chain) {
  constexpr std::size_t turns = 3'000;
  constexpr double turn_s = 2e-4, awake_s = 0.2, steady = 0.02;
  const PreparedScene scene = prepare_scene(load_scene(file));
  ExecutionOptions one_thread;
  one_thread.threads = 1;
  const auto backend = make_backend(*find_backend("openmp"), scene.system, *find_integrator("semi-euler"),
                                    scene.dt_s, one_thread);
  backend->set_state(scene.system.start);
  int steps = 1;
  while (seconds_of([&] { backend->step(steps); }) < turn_s) steps *= 2;

  const auto time = [&](void (*run)()) { return seconds_of(run) / static_cast<double>(chain.cycles); };
  for (double s = 0; s < awake_s;) s += seconds_of(chain.run);  // an idle core's clock is slow at first
  Measurement measured{scene.spec.name, scene.system.nodes(), scene.system.springs.size(), {}};
  for (std::size_t turn = 0; turn < turns; ++turn) {
    const double clock_before = time(chain.run), issue_before = time(issue);
    const double step_s = seconds_of([&] { backend->step(steps); }) / steps;
    const double issue_after = time(issue), clock_after = time(chain.run);
    const double cycle_s = (clock_before + clock_after) / 2;
    if (std::abs(clock_after - clock_before) > steady * cycle_s) continue;
    measured.turns.push_back({cycle_s, step_s, cycle_s / std::max(issue_before, issue_after)});
  }
  return measured;
}

/// A core can be busy in nearly all turns, so the best hundredth is the measure of a free one.
double issued_when_free(const std::vector<Measurement>& measurements) {
  std::vector<double> issued;
  for (const Measurement& measured : measurements)
    for (const Turn& turn : measured.turns) issued.push_back(turn.issued);
  if (issued.empty())
    throw std::runtime_error("the clock was steady in no turn: measure on a quieter machine");
  return quantile(issued, 0.99);
}

void print(const Measurement& measured, double free_issues) {
  constexpr double free_from = 0.95;
  std::vector<double> step_s, cycle_s, cycles;
  for (const Turn& turn : measured.turns)
    if (turn.issued >= free_from * free_issues) {
      step_s.push_back(turn.step_s);
      cycle_s.push_back(turn.cycle_s);
      cycles.push_back(turn.cycles());
    }
  if (cycles.empty()) {
    std::printf("%s: in no turn was the core free\n", measured.scene.c_str());
    return;
  }
  const double nodes = static_cast<double>(measured.nodes) / 16;
  const double springs = static_cast<double>(measured.springs) / 16;
  std::printf(
      "%s: %.4g ms per step with one thread at %.2f GHz, %.1f cycles for sixteen nodes "
      "(half of the turns: %.1f to %.1f), %.1f for sixteen springs; the core was free in %zu of %zu turns\n",
      measured.scene.c_str(), median(step_s) * 1e3, 1e-9 / median(cycle_s), median(cycles) / nodes,
      quantile(cycles, 0.25) / nodes, quantile(cycles, 0.75) / nodes, median(cycles) / springs, cycles.size(),
      measured.turns.size());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Chain chain = chain_of_this_processor();
    std::vector<Measurement> measurements;
    for (const char* file : std::span(argv, static_cast<std::size_t>(argc)).subspan(1))
      measurements.push_back(measure(file, chain));
    const double issued = issued_when_free(measurements);
    std::printf("a core that is free issues %.1f instructions per cycle\n", issued);
    for (const Measurement& measured : measurements) print(measured, issued);
  } catch (const std::exception& error) {
    std::cerr << "clocked_steps: " << error.what() << '\n';
    return 1;
  }
}
