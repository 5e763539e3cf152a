#pragma once

#include <omp.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "backends/accumulation/team.h"
#include "backends/interface/backend.h"
#include "backends/spring_list/spring_list.h"
#include "backends/threads/spin_barrier.h"

namespace mssim {

/// The plain spring list stepped by several threads. The methods on it to avoid the data race of Hong et
/// al.'s Figure 1 have this step in common, and the layout, the force and the update of SpringList, so that
/// they differ in the accumulation alone. An Accumulation is made of (const System&, SpringList<float>&,
/// std::size_t threads), and in every stage each thread calls, with its Team:
/// - prepare(team), while others may still be in the last stage's `finish` and update: it writes only what no
///   other thread touches there, and reads no node;
/// - add(team, pair to gather), after all have prepared: computes the forces and adds them;
/// - finish(team), after all have added: completes the forces of this thread's slice of the nodes.
template <class Accumulation>
class ListMethod final : public Backend {
 public:
  ListMethod(const System& system, const Integrator& integrator, double dt_s, int threads)
      : list_(system, integrator, dt_s),
        integrator_(integrator),
        threads_(threads),
        accumulation_(system, list_, static_cast<std::size_t>(threads)) {}

  void set_state(const State& state) override { list_.set_state(state); }
  State state() const override { return list_.state(); }
  std::string device() const override { return "cpu"; }
  int threads() const override { return threads_; }

  void step(int count) override {
    with_integrator(integrator_, [&](auto method) {
      std::optional<SpinBarrier> barrier;
#pragma omp parallel num_threads(threads_)
      {
        const auto threads = static_cast<std::size_t>(omp_get_num_threads());  // the runtime may give fewer
#pragma omp single
        barrier.emplace(threads);
        const Team team{static_cast<std::size_t>(omp_get_thread_num()), threads, *barrier};
        for (int step = 0; step < count; ++step) take_step<method>(team);
      }
    });
  }

 private:
  template <std::size_t method>
  void take_step(const Team& team) {
    for_each_stage<method>([&](auto stage) {
      accumulation_.prepare(team);
      team.barrier.wait();
      accumulation_.add(team, integrators[method].stages[stage].gather);
      team.barrier.wait();
      accumulation_.finish(team);
      list_.template update_nodes<method, stage>(team.begin(list_.nodes()), team.end(list_.nodes()));
    });
    team.barrier.wait();
    if (team.thread == 0) list_.end_step();  // seen by all after the next stage's first barrier
  }

  SpringList<float> list_;
  const Integrator& integrator_;
  const int threads_;
  Accumulation accumulation_;
};

/// What the table of methods holds for an accumulation.
template <class Accumulation>
std::unique_ptr<Backend> make_list_method(const System& system, const Integrator& integrator, double dt_s,
                                          const ExecutionOptions& options) {
  return std::make_unique<ListMethod<Accumulation>>(system, integrator, dt_s, options.threads);
}

}  // namespace mssim
