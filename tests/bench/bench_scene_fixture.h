#pragma once

#include "backends/backends.h"
#include "bench/bench_scene.h"
#include "integrators/all_integrators.h"
#include "tests/support/systems.h"

namespace mssim {

/// The serial backend under another name.
class OtherSerial : public Backend {
 public:
  explicit OtherSerial(std::unique_ptr<Backend> serial) : serial_(std::move(serial)) {}
  void set_state(const State& state) override { serial_->set_state(state); }
  void step(int count) override { serial_->step(count); }
  State state() const override { return serial_->state(); }
  std::string device() const override { return "made up"; }
  int threads() const override { return 1; }

 protected:
  std::unique_ptr<Backend> serial_;
};

template <class Other>
std::unique_ptr<Backend> make_other(const System& system, const Integrator& integrator, double dt_s,
                                    const ExecutionOptions& options) {
  return std::make_unique<Other>(find_backend("serial")->make(system, integrator, dt_s, options));
}

/// A row of a table of backends that makes it.
template <class Other>
constexpr BackendInfo row_of(std::string_view name, BackendRole role = BackendRole::as_published) {
  BackendInfo row{};
  row.name = name;
  row.make = make_other<Other>;
  row.role = role;
  return row;
}

/// A right one behind which a program stands that fails at one of its calls, counted from 1. It takes note of
/// whether it rests.
class FailsAt final : public OtherSerial {
 public:
  explicit FailsAt(std::unique_ptr<Backend> serial) : OtherSerial(std::move(serial)) {
    calls = 0;
    call();
  }
  void set_state(const State& state) override {
    call();
    OtherSerial::set_state(state);
  }
  void step(int count) override {
    call();
    OtherSerial::step(count);
  }
  State state() const override {
    call();
    return OtherSerial::state();
  }
  std::string note() const override { return "settings"; }
  void rest() override { rests = true; }
  std::string end() override { return "all went well"; }
  double processor_seconds() const override { return processor_s += 0.5; }

  inline static int calls, fails_at;
  inline static bool rests;
  inline static double processor_s;

 private:
  static void call() {
    rests = false;
    if (++calls == fails_at) throw BackendFailure("it stumbled", "oh dear");
  }
};
constexpr BackendInfo stumbling = row_of<FailsAt>("stumbling");

/// Takes its steps when it is asked for the state.
class Postponing final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  void set_state(const State& state) override {
    owed_ = 0;
    OtherSerial::set_state(state);
  }
  void step(int count) override {
    owed_ += count;
    for (const Stopwatch watch; watch.seconds() < 3e-5;) {
    }
  }
  State state() const override {
    const int owed = std::exchange(owed_, 0);
    // Far longer than a busy machine may delay step().
    if (owed > 1) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    serial_->step(owed);
    return OtherSerial::state();
  }

 private:
  mutable int owed_ = 0;
};
constexpr BackendInfo postponing = row_of<Postponing>("postponing");

/// A small cloth, which is measured in short samples.
class BenchScene : public testing::Test {
 protected:
  BenchScene() {
    job_.execution.scene = "test";
    job_.system = &system_;
    job_.dt_s = 1e-4;
    job_.backends = {find_backend("serial"), find_backend("openmp")};
    job_.integrators = {find_integrator("semi-euler"), find_integrator("rk4")};
    job_.execution.threads = 1;
    job_.rounds = 3;
    job_.sample_seconds = 1e-4;
  }
  /// Has only these measured, with semi-euler.
  void take_only(std::vector<const BackendInfo*> backends) {
    job_.backends = std::move(backends);
    job_.integrators = {find_integrator("semi-euler")};
  }
  std::vector<ResultRow> run() {
    return bench_scene(job_,
                       {.progress =
                            [](const std::string&, double done) {
                              EXPECT_GE(done, 0);
                              EXPECT_LE(done, 1);
                            },
                        .after_round = [&](const std::vector<ResultRow>& rows) { kept_.push_back(rows); },
                        .stop = [&] { return asked_++ >= stop_after_; }});
  }

  System system_ = cloth_system(9, 11);
  SceneJob job_;
  std::vector<std::vector<ResultRow>> kept_;  ///< after every round
  int asked_ = 0;
  int stop_after_ = std::numeric_limits<int>::max();
};

}  // namespace mssim
