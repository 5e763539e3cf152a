// How bench_scene measures a garment: two squares, sewn together in free space.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backends/backends.h"
#include "bench/bench_scene.h"
#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "tests/support/garment_system.h"

namespace mssim {
namespace {

using testing::HasSubstr;

/// Where the steps of a backend began, in the order of the calls.
std::vector<std::pair<bool, int>> steps_by_draped;

class TellsWhereItBegins final : public DressingBackend {
 public:
  explicit TellsWhereItBegins(std::unique_ptr<DressingBackend> inner) : inner_(std::move(inner)) {}
  void set_state(const State& state) override {
    draped_ = state.draped;
    inner_->set_state(state);
  }
  void step(int count) override {
    steps_by_draped.emplace_back(draped_, count);
    inner_->step(count);
  }
  State state() const override { return inner_->state(); }
  std::string device() const override { return "made up"; }
  int threads() const override { return 1; }
  DressingProgress progress() const override { return inner_->progress(); }

 private:
  std::unique_ptr<DressingBackend> inner_;
  bool draped_ = false;
};

std::unique_ptr<DressingBackend> make_teller(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& /*options*/) {
  return std::make_unique<TellsWhereItBegins>(make_serial_dressing(system, integrator, dt_s));
}
constexpr BackendInfo teller{"serial", "", "tells where it begins", false,      {}, nullptr, {},
                             {},       1,  BackendRole::baseline,   make_teller};

class BenchGarment : public testing::Test {
 protected:
  BenchGarment() {
    std::vector<std::uint32_t> right, left;
    for (std::uint32_t row = 0; row < 10; ++row) {
      right.push_back(garment_in(system_).panels[0].node(row, 9));
      left.push_back(garment_in(system_).panels[1].node(row, 0));
    }
    sew(system_, right, left, 0.1);
    system_.viscous_damping = 16;
    job_.name = "squares";
    job_.system = &system_;
    job_.dt_s = 1.5e-4;
    job_.backends = {&teller, find_backend("openmp"), find_backend("hybrid")};
    job_.integrators = {find_integrator("semi-euler")};
    job_.execution.threads = 1;
    job_.rounds = 2;
    job_.sample_seconds = 1e-4;
    job_.garment.emplace(
        GarmentJob{.body = {[](std::span<const Vec3d> points) { return std::vector<double>(points.size()); },
                            [](const Vec3d& point) { return point; }},
                   .bounds = {.upper_edge_shift = 10, .meeting_shift = 10, .rows_astray = 100}});
    steps_by_draped.clear();
  }
  std::vector<ResultRow> run() {
    return bench_scene(job_, {.progress = [](const std::string&, double) {},
                              .after_round = [](const std::vector<ResultRow>&) {},
                              .stop = [&] { return asked_++ >= stop_after_; }});
  }

  System system_ = garment_of({{10, 10, 0.01, {0, 0, 0}}, {10, 10, 0.01, {0.12, 0.004, 0.005}}});
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
  // Windows of the dressing, 0.05 s each, are from the start; all samples at the end are draped.
  std::int64_t dressed = 0;
  for (const auto& [draped, count] : steps_by_draped)
    if (!draped && count == 333) dressed += count;
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

}  // namespace
}  // namespace mssim
