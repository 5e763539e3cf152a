// How bench_scene measures a garment: two squares, sewn together in free space.
#include "garment/bench/garment_bench.h"

#include "backends/backends.h"
#include "bench/bench_scene.h"
#include "garment/contact/body_maps.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "garment/stepping/published_dressing.h"
#include "integrators/all_integrators.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "tests/support/dressing_systems.h"
#include "tests/support/garment_system.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// A backend that passes all on to another one.
class PassesOn : public DressingBackend {
 public:
  explicit PassesOn(std::unique_ptr<DressingBackend> inner) : inner_(std::move(inner)) {}
  void set_state(const State& state) override { inner_->set_state(state); }
  void step(int count) override { inner_->step(count); }
  State state() const override { return inner_->state(); }
  std::string device() const override { return "made up"; }
  int threads() const override { return 1; }
  DressingProgress progress() const override { return inner_->progress(); }

 private:
  std::unique_ptr<DressingBackend> inner_;
};

/// Where the steps of a backend began, in the order of the calls.
std::vector<std::pair<bool, int>> steps_by_draped;

class TellsWhereItBegins final : public PassesOn {
 public:
  using PassesOn::PassesOn;
  void set_state(const State& state) override {
    draped_ = state.draped;
    PassesOn::set_state(state);
  }
  void step(int count) override {
    steps_by_draped.emplace_back(draped_, count);
    PassesOn::step(count);
  }

 private:
  bool draped_ = false;
};

std::unique_ptr<DressingBackend> make_teller(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& /*options*/) {
  return std::make_unique<TellsWhereItBegins>(make_serial_dressing(system, integrator, dt_s));
}
constexpr BackendInfo teller{.name = "serial",
                             .description = "tells where it begins",
                             .role = BackendRole::baseline,
                             .make_dressing = make_teller};

class BenchGarment : public testing::Test {
 protected:
  BenchGarment() {
    job_.execution.scene = "squares";
    job_.system = &system_;
    job_.dt_s = 1.5e-4;
    job_.backends = {&teller, find_backend("openmp"), find_backend("hybrid")};
    job_.integrators = {find_integrator("semi-euler")};
    job_.execution.threads = 1;
    job_.rounds = 2;
    job_.sample_seconds = 1e-4;
    job_.garment.emplace(GarmentJob{
        .body = nobody(), .bounds = {.upper_edge_shift = 10, .crotch_shift = 10, .rows_astray = 100}});
    steps_by_draped.clear();
  }
  std::vector<ResultRow> run() {
    return bench_scene(job_, {.progress = [](const std::string&, double) {},
                              .after_round = [](const std::vector<ResultRow>&) {},
                              .stop = [&] { return asked_++ >= stop_after_; }});
  }

  System system_ = two_squares();
  SceneJob job_;
  int asked_ = 0, stop_after_ = std::numeric_limits<int>::max();
};

TEST_F(BenchGarment, IsDressedOnceFromItsStartAndSampledDraped) {
  const std::vector<ResultRow> rows = run();
  ASSERT_EQ(rows.size(), 3U);
  for (const ResultRow& row : {rows[0], rows[1]}) {
    EXPECT_EQ(row.status, "ok");
    EXPECT_TRUE(row.verified);
    EXPECT_EQ(row.rounds, 2);
    EXPECT_GT(row.ms_per_step, 0);
    EXPECT_FALSE(row.gigabytes_per_second);
    EXPECT_FALSE(row.roofline_fraction);
    ASSERT_TRUE(row.dressing);
    EXPECT_TRUE(row.dressing->settled);
    EXPECT_GT(row.dressing->seamed_at, 0U);
    EXPECT_NEAR(row.dressing->simulated_s, static_cast<double>(row.dressing->iterations) * 1.5e-4, 1e-9);
    EXPECT_EQ(row.dressing->fit.front().name, "largest_gap_mm");
    EXPECT_LT(row.dressing->fit.front().value, 0.1);
    EXPECT_EQ(row.dressing->fit.front().within, true);
  }
  EXPECT_THAT(rows[2].status, HasSubstr("unsupported: "));
  EXPECT_FALSE(rows[2].dressing);
  // Windows of the dressing, 0.05 s each in two requests, are from the start; all samples at the end are
  // draped.
  std::int64_t dressed = 0;
  for (const auto& [draped, count] : steps_by_draped)
    if (!draped && (count == 240 || count == 333 - 240)) dressed += count;
  EXPECT_EQ(dressed, static_cast<std::int64_t>(rows[0].dressing->iterations));
  for (std::size_t i = steps_by_draped.size() - 4; i < steps_by_draped.size(); ++i)
    EXPECT_TRUE(steps_by_draped[i].first) << i;
}

