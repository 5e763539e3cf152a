#include "bench/windows/windows.h"

#include <variant>

#include "backends/backends.h"
#include "backends/layouts/band_grid.h"
#include "integrators/all_integrators.h"
#include "scene/builders.h"
#include "scene/scene_kinds.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

WindowedCloth windowed(const SceneSpec& spec, std::vector<GridWindow> windows) {
  const auto& cloth = std::get<ClothSpec>(spec.content);
  return {{cloth.rows, cloth.columns, cloth.spacing_m},
          count_springs(cloth.rows, cloth.columns),
          std::move(windows),
          [spec](const GridWindow& window) {
            System system = build_cloth_window(spec, window);
            system.springs = springs_of(std::get<GridPatch>(system.topology));
            round_start_to_single(system);
            return system;
          }};
}

/// The whole in double precision, as a backend that gives windows; `wrong` is added to a coordinate of a
/// node.
class WholeInWindows final : public Backend {
 public:
  WholeInWindows(const System& system, const Integrator& integrator, double dt_s,
                 std::vector<GridWindow> windows)
      : system_(system), windows_(std::move(windows)), backend_(make_reference(system, integrator, dt_s)) {}
  void set_state(const State&) override { backend_->set_state(system_.start); }
  void step(int count) override { backend_->step(count); }
  State state() const override {
    const State all = backend_->state();
    const std::size_t columns = std::get<GridPatch>(system_.topology).columns;
    State some;
    for (const GridWindow& window : windows_)
      for (std::size_t row = window.row; row < window.row + window.rows; ++row)
        for (std::size_t column = window.column; column < window.column + window.columns; ++column) {
          some.add(all.position[row * columns + column], all.velocity[row * columns + column]);
          if (row * columns + column == wrong_node) some.position.back().z += wrong;
        }
    return some;
  }
  std::string device() const override { return "cpu"; }
  int threads() const override { return 1; }

  std::size_t wrong_node = SIZE_MAX;
  double wrong = 0;

 private:
  const System& system_;
  std::vector<GridWindow> windows_;
  std::unique_ptr<Backend> backend_;
};

class WindowOfEachIntegrator : public testing::TestWithParam<std::string_view> {};

TEST_P(WindowOfEachIntegrator, HasTheReferenceOfTheWhole) {
  const Integrator& integrator = *find_integrator(GetParam());
  constexpr double dt_s = 1e-4;
  // Long enough that the domain of a window in the middle is cut at both sides, for every integrator.
  constexpr std::uint32_t length = 1700, width = 12;
  for (const bool turned : {false, true}) {
    SceneSpec spec = turned ? cloth_spec(length, width) : cloth_spec(width, length);
    std::get<ClothSpec>(spec.content).pins = ClothPins{turned ? length / 2 : 0, 10};
    const System system = build_system(spec);
    const auto at = [&](std::uint32_t along, std::uint32_t across) {
      return turned ? GridWindow{along, across, 10, 6} : GridWindow{across, along, 6, 10};
    };
    const WindowedCloth cloth = windowed(spec, {at(0, 0), at(845, 2), at(length - 10, 6), at(1000, 0)});
    const WindowReferences found = run_window_references(cloth, integrator, dt_s, 2);
    ASSERT_FALSE(found.failure) << *found.failure;
    // The last look within the steps that can be compared, all but for explicit-euler.
    const int comparable = comparable_steps(system, integrator, dt_s, verification_steps);
    EXPECT_EQ(found.steps, *std::ranges::find_if(window_looks.rbegin(), window_looks.rend(),
                                                 [&](int look) { return look <= comparable; }));
    EXPECT_EQ(comparable == verification_steps, integrator.name != "explicit-euler");
    WholeInWindows whole(system, integrator, dt_s, cloth.windows);
    whole.step(found.steps);
    const State expected = whole.state();
    std::size_t first = 0;
    const double tolerance = integrator.ahead == 0 ? 0 : 1e-14;
    for (const WindowReference& reference : found.windows) {
      const State& state = reference.after(found.steps);
      ASSERT_EQ(state.position.size(), 60U);
      double largest = 0;
      for (std::size_t i = 0; i < state.position.size(); ++i) {
        const Vec3d x = state.position[i] - expected.position[first + i],
                    v = state.velocity[i] - expected.velocity[first + i];
        largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
        if (integrator.ahead == 0) {
          EXPECT_EQ(dot(v, v), 0);
        }
      }
      EXPECT_LE(largest, tolerance) << "row " << reference.window.row << ", column "
                                    << reference.window.column;
      EXPECT_NE(state.position, reference.system.start.position);
      first += state.position.size();
    }
    EXPECT_FALSE(verify_windows(whole, found).failure);
  }
}

