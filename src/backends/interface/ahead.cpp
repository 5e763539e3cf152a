#include "backends/interface/backend.h"

namespace mssim {
namespace {

/// Adapts only mssim's own backends, so it does not pass on the questions that only users' programs answer.
class AheadBackend final : public Backend {
 public:
  AheadBackend(std::unique_ptr<Backend> backend, const System& system, double seconds)
      : backend_(std::move(backend)), system_(system), seconds_(seconds) {
    set_state(system.start);
  }

  void set_state(const State& state) override { backend_->set_state(moved_ahead(state, seconds_)); }
  State state() const override {
    State state = backend_->state();
    move_back(state, seconds_, system_.floor.height);
    return state;
  }
  void step(int count) override { backend_->step(count); }
  std::string device() const override { return backend_->device(); }
  int threads() const override { return backend_->threads(); }
  int steps_per_pass() const override { return backend_->steps_per_pass(); }
  std::optional<std::uint64_t> stored_springs() const override { return backend_->stored_springs(); }
  bool runs_on_host() const override { return backend_->runs_on_host(); }
  std::string note() const override { return backend_->note(); }

 private:
  std::unique_ptr<Backend> backend_;
  const System& system_;
  const double seconds_;
};

}  // namespace

State moved_ahead(State state, double seconds) {
  for (std::size_t i = 0; i < state.position.size(); ++i) state.position[i] += seconds * state.velocity[i];
  return state;
}

void move_back(State& state, double seconds, double floor) {
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    Vec3d& x = state.position[i];
    const bool was_above = x.y >= floor;
    x -= seconds * state.velocity[i];
    if (was_above) x.y = std::max(x.y, floor);
  }
}

std::unique_ptr<Backend> step_ahead(std::unique_ptr<Backend> backend, const System& system,
                                    const Integrator& integrator, double dt_s) {
  if (integrator.ahead == 0) return backend;
  return std::make_unique<AheadBackend>(std::move(backend), system, integrator.ahead * dt_s);
}

}  // namespace mssim
