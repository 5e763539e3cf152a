#pragma once

#include <cstddef>
#include <memory>

#include "backends/interface/backend.h"
#include "backends/spring_list/spring_list.h"
#include "backends/threads/spin_barrier.h"

namespace mssim {

/// The plain spring list stepped by several threads. All methods on it against the data race of Hong et al.'s
/// Figure 1 share this step and SpringList's layout, force and update, so they differ only in the
/// accumulation. A Method is constructed from (SpringList<float>&, std::size_t threads), and in every stage
/// each thread calls, with its Team:
/// - prepare(team), while others may still be in the previous stage's `finish` and update: it writes only
///   data that no other thread accesses there, and reads no node;
/// - add(team, pair to gather), after all have prepared: computes the forces and adds them;
/// - finish(team), after all have added: completes the forces of this thread's slice of the nodes.
template <class Method>
class ListMethod final : public Backend {
 public:
  ListMethod(const System& system, const Integrator& integrator, double dt_s, int threads)
      : list_(system, integrator, dt_s),
        integrator_(integrator),
        threads_(threads),
        accumulation_(list_, static_cast<std::size_t>(threads)) {}

  void set_state(const State& state) override { list_.set_state(state); }
  State state() const override { return list_.state(); }
  int threads() const override { return threads_; }

  void step(int count) override {
    with_integrator(integrator_, [&](auto method) {
      with_team(static_cast<std::size_t>(threads_), [&](const Team& team) {
        for (int step = 0; step < count; ++step) take_step<method>(team);
      });
    });
  }

 private:
  template <std::size_t method>
  void take_step(const Team& team) {
    for_each_stage<method>([&](auto stage) {
      accumulation_.prepare(team);
      team.meet();
      accumulation_.add(team, integrators[method].stages[stage].gather);
      team.meet();
      accumulation_.finish(team);
      list_.template update_nodes<method, stage>(team.begin(list_.nodes()), team.end(list_.nodes()));
    });
    team.meet();
    if (team.thread == 0) list_.end_step();  // visible to all after the next stage's first barrier
  }

  SpringList<float> list_;
  const Integrator& integrator_;
  const int threads_;
  Method accumulation_;
};

/// Makes it, on options.threads threads.
template <class Method>
std::unique_ptr<Backend> make_list_method(const System& system, const Integrator& integrator, double dt_s,
                                          const ExecutionOptions& options) {
  return std::make_unique<ListMethod<Method>>(system, integrator, dt_s, options.threads);
}

/// An accumulation without prepare and finish.
class Accumulation {
 public:
  Accumulation(SpringList<float>& list, std::size_t /*threads*/) : list_(list) {}
  void prepare(const Team& /*team*/) {}
  void finish(const Team& /*team*/) {}

 protected:
  SpringList<float>& list_;
};

/// An accumulation that adds to the forces of the list.
class AddingAccumulation : public Accumulation {
 public:
  using Accumulation::Accumulation;
  void prepare(const Team& team) { list_.clear_forces(team.begin(list_.nodes()), team.end(list_.nodes())); }
};

}  // namespace mssim