TEST_F(BenchGarment, KeepsAnEarlierDressing) {
  job_.earlier = run();
  job_.earlier[0].dressing->wall_s = 12345;
  job_.rounds = 3;
  steps_by_draped.clear();
  const std::vector<ResultRow> rows = run();
  EXPECT_EQ(rows[0].dressing->wall_s, 12345);
  EXPECT_EQ(rows[0].rounds, 3);
  for (const auto& [draped, count] : steps_by_draped) EXPECT_NE(count, 333);
}

TEST_F(BenchGarment, HasFailedWhereItDoesNotFit) {
  job_.garment->bounds.largest_gap = -1;  // no gap keeps that
  const ResultRow row = run().front();
  EXPECT_THAT(row.status, HasSubstr("failed: dressed, a seam gapes: the largest gap of a seam is "));
  EXPECT_FALSE(row.verified);
  EXPECT_FALSE(row.ms_per_step);
  ASSERT_TRUE(row.dressing);
  EXPECT_EQ(row.dressing->fit.front().within, false);
}

TEST_F(BenchGarment, OfAPublishedAlgorithmIsTimedAndNotedWhereItDoesNotFit) {
  job_.backends = {&garment_backends().front()};
  EXPECT_EQ(run().front().note, "");
  job_.garment->bounds.largest_gap = -1;
  ResultRow row = run().front();
  EXPECT_EQ(row.status, "ok");
  EXPECT_TRUE(row.verified);
  EXPECT_GT(row.ms_per_step, 0);
  ASSERT_TRUE(row.dressing);
  EXPECT_EQ(row.dressing->fit.front().within, false);
  EXPECT_THAT(row.note, HasSubstr("largest_gap_mm"));
  job_.earlier = {row};
  EXPECT_EQ(run().front().note, row.note) << "resumed";
}

TEST_F(BenchGarment, HasRowsForMethodsThatDoNotDress) {
  job_.integrators = {find_integrator("rk4")};
  const std::vector<ResultRow> rows = run();
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_TRUE(steps_by_draped.empty());
  for (const ResultRow& row : rows) EXPECT_THAT(row.status, HasSubstr("unsupported: "));
}

TEST_F(BenchGarment, GivesNoRowsWhenItIsStoppedWhileItDresses) {
  for (stop_after_ = 0; stop_after_ < 6; ++stop_after_) {
    asked_ = 0;
    EXPECT_TRUE(run().empty()) << stop_after_;
  }
}

// Mistakes that a backend which dresses could make must be found.

/// Jeans, dressed once for all tests.
struct Jeans {
  SceneSpec spec = find_scene("jeans1k");
  System system = build_system(spec);
  double dt_s = spec.dt_s.value();
  State draped;
  GarmentReference reference;

  Jeans() {
    const auto backend = openmp_dressing(system, 2, dt_s);
    const DressingResult result = dress(*backend, system, dt_s, {}, always);
    EXPECT_TRUE(result.settled);
    draped = result.state;
    const auto exact = reference_dressing(system, dt_s);
    reference = run_garment_reference(*exact, system, semi_euler, dt_s, draped);
  }
};

const Jeans& jeans() {
  static const Jeans once;
  return once;
}

Verification verify_stepping(const System& stepped) {
  return verify_garment(*serial_dressing(stepped, jeans().dt_s), jeans().system, jeans().reference,
                        jeans().dt_s);
}

