#include "backends/backends.h"
#include "guide/guide.h"
#include "integrators/all_integrators.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

SizeCurve size_curve(std::vector<SizeCurve::Sample> samples, double dt_s = 1.0 / 600) {
  SizeCurve curve;
  curve.integrator = find_integrator("verlet");
  curve.backend = find_backend("serial");
  curve.dt_s = dt_s;
  curve.samples = std::move(samples);
  return curve;
}

TEST(ClothSizes, LargestIsBetweenTheLastThatHoldsAndTheNext) {
  // 10 steps a frame at 60 frames a second: a step may take 1/600 s. The time is that of the nodes.
  const SizeCurve curve = size_curve({{100, 1e-4}, {1000, 1e-3}, {10000, 1e-2}});
  ASSERT_TRUE(curve.largest(60));
  EXPECT_NEAR(curve.largest(60)->nodes, 1e3 / 0.6, 1);
  EXPECT_FALSE(curve.largest(60)->at_least);
}

TEST(ClothSizes, LargestIsThatOfWholeStepsAFrame) {
  // 3 steps a frame and not 2.5: a step may take 1/180 s.
  EXPECT_NEAR(size_curve({{100, 1e-3}, {1000, 1e-2}}, 1.0 / 150).largest(60)->nodes, 1e5 / 180, 1e-6);
}

TEST(ClothSizes, LargestMayBeBeyondOrBelowWhatWasMeasured) {
  EXPECT_FALSE(size_curve({}).largest(60));
  EXPECT_EQ(size_curve({{100, 1}, {1000, 10}}).largest(60)->nodes, 0);
  const auto large = size_curve({{100, 1e-6}, {1000, 1e-5}}).largest(60);
  EXPECT_EQ(large->nodes, 1000);
  EXPECT_TRUE(large->at_least);
}

TEST(ClothSizes, BackendsChangePlacesWhereTheirTimesAreEqual) {
  const SizeCurve slow_start = size_curve({{100, 1e-3}, {1000, 1e-3}, {10000, 2e-3}});
  const SizeCurve quick_start = size_curve({{100, 1e-4}, {1000, 1e-3}, {10000, 1e-2}});
  ASSERT_TRUE(crossover(slow_start, quick_start));
  EXPECT_NEAR(*crossover(slow_start, quick_start), 1000, 1e-6);
  EXPECT_NEAR(*crossover(quick_start, slow_start), 1000, 1e-6);
  EXPECT_FALSE(crossover(quick_start, quick_start));
  EXPECT_FALSE(crossover(size_curve({}), quick_start));
}

TEST(ClothSizes, DisturbedSamplesAreNoCrossover) {
  const SizeCurve even = size_curve({{1, 1}, {10, 1}, {100, 1}, {1000, 1}, {10000, 1}});
  const auto against = [&](std::vector<double> seconds) {
    SizeCurve other = even;
    for (std::size_t i = 0; i < seconds.size(); ++i) other.samples[i].seconds_a_step = seconds[i];
    return crossover(even, other);
  };
  EXPECT_FALSE(against({2, 2, 0.5, 2, 2})) << "the first one is faster at all other sizes";
  ASSERT_TRUE(against({2, 0.5, 2, 0.5, 0.5}));
  EXPECT_NEAR(*against({2, 0.5, 2, 0.5, 0.5}), std::sqrt(1e5), 1e-6) << "the last change";
}

TEST(ClothSizes, AreMeasuredUntilAFrameTakesTooLong) {
  // A step so small that no cloth holds 30 frames a second: two sizes show it.
  std::vector<SizeCurve> curves{size_curve({}, 1e-9), size_curve({}, 1e-9)};
  curves[1].status = "left out";
  measure_sizes(
      curves, [](std::uint32_t side) { return FamilyCloth{cloth_system(side, side)}; }, {.threads = 1},
      [](const std::string&) { return true; });
  ASSERT_EQ(curves[0].samples.size(), 2U);
  EXPECT_EQ(curves[0].samples[0].nodes, 256U);
  EXPECT_EQ(curves[0].largest(30)->nodes, 0);
  EXPECT_TRUE(curves[1].samples.empty());
}

/// Steps nothing.
class Idle final : public Backend {
 public:
  explicit Idle(const System& system) : state_(system.start) {}
  void set_state(const State& state) override { state_ = state; }
  void step(int /*count*/) override {}
  State state() const override { return state_; }
  int threads() const override { return 1; }

 private:
  State state_;
};

TEST(ClothSizes, AreNotThoseOfABackendThatTakesOtherSteps) {
  BackendInfo idle{.name = "idle"};
  idle.make = [](const System& system, const Integrator&, double,
                 const ExecutionOptions&) -> std::unique_ptr<Backend> {
    return std::make_unique<Idle>(system);
  };
  std::vector<SizeCurve> curves{size_curve({}, 1e-4), size_curve({}, 1e-4)};
  curves[1].backend = &idle;
  measure_sizes(
      curves, [](std::uint32_t side) { return FamilyCloth{cloth_system(side, side)}; }, {.threads = 1},
      [](const std::string&) { return true; });
  EXPECT_FALSE(curves[0].samples.empty());
  EXPECT_EQ(curves[0].status, "");
  EXPECT_TRUE(curves[1].samples.empty());
  EXPECT_THAT(curves[1].status, AllOf(HasSubstr("256 nodes"), HasSubstr("openmp"), HasSubstr("200 steps")));
}

TEST(ClothSizes, SayThatTheTimeWasOver) {
  std::vector<SizeCurve> curves{size_curve({})};
  measure_sizes(
      curves, [](std::uint32_t side) { return FamilyCloth{cloth_system(side, side)}; }, {.threads = 1},
      [](const std::string&) { return false; });
  EXPECT_TRUE(curves[0].samples.empty());
  EXPECT_NE(curves[0].status, "");
}

}  // namespace
}  // namespace mssim