std::vector<std::string_view> explicit_integrators() {
  std::vector<std::string_view> names;
  for (const Integrator* integrator : all_integrators)
    if (!is_implicit(*integrator)) names.push_back(integrator->name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Table, WindowOfEachIntegrator, testing::ValuesIn(explicit_integrators()), ByName());

TEST(WindowVerification, NoticesOneNodeAndOneThatIsNotFinite) {
  const SceneSpec spec = cloth_spec(40, 50);
  const System system = build_system(spec);
  const Integrator& integrator = *find_integrator("semi-euler");
  const WindowedCloth cloth = windowed(spec, {{0, 0, 10, 10}, {20, 30, 10, 10}});
  const WindowReferences reference = run_window_references(cloth, integrator, 1e-4, 1);
  WholeInWindows whole(system, integrator, 1e-4, cloth.windows);
  const Verification right = verify_windows(whole, reference);
  EXPECT_FALSE(right.failure);
  EXPECT_EQ(right.position_error, 0);
  EXPECT_FALSE(right.state_hash);
  whole.wrong_node = 25 * 50 + 35;
  whole.wrong = 1e-5;
  const Verification off = verify_windows(whole, reference);
  ASSERT_TRUE(off.failure);
  EXPECT_THAT(*off.failure, HasSubstr("in the window that starts at row 20 and column 30"));
  whole.wrong = std::numeric_limits<double>::quiet_NaN();
  const Verification bad = verify_windows(whole, reference);
  ASSERT_TRUE(bad.failure);
  EXPECT_THAT(*bad.failure, HasSubstr("blew up at step 1 (t = 0.0001 s): node 1285 is"));
}

TEST(WindowReference, EndsWhereANodeMeetsTheFloor) {
  SceneSpec spec = sheet_spec(20, 20, 0.0002);
  spec.floor.restitution = 0;
  const Integrator& integrator = *find_integrator("semi-euler");
  const WindowedCloth cloth = windowed(spec, {{0, 0, 8, 8}, {12, 12, 8, 8}});
  const WindowReferences found = run_window_references(cloth, integrator, 1e-4, 1);
  EXPECT_FALSE(found.failure);
  EXPECT_EQ(found.steps, 60);  // it falls for 6.4 ms
}

TEST(WindowChoice, IsApartWithinTheClothAndInEveryPart) {
  for (const auto& [rows, columns] : {std::pair{200U, 200U}, {1000U, 3000U}, {31623U, 31623U}, {9U, 400U}})
    for (const std::size_t parts : {1U, 2U, 3U, 8U}) {
      const GridPatch grid{rows, columns, 0.01};
      const std::vector<GridWindow> windows = choose_windows(grid, parts, 0, usual_windows(parts));
      EXPECT_LE(windows.size(), usual_windows(parts));
      EXPECT_GE(windows.size(), 2U);
      for (auto a = windows.begin(); a != windows.end(); ++a) {
        EXPECT_LE(a->row + a->rows, rows);
        EXPECT_LE(a->column + a->columns, columns);
        EXPECT_EQ(a->nodes(), windows.front().nodes());
        for (auto b = windows.begin(); b != a; ++b)
          EXPECT_TRUE(a->row + a->rows <= b->row || b->row + b->rows <= a->row ||
                      a->column + a->columns <= b->column || b->column + b->columns <= a->column);
      }
      for (std::size_t part = 0; part < parts; ++part) {
        const ColumnRange own = part_of({0, columns}, part, parts);
        EXPECT_TRUE(std::ranges::any_of(windows,
                                        [&](const GridWindow& window) {
                                          return window.column < own.end() &&
                                                 window.column + window.columns > own.first;
                                        }))
            << "part " << part << " of " << parts;
      }
    }
  EXPECT_EQ(choose_windows({4000, 4000, 0.01}, 3, 0, 20).size(), 20U);
  EXPECT_EQ(choose_windows({4000, 4000, 0.01}, 3, 0, 20).front().rows, 128U);
}

TEST(WindowVerification, SaysWhatItHasSeen) {
  EXPECT_EQ(share_seen(windowed(cloth_spec(100, 100), {{0, 0, 8, 5}, {50, 50, 8, 5}})),
            "verified in 2 windows, 0.8 % of the nodes");
}

}  // namespace
}  // namespace mssim
