// Programs that are right where they are verified, and look fast: what the checks of the samples find.

#include "tests/bench/bench_scene_fixture.h"

namespace mssim {
namespace {

/// What a program may do that wants to look fast.
enum class Cheat : std::uint8_t {
  stops,      ///< takes a hundred steps of any request, and none after them
  drifts,     ///< is right for a hundred steps of a request, and then pulls too weakly
  grows,      ///< is right until it has been asked for some states, and then gives huge ones
  remembers,  ///< steps from the scene's start, whatever state it is given, which it need not do twice
  reverses,   ///< gives velocities of the opposite sign
  idles,      ///< takes no step of a request of `frame` steps
  lags,       ///< takes the steps of such requests when it is asked for the state
  nothing     ///< is right, but slow to give a state
};

class Cheating final : public Backend {
 public:
  Cheating(const System& system, const Integrator& integrator, double dt_s, const ExecutionOptions& options)
      : start_(system.start),
        weak_system_(system),
        right_(find_backend("serial")->make(system, integrator, dt_s, options)),
        weak_(find_backend("serial")->make(weakened(weak_system_), integrator, dt_s, options)) {}
  void set_state(const State& state) override {
    present_.reset();
    lagging_ = 0;
    right_->set_state(cheat == Cheat::remembers ? start_ : state);
  }
  void step(int count) override {
    if (count == frame && (cheat == Cheat::idles || cheat == Cheat::lags)) {
      if (cheat == Cheat::lags) lagging_ += count;
      return;
    }
    const int known = std::min(count, 100), more = count - known;
    if (cheat != Cheat::stops && cheat != Cheat::drifts) {
      right_->step(count);
    } else {
      right_->step(known);
      if (cheat == Cheat::stops || more == 0) return;
      weak_->set_state(right_->state());
      weak_->step(more);
      present_ = weak_->state();
    }
  }
  State state() const override {
    if (lagging_ > 0) right_->step(std::exchange(lagging_, 0));
    if (cheat == Cheat::nothing) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    State state = present_ ? *present_ : right_->state();
    if (cheat == Cheat::grows && ++states_ > 2)
      for (Vec3d& x : state.position) x = 1e300 * x;
    if (cheat == Cheat::reverses)
      for (Vec3d& v : state.velocity) v = -1 * v;
    return state;
  }
  std::string device() const override { return "made up"; }
  int threads() const override { return 1; }

  static constexpr int frame = 7;
  inline static Cheat cheat;

 private:
  static const System& weakened(System& system) {
    system.materials.front().stiffness *= 0.9;
    return system;
  }

