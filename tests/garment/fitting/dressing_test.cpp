// Jeans that are dressed fit, and for each bound of a fit there is a case that only this bound, or it first,
// finds out.

#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "tests/support/backend_checks.h"
#include "tests/support/dressed_jeans.h"
#include "tests/support/dressing_systems.h"
#include "tests/support/garment_system.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr SettlingRule two_seconds{.longest_s = 2};

Dressed dressed_after(const std::function<void(DressingCase&)>& change,
                      const SettlingRule& rule = two_seconds) {
  DressingCase jeans("jeans1k");
  change(jeans);
  return dressed(jeans, rule);
}

/// The body's surface as maps that lie this far before it.
void let_maps_lie(DressingCase& jeans, double offset) {
  const double pixel = std::get<GarmentSpec>(jeans.spec.content).pixel_m;
  put_on(jeans.system, jeans.body->surface, {.pixel = pixel, .offset = offset});
}

TEST(DressedJeans, FitWithinAllBounds) {
  const Dressed jeans = dressed_after([](DressingCase&) {});
  EXPECT_THAT(jeans.found, IsEmpty());
  EXPECT_EQ(jeans.fit.rows_astray, 0U);
  EXPECT_GE(jeans.fit.rows, 40U);
  EXPECT_GT(jeans.fit.side_distance.value(), 0.003) << "the skin alone";
}

/// What only one bound of a fit finds out, or it first.
struct Misdressed {
  const char* sentence;  ///< holds this
  std::function<void(DressingCase& on)> change;
  double longest_s = 2;
  bool sewn = true;
};

TEST(DressedJeans, AreFoundOutByTheBoundThatTheyBreak) {
  const Misdressed all[]{
      {"the seams did not close",
       [](DressingCase& on) {
         on.garment().dressing.seam_force = 0;
         on.garment().dressing.longest_seaming_s = 100;
       },
       0.3, false},
      {"the largest gap of a seam is ", [](DressingCase& on) { on.garment().dressing.closing_share = 0; }},
      {"the garment did not come to rest within ", [](DressingCase&) {}, 0.3},
      {"the deepest node inside the body is ", [](DressingCase& on) { let_maps_lie(on, -0.004); }},
      {"rows that do not go once around their limb", [](DressingCase& on) {
         for (Vec3d& node : on.system.start.position) node.z += 0.3;
         round_to_single(on.system.start);
       }}};
  for (const Misdressed& one : all) {
    SCOPED_TRACE(one.sentence);
    const Dressed jeans = dressed_after(one.change, {.longest_s = one.longest_s});
    EXPECT_EQ(jeans.result.seamed_at.has_value(), one.sewn);
    EXPECT_THAT(jeans.found, Contains(HasSubstr(one.sentence)));
  }
}

TEST(DressedJeans, LetTheBodyThroughFacesBetweenCleanNodes) {
  // Cells of 27 mm and no room for their sagitta, 2.3 mm where the body bends with a radius of 40 mm.
  const Dressed jeans = dressed_after([](DressingCase& on) { let_maps_lie(on, 0.0003); });
  EXPECT_LT(jeans.fit.deepest_node, 1e-3);
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the deepest point of a face inside the body is ")));
}

TEST(DressedJeans, OfLimpClothAreOverlongWithoutCorrection) {
  const Dressed jeans = dressed_after([](DressingCase& on) {
    for (auto& material : on.system.materials) material.stiffness *= 0.1;
    on.garment().dressing.correction = VelocityCorrection::none;
  });
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the 99th percentile of elongations is ")));
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the 99.9th percentile of elongations is ")));
}

TEST(DressedJeans, ThatFallWhileTheyAreSewnPassTheNaiveChecksAndAreFoundTooLow) {
  const Dressed jeans = dressed_after([](DressingCase& on) {
    on.garment().dressing.seaming_gravity = 1;
    on.garment().dressing.seam_force = 1;
  });
  EXPECT_TRUE(jeans.result.seamed_at);
  EXPECT_LT(jeans.fit.largest_gap, 1e-3);
  EXPECT_LT(jeans.fit.deepest_node, 1e-3);
  EXPECT_THAT(jeans.found,
              Contains(HasSubstr("the distance of the upper edge from its place in the pattern is -")));
}

