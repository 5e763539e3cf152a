// The threads that take a step together, each running the methods of newton_method.h. Compiled once per
// instruction set, so the guard toggles.
#if defined(MSSIM_TEAM_EQUATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_TEAM_EQUATION_INL_H_
#undef MSSIM_TEAM_EQUATION_INL_H_
#else
#define MSSIM_TEAM_EQUATION_INL_H_
#endif

#include <omp.h>

#include <optional>

#include "backends/implicit/newton/equation_passes-inl.h"
#include "backends/threads/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// A VectorEquation as one of its threads sees it: newton_method.h says what each function does. All threads
/// call the same functions, and get the same numbers: sums are those of chunks, added in their order.
template <class Nodes>
class TeamEquation {
 public:
  TeamEquation(VectorEquation<Nodes>& shared, std::size_t thread, std::size_t threads, SpinBarrier& barrier)
      : shared_(shared),
        barrier_(barrier),
        begin_(shared.nodes.chunks.size() * thread / threads),
        end_(shared.nodes.chunks.size() * (thread + 1) / threads) {}

  void begin() {
    for_own_chunks([&](NodeChunk chunk) HWY_ATTR {
      add_chunk(shared_.nodes, chunk, shared_.w.data(), shared_.v.data(), 0, nullptr);
    });
  }
  void linearise_at_state() {
    barrier_.wait();  // others have written x and v
    sum_over_chunks([&](NodeChunk chunk) HWY_ATTR { return linearise_chunk<true>(shared_, chunk); });
  }
  double linearise() {
    barrier_.wait();  // others have written x and w
    return sum_over_chunks([&](NodeChunk chunk) HWY_ATTR { return linearise_chunk<false>(shared_, chunk); });
  }
  double start_solving() {
    return sum_over_chunks([&](NodeChunk chunk) HWY_ATTR { return start_chunk(shared_, chunk); });
  }
  double turn(double factor) {
    for_own_chunks([&](NodeChunk chunk) HWY_ATTR { turn_chunk(shared_, chunk, static_cast<float>(factor)); });
    barrier_.wait();
    return sum_over_chunks([&](NodeChunk chunk) HWY_ATTR {
      return shared_.keeps_slopes() ? multiply_chunk(shared_, chunk) : multiply_chunk_anew(shared_, chunk);
    });
  }
  double advance(double factor) {
    return sum_over_chunks(
        [&](NodeChunk chunk) HWY_ATTR { return advance_chunk(shared_, chunk, static_cast<float>(factor)); });
  }
  void add(double factor) {
    for_own_chunks([&](NodeChunk chunk) HWY_ATTR {
      add_chunk(shared_.nodes, chunk, shared_.w.data(), shared_.w.data(), static_cast<float>(factor),
                shared_.s.data());
    });
  }
  double along_solution() { return product(shared_.e.data(), shared_.s.data()); }
  double motion() { return product(shared_.w.data(), shared_.w.data()); }
  double change() {
    return sum_over_chunks([&](NodeChunk chunk) HWY_ATTR { return change_chunk(shared_, chunk); });
  }
  void end() {
    for_own_chunks([&](NodeChunk chunk) HWY_ATTR { end_chunk(shared_, chunk); });
  }

 private:
  template <class Act>
  void for_own_chunks(Act&& act) {
    for (std::size_t chunk = begin_; chunk < end_; ++chunk) act(shared_.nodes.chunks[chunk]);
  }

  double product(const float* a, const float* b) {
    return sum_over_chunks([&](NodeChunk chunk) HWY_ATTR { return product_chunk(shared_, chunk, a, b); });
  }

  /// The sum of what act(chunk) returns for all chunks, of all threads, when all have called it.
  template <class Act>
  double sum_over_chunks(Act&& act) {
    // Who is still adding up those of this sum may meet who writes those of the next one, but not of the one
    // after it.
    std::vector<double>& sums = shared_.sums[sums_++ % 2];
    for (std::size_t chunk = begin_; chunk < end_; ++chunk) sums[chunk] = act(shared_.nodes.chunks[chunk]);
    barrier_.wait();
    double total = 0;
    for (const double sum : sums) total += sum;
    return shared_.nodes.sum_factor() * total;
  }

  VectorEquation<Nodes>& shared_;
  SpinBarrier& barrier_;
  const std::size_t begin_, end_;  ///< of its chunks
  std::size_t sums_ = 0;
};

template <class Nodes>
void take_steps(VectorEquation<Nodes>& shared, int count) {
  std::optional<SpinBarrier> barrier;
#pragma omp parallel num_threads(static_cast <int>(shared.threads))
  {
    const auto threads = static_cast<std::size_t>(omp_get_num_threads());  // the runtime may give fewer
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
#pragma omp single
    barrier.emplace(threads);
    TeamEquation<Nodes> equation(shared, thread, threads, *barrier);
    SolverWork work;  // the same for all
    for (int step = 0; step < count; ++step) take_step(equation, *shared.integrator, shared.goal, work);
    if (thread == 0) shared.work += work;
  }
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
