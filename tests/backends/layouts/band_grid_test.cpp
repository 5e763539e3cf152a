#include "backends/layouts/band_grid.h"

#include <thread>

#include "backends/openmp/openmp.h"
#include "backends/vectors/step_kernels.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "scene/builders.h"
#include "scene/scene_kinds.h"
#include "tests/support/backend_checks.h"
#include "tests/support/mail.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr float gravity = 9.81F;

std::vector<SpringPerMass> constants() {
  std::vector<SpringPerMass> all;
  for (const double stiffness : {200, 60, 8}) all.push_back(spring_per_mass({stiffness, 0.01}, 0.1, 0.002));
  return all;
}

TEST(BandRows, ShareTheirValues) {
  const BandLayout layout(GridPatch{2000, 3, 0.1}, 16);
  const BandRows band_rows(layout, constants(), gravity);
  const std::uint32_t* offsets = band_rows.offset_of_row();
  const std::set<std::uint32_t> different(offsets, offsets + layout.height);
  EXPECT_LE(different.size(), 4U) << "a few at the top, where a lane has no springs upwards, and at the end";
}

constexpr ColumnCosts zen4{1, 0.98, 256U << 10}, xeon{0.7, 0.97, 48U << 10};

/// Of vectors of 16 lanes.
std::size_t halves(std::uint32_t rows, std::uint32_t columns, const char* integrator, std::size_t threads,
                   const ColumnCosts& costs = ColumnCosts::here()) {
  return halves_for(BandLayout(GridPatch{rows, columns, 0.01}, 16), *find_integrator(integrator), 1, threads,
                    costs);
}

TEST(BandCut, FoldsAClothWhoseBandsAreLow) {
  for (const std::size_t threads : {1U, 2U}) {
    EXPECT_EQ(halves(50, 50, "semi-euler", threads), 2U);
    EXPECT_EQ(halves(100, 100, "semi-euler", threads), 2U);
  }
}

TEST(BandCut, TakesNoMoreStepsThanAPieceHasGhosts) {
  const Integrator &euler = *find_integrator("semi-euler"), &midpoint = *find_integrator("midpoint");
  // Two columns a stage on each side.
  EXPECT_EQ(steps_within(4, euler, 8), 4U);
  EXPECT_EQ(steps_within(4, euler, 7), 3U);
  EXPECT_EQ(steps_within(4, euler, 2), 1U);
  EXPECT_EQ(steps_within(2, midpoint, 7), 1U);
}

TEST(BandCut, TakesDoublesForTwiceTheBytes) {
  const Integrator& euler = *find_integrator("semi-euler");
  const auto layout = [](std::uint32_t rows, std::uint32_t columns, std::size_t bytes) {
    return BandLayout(GridPatch{rows, columns, 0.01}, 16, 1, bytes);
  };
  // Folded, 13 rows of 16 lanes: 24,960 bytes of floats in use, 49,920 of doubles.
  EXPECT_EQ(halves_for(layout(100, 100, 4), euler, 1, 1, xeon), 2U);
  EXPECT_EQ(halves_for(layout(100, 100, 8), euler, 1, 1, xeon), 1U);
  // Half of the last-level cache holds it in floats, 24 bytes a node, and not in doubles.
  const long found = sysconf(_SC_LEVEL3_CACHE_SIZE);
  const auto columns = static_cast<std::uint32_t>((found > 0 ? found : 16L << 20) / (500 * 64));
  EXPECT_EQ(steps_per_pass_for(layout(500, columns, 4), euler, 1), 1U);
  EXPECT_EQ(steps_per_pass_for(layout(500, columns, 8), euler, 1), stages_under_way);
}

TEST(BandCut, DoesNotFoldWhatWouldBeWalkedOverTwice) {
  EXPECT_EQ(halves(50, 50, "rk4", 2), 1U) << "the halves would recompute twelve columns each";
  EXPECT_EQ(halves(50, 50, "semi-euler", 12), 1U) << "two columns a thread and half";
  EXPECT_EQ(halves(50, 2, "semi-euler", 1), 1U);
}