TEST(GarmentVerification, ComparesAPublishedAlgorithmWithItself) {
  const Jeans& scene = jeans();
  const auto exact = make_published_reference(scene.system, semi_euler, scene.dt_s);
  const GarmentReference published =
      run_garment_reference(*exact, scene.system, semi_euler, scene.dt_s, scene.draped);
  ASSERT_FALSE(published.failure) << *published.failure;
  for (const PublishedDressing& dressing : published_dressings) {
    const auto backend = maker_of(dressing)(scene.system, semi_euler, scene.dt_s, {.threads = 2});
    const Verification found = verify_garment(*backend, scene.system, published, scene.dt_s);
    EXPECT_FALSE(found.failure) << dressing.name << ": " << *found.failure;
    EXPECT_TRUE(verify_garment(*backend, scene.system, scene.reference, scene.dt_s).failure)
        << dressing.name << " is taken for mssim's own form";
  }
  System weaker = scene.system;
  garment_in(weaker).dressing.correction_threshold = 0.06;
  const auto backend = maker_of(published_dressings.front())(weaker, semi_euler, scene.dt_s, {.threads = 1});
  EXPECT_TRUE(verify_garment(*backend, scene.system, published, scene.dt_s).failure);
}

TEST(GarmentVerification, PassesTheBackendsThatDress) {
  const Jeans& scene = jeans();
  ASSERT_FALSE(scene.reference.failure);
  ASSERT_EQ(scene.reference.seaming.size(), 20U);
  ASSERT_EQ(scene.reference.draped.size(), 20U);
  for (const auto& backend : serial_and_openmp(scene.system, scene.dt_s)) {
    const Verification found = verify_garment(*backend, scene.system, scene.reference, scene.dt_s);
    EXPECT_FALSE(found.failure) << *found.failure;
    EXPECT_GT(found.position_error, 0) << "single precision cannot be exact";
    EXPECT_LT(found.position_error, scene.reference.tolerance / 2);
    EXPECT_LT(std::abs(*found.energy_drift), 1e-4);
  }
}

TEST(GarmentVerification, AllowsWhatFiveStepsRoundAndOneNodeWhatContactMoves) {
  const Jeans& scene = jeans();
  double highest = 0;
  for (const Vec3d& x : scene.system.start.position) highest = std::max(highest, x.y);
  const double unit = mean_rest_length(scene.system);
  EXPECT_NEAR(scene.reference.tolerance * unit, 4 * std::sqrt(5) * highest / (1 << 24), 1e-9);
  // 1 m/s for five steps of 0.52 ms.
  EXPECT_NEAR(scene.reference.farthest * unit, 2.6e-3, 1e-9);
}

/// Dresses the jeans, but gives states that differ once they are draped.
class GivesOtherStates final : public PassesOn {
 public:
  explicit GivesOtherStates(std::function<void(std::vector<Vec3d>&)> move)
      : PassesOn(serial_dressing(jeans().system, jeans().dt_s)), move_(std::move(move)) {}
  State state() const override {
    State state = PassesOn::state();
    if (state.draped) move_(state.position);
    return state;
  }

 private:
  std::function<void(std::vector<Vec3d>&)> move_;
};

Verification verify_moved(std::function<void(std::vector<Vec3d>&)> move) {
  GivesOtherStates backend(std::move(move));
  return verify_garment(backend, jeans().system, jeans().reference, jeans().dt_s);
}

TEST(GarmentVerification, AllowsHalfOfTheNodesAQuarterOfTheTolerance) {
  const double tolerance = jeans().reference.tolerance * mean_rest_length(jeans().system);
  const auto failure_if_displaced = [&](double share_of_tolerance) {
    const auto move_most = [&](std::vector<Vec3d>& position) {
      for (std::size_t i = 0; i < position.size(); ++i)
        if (i % 3 != 0) position[i].x += share_of_tolerance * tolerance;
    };
    return verify_moved(move_most).failure.value_or("");
  };
  EXPECT_THAT(failure_if_displaced(0.5), HasSubstr("of half of the nodes"));
  EXPECT_THAT(failure_if_displaced(0.15), Not(HasSubstr("position error")));
}

/// A mistake, made in the system that the backend under test steps, and what of it the failure must say.
struct Mistake {
  std::string name;
  std::string found_while;
  std::function<void(System&)> make;
};

void weaken(System& system, std::size_t spring) {
  system.materials.push_back({0, 0});
  system.springs.at(spring).kind = static_cast<std::uint32_t>(system.materials.size() - 1);
}