TEST(DressedJeans, ThatAreDrawnUpHaveTheirCrotchTooHigh) {
  SceneSpec spec = find_scene("jeans1k");
  std::get<GarmentSpec>(spec.content).jeans.value().measures.crotch_ease = 0.04;
  spec.gravity_m_per_s2 = -50;
  const Dressed jeans = dressed(DressingCase(spec), two_seconds);
  EXPECT_THAT(jeans.found,
              Contains(HasSubstr("the distance of the crotch from its place in the pattern is ")));
  EXPECT_GT(jeans.fit.crotch_rise.value(), 0.03);
}

TEST(DressedJeans, ThatAreWideAtTheHipStandOffAtTheSides) {
  SceneSpec spec = find_scene("jeans1k");
  std::get<GarmentSpec>(spec.content).jeans.value().measures.hip_ease = 0.08;
  const Dressed jeans = dressed(DressingCase(spec), two_seconds);
  EXPECT_THAT(jeans.found, ElementsAre(HasSubstr("stands off at the sides: ")));
  EXPECT_GT(jeans.fit.side_distance.value(), 0.015);
  EXPECT_GT(jeans.fit.side_distance_height.value(), 0.758);
  EXPECT_LT(jeans.fit.side_distance_height.value(), 0.86);
}

// Looking at a dressing on its way: which frames come, and that they change nothing.

/// Two squares that are sewn, side by side, and hung by a corner.
System hung_squares() {
  System system = two_squares();
  system.pins = {garment_in(system).panels[0].node(9, 0)};
  system.gravity = 9.81;
  return system;
}

std::vector<std::unique_ptr<DressingBackend>> backends(const System& system, int threads) {
  std::vector<std::unique_ptr<DressingBackend>> made;
  made.push_back(serial_dressing(system));
  made.push_back(reference_dressing(system));
  made.push_back(openmp_dressing(system, threads));
  return made;
}

void expect_same(const State& one, const State& other) { EXPECT_TRUE(same_state(one, other)); }

TEST(DressingFrames, StepsGiveTheSameBitsHoweverTheyAreCut) {
  const System system = hung_squares();
  for (const auto& backend : backends(system, 2)) {
    const State whole = state_after(*backend, 500);
    EXPECT_TRUE(backend->progress().draping) << "both halves of Algorithm 1 are to be cut";
    const std::int64_t seamed_at = backend->progress().seamed_at;
    EXPECT_GT(seamed_at, 100);

    backend->set_state(system.start);
    int done = 0;
    for (int next = 1; done < 500; next = next % 7 + 1) {
      const int count = std::min(next, 500 - done);
      backend->step(count);
      done += count;
      backend->state();
    }
    expect_same(backend->state(), whole);
    EXPECT_EQ(backend->progress().seamed_at, seamed_at);
  }
}

TEST(DressingFrames, ChangeNothing) {
  const System system = hung_squares();
  for (const auto& backend : backends(system, 1)) {
    const SettlingRule soon{.distance = 1};  // it moves less in the first window after its seam has closed
    const DressingResult alone = dress(*backend, system, dressing_dt_s, soon, always);
    EXPECT_TRUE(alone.settled);
    EXPECT_EQ(alone.iterations, 2 * 333);
    for (const double steps_per_frame : {1.0, 37.3, 333.0, 1e9}) {
      const DressingResult looked_at = dress(*backend, system, dressing_dt_s, soon, always,
                                             {{steps_per_frame}, [](const State&, std::int64_t) {}});
      EXPECT_EQ(looked_at.iterations, alone.iterations);
      EXPECT_EQ(looked_at.seamed_at, alone.seamed_at);
      EXPECT_TRUE(looked_at.settled);
      expect_same(looked_at.state, alone.state);
    }
  }
}