TEST(BandCut, DoesNotFoldColumnsThatTheCacheDoesNotHold) {
  EXPECT_EQ(halves(10000, 700, "semi-euler", 1), 1U);
  EXPECT_EQ(halves(500, 700, "semi-euler", 1, xeon), 1U);
  EXPECT_EQ(halves(500, 700, "midpoint", 1, zen4), 1U) << "of several stages, the first-level cache";
}

TEST(BandCut, FoldsMoreWhereColumnsTakeLonger) {
  for (const std::size_t threads : {1U, 2U}) {
    EXPECT_EQ(halves(500, 700, "semi-euler", threads, zen4), 2U);
    EXPECT_EQ(halves(200, 200, "semi-euler", threads, zen4), 2U);
  }
}

TEST(BandCut, LeavesNoPartitionNarrowerThanWhatOthersReadOfIt) {
  for (const Integrator& integrator : integrators)
    for (const std::size_t steps : {1U, 2U, 4U})
      for (const std::size_t columns : {1U, 9U, 50U, 700U})
        for (const std::size_t threads : {1U, 2U, 64U}) {
          const std::size_t partitions = partitions_for(columns, threads, integrator, steps);
          ASSERT_GE(partitions, 1U);
          EXPECT_LE(partitions, threads);
          if (partitions > 1) {
            EXPECT_GE(columns / partitions, ghost_columns(integrator, steps));
          }
        }
}

/// What MPI is between processes, between threads.
class MailMessages final : public ColumnMessages {
 public:
  /// Null where no piece is on that side.
  MailMessages(BandGrid& bands, Mail* to_left, Mail* from_left, Mail* to_right, Mail* from_right)
      : bands_(bands),
        to_left_(to_left),
        from_left_(from_left),
        to_right_(to_right),
        from_right_(from_right) {}

  void begin() override {
    ++begun_;
    if (to_left_) to_left_->send(column(first(), bands_.own.first), floats());
    if (to_right_) to_right_->send(column(last(), bands_.own.end() - ghosts()), floats());
  }
  void advance() override {}
  void finish() override {
    ++finished_;
    if (from_left_) from_left_->receive(column(first(), bands_.own.first - ghosts()));
    if (from_right_) from_right_->receive(column(last(), bands_.own.end()));
  }
  bool is_balanced() const { return begun_ > 0 && begun_ == finished_; }

 private:
  BandPartition& first() { return bands_.partitions.front(); }
  BandPartition& last() { return bands_.partitions.back(); }
  std::size_t ghosts() const { return ghost_columns(*bands_.integrator, bands_.steps_per_pass); }
  std::size_t floats() const { return ghosts() * bands_.layout.column_floats(); }
  float* column(BandPartition& partition, std::size_t number) const {
    return partition.column(bands_.layout, Pair::state, number);
  }

  BandGrid& bands_;
  Mail *to_left_, *from_left_, *to_right_, *from_right_;
  int begun_ = 0, finished_ = 0;
};

struct Cut {
  std::size_t pieces, threads, steps_per_pass;
};

