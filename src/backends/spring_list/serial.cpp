#include "backends/spring_list/list_backends.h"
#include "backends/spring_list/spring_list.h"

namespace mssim {
namespace {

template <class Real>
class Serial final : public Backend {
 public:
  Serial(const System& system, const Integrator& integrator, double dt_s)
      : list_(system, integrator, dt_s), integrator_(integrator) {}

  void set_state(const State& state) override { list_.set_state(state); }
  State state() const override { return list_.state(); }
  int threads() const override { return 1; }

  void step(int count) override {
    with_integrator(integrator_, [&](auto method) {
      for (int step = 0; step < count; ++step) {
        for_each_stage<method>([&](auto stage) {
          list_.clear_forces(0, list_.nodes());
          for (const Spring& spring : list_.springs())
            list_.add_force(spring, list_.force_of(spring, integrators[method].stages[stage].gather));
          list_.template update_nodes<method, stage>(0, list_.nodes());
        });
        list_.end_step();
      }
    });
  }

 private:
  SpringList<Real> list_;
  const Integrator& integrator_;
};

}  // namespace

std::unique_ptr<Backend> make_serial(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& /*options*/) {
  return std::make_unique<Serial<float>>(system, integrator, dt_s);
}

std::unique_ptr<Backend> make_serial_in_double(const System& system, const Integrator& integrator,
                                               double dt_s, const ExecutionOptions& /*options*/) {
  return std::make_unique<Serial<double>>(system, integrator, dt_s);
}

}  // namespace mssim