TEST(DressingFrames, AreTheStartThoseOfTheGridAndTheEnd) {
  const System system = hung_squares();
  const auto backend = serial_dressing(system);
  const auto reference = serial_dressing(system);
  // 0.003 s are windows of 20 steps; it does not settle in three of them.
  const SettlingRule rule{.window_s = 0.003, .longest_s = 0.009};
  const auto steps_at = [&](double steps_per_frame) {
    std::vector<std::int64_t> steps;
    std::int64_t done = 0;
    reference->set_state(system.start);
    const DressingResult result = dress(*backend, system, dressing_dt_s, rule, always,
                                        {{steps_per_frame}, [&](const State& state, std::int64_t iterations) {
                                           steps.push_back(iterations);
                                           if (iterations == 0) return expect_same(state, system.start);
                                           reference->step(static_cast<int>(iterations - done));
                                           done = iterations;
                                           expect_same(state, reference->state());
                                         }});
    EXPECT_EQ(result.iterations, 60);
    return steps;
  };
  using Steps = std::vector<std::int64_t>;
  EXPECT_EQ(steps_at(12.5), (Steps{0, 13, 25, 38, 50, 60}));
  EXPECT_EQ(steps_at(20), (Steps{0, 20, 40, 60}));  // the windows themselves, the end not twice
  EXPECT_EQ(steps_at(25), (Steps{0, 25, 50, 60}));
  EXPECT_EQ(steps_at(1000), (Steps{0, 60}));
  EXPECT_EQ(steps_at(1).size(), 61U);
}

TEST(Dressing, EndsWhenTheLongestTimeIsOverAndNoWindowThatIsCutShortCountsAsRest) {
  const System system = hung_squares();
  const auto backend = serial_dressing(system);
  // A metre is more than any node moves: whatever counts as a window is one of rest.
  const auto dressed_for = [&](double longest_s) {
    return dress(*backend, system, dressing_dt_s, {.window_s = 0.003, .distance = 1, .longest_s = longest_s},
                 always);
  };
  const DressingResult settled = dressed_for(1);
  ASSERT_TRUE(settled.settled);
  ASSERT_EQ(settled.iterations % 20, 0);
  const DressingResult cut = dressed_for(settled.simulated_s - 3 * dressing_dt_s);
  EXPECT_EQ(cut.iterations, settled.iterations - 3);
  EXPECT_FALSE(cut.settled);
  EXPECT_EQ(dressed_for(dressing_dt_s).iterations, 1);
}

/// A dressing whose seams are closed from the first step on. It steps to where a test wants its nodes.
class Sewn final : public DressingBackend {
 public:
  void set_state(const State& state) override { state_ = state; }
  void step(int count) override { steps_ += count; }
  State state() const override { return state_; }
  int threads() const override { return 1; }
  DressingProgress progress() const override { return {.draping = true}; }

  State state_;
  std::int64_t steps_ = 0;
};

TEST(Dressing, SettlesIfMoreThanAFractionOfTheNodesRestAndNotWhileItBlowsUp) {
  System system;
  system.start.position.resize(100);
  system.start.velocity.resize(100);
  const auto settles = [&](std::size_t nodes, double x) {
    Sewn backend;
    return dress(backend, system, 1, {.window_s = 1, .longest_s = 1}, always,
                 {{1},
                  [&](const State&, std::int64_t) {
                    for (std::size_t i = 0; i < nodes; ++i) backend.state_.position[i].x = x;
                  }})
        .settled;
  };
  EXPECT_TRUE(settles(0, 1));
  EXPECT_TRUE(settles(100, 0.0004));
  EXPECT_FALSE(settles(1, 0.0006)) << "99 of 100 rest";
  EXPECT_FALSE(settles(100, std::numeric_limits<double>::quiet_NaN()));
}

TEST(Dressing, TakesMoreStepsInAWindowThanAnIntHolds) {
  Sewn backend;
  EXPECT_EQ(dress(backend, two_squares(), 1e-11, {}, always).iterations, 5'000'000'000);
  EXPECT_EQ(backend.steps_, 5'000'000'000);
}

TEST(DressingFrames, EndWhereTheDressingIsEnded) {
  const System system = hung_squares();
  const auto backend = serial_dressing(system);
  std::vector<std::int64_t> steps;
  const DressingResult result =
      dress(*backend, system, dressing_dt_s, {.window_s = 0.003},
            [](const State&, std::int64_t iterations) { return iterations < 40; },
            {{15}, [&](const State&, std::int64_t iterations) { steps.push_back(iterations); }});
  EXPECT_EQ(result.iterations, 40);
  EXPECT_EQ(steps, (std::vector<std::int64_t>{0, 15, 30, 40}));
}

}  // namespace
}  // namespace mssim