/// The state of a cloth after some steps in pieces, each by a thread of its own that knows nothing of the
/// others but what the mail brings.
State state_of_pieces(const SceneSpec& spec, const Integrator& integrator, const Cut& cut, int steps) {
  const auto& cloth = std::get<ClothSpec>(spec.content);
  const std::size_t ghosts = ghost_columns(integrator, cut.steps_per_pass);
  const StepKernel<BandGrid> kernel = step_kernels<BandGrid>(integrator).front();
  std::vector<Mail> to_right(cut.pieces), to_left(cut.pieces);
  State all;
  all.position.resize(std::size_t{cloth.rows} * cloth.columns);
  all.velocity = all.position;
  const auto step_piece = [&](std::size_t piece) {
    const ColumnRange own = part_of({0, cloth.columns}, piece, cut.pieces);
    const ColumnRange here = with_ghosts(own, ghosts, cloth.columns);
    System system = build_cloth_window(spec, {.row = 0,
                                              .column = static_cast<std::uint32_t>(here.first),
                                              .rows = cloth.rows,
                                              .columns = static_cast<std::uint32_t>(here.count)});
    round_start_to_single(system);
    BandGrid bands(
        system, std::get<GridPatch>(system.topology), integrator, backend_dt_of(integrator), kernel.lanes,
        cut.threads,
        {.steps_per_pass = cut.steps_per_pass, .piece = ColumnRange{own.first - here.first, own.count}});
    const bool left = piece > 0, right = piece + 1 < cut.pieces;
    MailMessages messages(bands, left ? &to_left[piece] : nullptr, left ? &to_right[piece - 1] : nullptr,
                          right ? &to_right[piece] : nullptr, right ? &to_left[piece + 1] : nullptr);
    bands.messages = &messages;
    bands.set_state(system.start);
    kernel.step(bands, steps / 2);  // in two calls: messages must not be under way between them
    kernel.step(bands, steps - steps / 2);
    EXPECT_TRUE(messages.is_balanced());
    const State state = bands.state();
    for (std::size_t row = 0; row < cloth.rows; ++row)
      for (std::size_t column = own.first; column < own.end(); ++column) {
        const std::size_t from = row * here.count + column - here.first, to = row * cloth.columns + column;
        all.position[to] = state.position[from];
        all.velocity[to] = state.velocity[from];
      }
  };
  std::vector<std::thread> threads;
  for (std::size_t piece = 0; piece < cut.pieces; ++piece) threads.emplace_back(step_piece, piece);
  for (std::thread& thread : threads) thread.join();
  return all;
}

TEST(BandGrid, IsFilledByNoMoreThreadsThanWalkIt) {
  const System system = cloth_system(40, 60);
  const auto fill = [&] {
    BandGrid bands(system, std::get<GridPatch>(system.topology), *find_integrator("semi-euler"), backend_dt_s,
                   8, 1, {.steps_per_pass = 1, .piece = ColumnRange{10, 40}});
    EXPECT_EQ(bands.threads, 1U);
    EXPECT_EQ(bands.partitions.size(), 3U);  // two are edges
    const auto running = [] {
      return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
    };
    const auto before = running();
    bands.set_state(system.start);
    EXPECT_EQ(running(), before);
  };
  std::thread(fill).join();  // it has no threads of an earlier team
}

class EachIntegratorInPieces : public testing::TestWithParam<std::string_view> {};

TEST_P(EachIntegratorInPieces, GivesTheBitsOfTheWhole) {
  const Integrator& integrator = *find_integrator(GetParam());
  const std::size_t most_steps = stages_under_way / integrator.stage_count;
  constexpr int steps = 21;
  for (const auto& [rows, columns] : {std::pair{37U, 70U}, {9U, 67U}, {50U, 101U}}) {
    SceneSpec spec = cloth_spec(rows, columns);
    const System system = build_system(spec);
    const State expected =
        state_after(*make_openmp(system, integrator, backend_dt_of(integrator), {1, ""}), steps);
    EXPECT_NE(expected.position, system.start.position);
    for (const Cut& cut : {Cut{2, 1, 1}, Cut{3, 2, 1}, Cut{7, 1, 1}, Cut{8, 1, 1}, Cut{2, 1, most_steps},
                           Cut{4, 2, most_steps}}) {
      SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(columns) + ", " +
                   std::to_string(cut.pieces) + " pieces, " + std::to_string(cut.threads) + " threads, " +
                   std::to_string(cut.steps_per_pass) + " steps a pass");
      if (columns / cut.pieces < ghost_columns(integrator, cut.steps_per_pass)) continue;
      EXPECT_TRUE(same_state(state_of_pieces(spec, integrator, cut, steps), expected));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EachIntegratorInPieces, testing::ValuesIn(names_of(integrators)), ByName());

}  // namespace
}  // namespace mssim