  const State start_;
  System weak_system_;
  std::unique_ptr<Backend> right_, weak_;
  std::optional<State> present_;
  mutable int states_ = 0, lagging_ = 0;
};

std::unique_ptr<Backend> cheating(const System& system, const Integrator& integrator, double dt_s,
                                  const ExecutionOptions& options) {
  return std::make_unique<Cheating>(system, integrator, dt_s, options);
}
constexpr BackendInfo cheat{.name = "cheat", .description = "looks fast", .make = cheating};

TEST_F(BenchScene, FindsAProgramThatIsRightOnlyWhereItIsVerified) {
  system_ = solid_block(5, 4, 3);  // in 2,000 steps a cloth folds, and roundings grow
  job_.backends = {find_backend("serial"), &cheat};
  job_.sample_seconds = 0.05;
  const auto expect_found = [&](Cheat what, const char* sentence) {
    Cheating::cheat = what;
    for (const ResultRow& row : run()) {
      const bool right = row.backend == "serial";
      EXPECT_EQ(row.verified, right) << static_cast<int>(what) << ", " << row.integrator;
      EXPECT_THAT(row.status, HasSubstr(right ? "ok" : sentence)) << static_cast<int>(what);
      EXPECT_EQ(row.ms_per_step.has_value(), right);
    }
  };
  expect_found(Cheat::reverses, "velocity error");
  expect_found(Cheat::grows, "not finite");
  for (const Cheat what : {Cheat::stops, Cheat::drifts, Cheat::remembers})
    expect_found(what, "position error");
  job_.deadline = std::chrono::steady_clock::now();
  expect_found(Cheat::stops, "position error");
}

TEST_F(BenchScene, FindsAProgramThatPostponesItsStepsHoweverFewSamplesThereAre) {
  system_ = solid_block(5, 4, 3);
  take_only({find_backend("serial"), &postponing});
  job_.sample_seconds = 0.05;
  for (const int rounds : {1, 2, 4}) {
    job_.rounds = rounds;
    const std::vector<ResultRow> rows = run();
    EXPECT_EQ(rows[0].status, "ok") << rounds;
    EXPECT_THAT(rows[1].status, HasSubstr("reports steps before they are done")) << rounds;
    EXPECT_FALSE(rows[1].verified) << rounds;
  }
}

TEST_F(BenchScene, FindsAProgramThatIsRightExceptInFrames) {
  system_ = solid_block(5, 4, 3);
  take_only({find_backend("serial"), &cheat});
  job_.sample_seconds = 0.05;
  job_.fps = 1 / (Cheating::frame * job_.dt_s);
  for (const auto& [what, sentence] :
       {std::pair(Cheat::idles, "position error"), {Cheat::lags, "reports steps before they are done"}}) {
    Cheating::cheat = what;
    const std::vector<ResultRow> rows = run();
    EXPECT_EQ(rows[0].status, "ok");
    EXPECT_GT(rows[0].frame_p50_ms, 0);
    EXPECT_THAT(rows[1].status, HasSubstr(sentence));
    EXPECT_FALSE(rows[1].verified);
    EXPECT_EQ(rows[1].frame_p50_ms, std::nullopt);
  }
}

TEST_F(BenchScene, ChecksSamplesThatAnEarlierRunLeftUnchecked) {
  system_ = solid_block(5, 4, 3);
  take_only({find_backend("serial"), &cheat, &postponing});
  job_.sample_seconds = 0.05;
  Cheating::cheat = Cheat::remembers;
  const std::vector<ResultRow> rows = run();
  ASSERT_EQ(kept_.size(), 3U);
  for (const ResultRow& row : kept_.back()) {
    EXPECT_TRUE(counts(row)) << row.backend;
    EXPECT_TRUE(has_unchecked_samples(row)) << row.backend;
  }
  EXPECT_FALSE(has_unchecked_samples(rows[0]));
  for (const int earlier : {1, 3}) {  // ended after these rounds, and continued for as many or for fewer
    kept_.resize(3);
    job_.earlier = kept_[static_cast<std::size_t>(earlier) - 1];
    job_.rounds = 1;
    const std::vector<ResultRow> resumed = run();
    EXPECT_EQ(kept_.size(), 3U) << "no round was left";
    EXPECT_EQ(resumed[0].status, "ok");
    EXPECT_EQ(resumed[0].samples_ms, job_.earlier[0].samples_ms);
    EXPECT_FALSE(has_unchecked_samples(resumed[0]));
    EXPECT_THAT(resumed[1].status, HasSubstr("position error"));
    EXPECT_THAT(resumed[2].status, HasSubstr("reports steps before they are done"));
  }
}

TEST_F(BenchScene, LetsAProgramBeSlowToGiveItsState) {
  Cheating::cheat = Cheat::nothing;
  take_only({find_backend("serial"), &cheat});
  job_.rounds = 3;
  job_.sample_seconds = 1e-3;
  const std::vector<ResultRow> verified = run();
  EXPECT_EQ(verified[1].status, "ok");
  job_.verified = verified;
  EXPECT_EQ(run()[1].status, "ok") << "in a process that relies on an earlier one's verification, too";
}

}  // namespace
}  // namespace mssim