/// Of the first panel, whose materials come first.
void stiffen(System& system, GridSpringKind kind) { system.materials.at(kind).stiffness *= 1.01; }

/// The body as its maps have it, farther out.
std::vector<std::shared_ptr<const BodyMaps>> maps_farther_out(double metres) {
  SceneSpec spec = jeans().spec;
  std::get<GarmentSpec>(spec.content).skin_m += metres;
  return garment_in(build_system(spec)).body_maps;
}

TEST(GarmentVerification, FindsEveryMistake) {
  const std::vector<Mistake> mistakes{
      {"a spring of the first panel is missing", "seams close", [](System& s) { weaken(s, 1); }},
      {"the last spring is missing", "seams close", [](System& s) { weaken(s, s.springs.size() - 1); }},
      {"structural springs of a panel 1 % too stiff", "seams close",
       [](System& s) { stiffen(s, structural); }},
      {"its shear springs 1 % too stiff", "seams close", [](System& s) { stiffen(s, shear); }},
      {"its bending springs 1 % too stiff", "seams close", [](System& s) { stiffen(s, bending); }},
      {"the first joint is missing", "seams close",
       [](System& s) { garment_in(s).joints.erase(garment_in(s).joints.begin()); }},
      {"seams pull 1 % harder", "seams close", [](System& s) { garment_in(s).dressing.seam_force *= 1.01; }},
      {"no correction", "", [](System& s) { garment_in(s).dressing.correction = VelocityCorrection::none; }},
      {"the other correction", "",
       [](System& s) { garment_in(s).dressing.correction = VelocityCorrection::published; }},
      {"one sweep less", "", [](System& s) { garment_in(s).dressing.correction_sweeps = 1; }},
      {"damping 10 % off while the seams close", "seams close",
       [](System& s) { garment_in(s).dressing.seaming_damping *= 1.1; }},
      {"damping 10 % off when draped", "when draped", [](System& s) { s.viscous_damping *= 1.1; }},
      {"no gravity", "when draped", [](System& s) { s.gravity = 0; }},
      {"friction 10 % off", "when draped", [](System& s) { garment_in(s).dressing.friction *= 0.9; }},
      {"maps half a millimetre farther out", "seams close",
       [](System& s) { garment_in(s).body_maps = maps_farther_out(0.0005); }},
  };
  for (const Mistake& mistake : mistakes) {
    System wrong = jeans().system;
    mistake.make(wrong);
    const Verification found = verify_stepping(wrong);
    ASSERT_TRUE(found.failure) << mistake.name << ": error " << *found.position_error << " of "
                               << jeans().reference.tolerance;
    EXPECT_THAT(*found.failure, HasSubstr(mistake.found_while)) << mistake.name;
  }
}

TEST(GarmentVerification, FindsOneNodeThatIsFartherOffThanContactMovesIt) {
  const auto verified = [](double metres) {
    return verify_moved([metres](std::vector<Vec3d>& position) { position[17].z += metres; });
  };
  EXPECT_FALSE(verified(0.0002).failure) << "what contact may do";
  const Verification found = verified(0.006);
  ASSERT_TRUE(found.failure);
  EXPECT_THAT(*found.failure, HasSubstr("of one node when draped"));
}

TEST(GarmentVerification, SaysWhereASimulationBlowsUp) {
  const Jeans& scene = jeans();
  const auto backend = serial_dressing(scene.system, 40 * scene.dt_s);
  const Verification found = verify_garment(*backend, scene.system, scene.reference, 40 * scene.dt_s);
  ASSERT_TRUE(found.failure);
  const auto exact = reference_dressing(scene.system, 1e6 * scene.dt_s);
  const GarmentReference blown_up =
      run_garment_reference(*exact, scene.system, semi_euler, 1e6 * scene.dt_s, scene.draped);
  ASSERT_TRUE(blown_up.failure);
  EXPECT_THAT(*blown_up.failure, HasSubstr("the double-precision reference blew up at step"));
  EXPECT_EQ(verify_garment(*backend, scene.system, blown_up, scene.dt_s).failure, blown_up.failure);
}

}  // namespace
}  // namespace mssim
