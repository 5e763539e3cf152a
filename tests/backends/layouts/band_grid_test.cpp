#include "backends/layouts/band_grid.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "backends/openmp/openmp.h"
#include "backends/vectors/step_kernels.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "scene/builders.h"
#include "scene/scene_kinds.h"
#include "tests/support/backend_checks.h"
#include "tests/support/mail.h"

namespace mssim {
namespace {

constexpr float gravity = 9.81F;

std::vector<SpringPerMass> constants() {
  std::vector<SpringPerMass> all;
  for (const double stiffness : {200, 60, 8}) all.push_back(spring_per_mass({stiffness, 0.01}, 0.1, 0.002));
  return all;
}

/// Expects the constants of every spring that is there, and zeros for the others.
void expect_springs_of_cloth(const BandLayout& layout, ColumnsToEnd to_end) {
  const std::vector<SpringPerMass> springs = constants();
  const BandRows band_rows(layout, springs, gravity, to_end);
  const std::size_t lanes = layout.lanes;
  const auto halo = static_cast<std::ptrdiff_t>(BandLayout::halo);
  const auto height = static_cast<std::ptrdiff_t>(layout.height);
  const auto is_there = [&](std::ptrdiff_t row, std::size_t columns_behind, std::size_t half) {
    return row >= 0 && row < static_cast<std::ptrdiff_t>(layout.rows) && columns_behind < to_end[half];
  };
  for (std::ptrdiff_t row = -halo; row < height + halo; ++row) {
    const float* of_row = band_rows.values() + band_rows.offset_of_row()[row];
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t half = lane / layout.bands;
      const std::ptrdiff_t of_cloth = static_cast<std::ptrdiff_t>(lane % layout.bands) * height + row;
      EXPECT_EQ(of_row[BandRows::gravity_vector * lanes + lane], is_there(of_cloth, 0, half) ? gravity : 0);
      for (std::size_t i = 0; i < grid_stencil.size(); ++i) {
        const auto columns = static_cast<std::size_t>(grid_stencil[i].columns);
        const bool exists =
            is_there(of_cloth, 0, half) && is_there(of_cloth + grid_stencil[i].rows, columns, half);
        const SpringPerMass& spring = springs[grid_stencil[i].kind];
        const float* found = of_row + i * BandRows::spring_vectors * lanes + lane;
        for (const float number :
             {spring.constants.stiffness, spring.constants.damping, spring.stiffness_rest}) {
          EXPECT_EQ(*found, exists ? number : 0) << "row " << row << ", spring " << i;
          found += lanes;
        }
      }
    }
  }
}

TEST(BandRows, HaveConstantsWhereThereIsASpring) {
  for (const std::uint32_t rows : {1U, 2U, 9U, 50U, 100U, 500U})
    for (const std::size_t lanes : {1U, 4U, 8U, 16U}) {
      SCOPED_TRACE(std::to_string(rows) + " rows, " + std::to_string(lanes) + " lanes");
      expect_springs_of_cloth(BandLayout(GridPatch{rows, 3, 0.1}, lanes),
                              {BandRows::far_from_end, BandRows::far_from_end});
    }
}

TEST(BandRows, OfAFoldedClothHaveNoneWhereOneHalfEnds) {
  for (const std::uint32_t rows : {1U, 9U, 100U})
    for (const std::size_t lanes : {2U, 4U, 16U})
      for (std::size_t to_end = 0; to_end <= BandRows::far_from_end; ++to_end) {
        SCOPED_TRACE(std::to_string(rows) + " rows, " + std::to_string(lanes) +
                     " lanes, columns to the end: " + std::to_string(to_end));
        const BandLayout folded(GridPatch{rows, 9, 0.1}, lanes, 2);
        expect_springs_of_cloth(folded, {BandRows::far_from_end, to_end});
        expect_springs_of_cloth(folded, {to_end, BandRows::far_from_end});
      }
}

TEST(BandRows, ShareTheirValues) {
  const BandLayout layout(GridPatch{2000, 3, 0.1}, 16);
  const BandRows band_rows(layout, constants(), gravity);
  const std::uint32_t* offsets = band_rows.offset_of_row();
  const std::set<std::uint32_t> different(offsets, offsets + layout.height);
  EXPECT_LE(different.size(), 4U) << "a few at the top, where a lane has no springs upwards, and at the end";
}

/// Of vectors of 16 lanes.
std::size_t halves(std::uint32_t rows, std::uint32_t columns, const char* integrator, std::size_t threads) {
  return halves_for(BandLayout(GridPatch{rows, columns, 0.01}, 16), *find_integrator(integrator), 1, threads);
}

TEST(BandCut, FoldsAClothWhoseBandsAreLow) {
  for (const std::size_t threads : {1U, 2U}) {
    EXPECT_EQ(halves(50, 50, "semi-euler", threads), 2U);
    EXPECT_EQ(halves(100, 100, "semi-euler", threads), 2U);
  }
}

TEST(BandCut, DoesNotFoldWhatWouldBeWalkedOverTwice) {
  EXPECT_EQ(halves(50, 50, "rk4", 2), 1U) << "the halves would recompute twelve columns each";
  EXPECT_EQ(halves(50, 50, "semi-euler", 12), 1U) << "two columns a thread and half";
  EXPECT_EQ(halves(50, 2, "semi-euler", 1), 1U);
}

TEST(BandCut, DoesNotFoldColumnsThatTheCacheDoesNotHold) {
  EXPECT_EQ(halves(10000, 700, "semi-euler", 1), 1U);
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

class EachIntegratorInPieces : public testing::TestWithParam<std::string_view> {};

TEST_P(EachIntegratorInPieces, GivesTheBitsOfTheWhole) {
  const Integrator& integrator = *find_integrator(GetParam());
  const std::size_t most_steps = stages_under_way / integrator.stage_count;
  constexpr int steps = 21;
  for (const auto& [rows, columns] : {std::pair{37U, 70U}, {9U, 67U}, {50U, 101U}}) {
    SceneSpec spec = cloth_spec(rows, columns);
    const System system = build_system(spec);
    const auto whole = make_openmp(system, integrator, backend_dt_of(integrator), {1, ""});
    whole->step(steps);
    const State expected = whole->state();
    EXPECT_NE(expected.position, system.start.position);
    for (const Cut& cut : {Cut{2, 1, 1}, Cut{3, 2, 1}, Cut{7, 1, 1}, Cut{8, 1, 1}, Cut{2, 1, most_steps},
                           Cut{4, 2, most_steps}}) {
      SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(columns) + ", " +
                   std::to_string(cut.pieces) + " pieces, " + std::to_string(cut.threads) + " threads, " +
                   std::to_string(cut.steps_per_pass) + " steps a pass");
      if (columns / cut.pieces < ghost_columns(integrator, cut.steps_per_pass)) continue;
      const State state = state_of_pieces(spec, integrator, cut, steps);
      EXPECT_TRUE(same_state(state, expected));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EachIntegratorInPieces, testing::ValuesIn(names_of(integrators)), ByName());

TEST(ColumnRange, PartsCoverAllColumnsOnce) {
  for (const std::size_t parts : {1U, 2U, 3U, 7U, 10U}) {
    std::size_t next = 5;
    for (std::size_t part = 0; part < parts; ++part) {
      const ColumnRange range = part_of({5, 10}, part, parts);
      EXPECT_EQ(range.first, next);
      EXPECT_GE(range.count, 10 / parts);
      EXPECT_LE(range.count, (10 + parts - 1) / parts);
      next = range.end();
    }
    EXPECT_EQ(next, 15U);
  }
}

TEST(ColumnRange, GhostsEndWhereTheClothEnds) {
  const ColumnRange left = with_ghosts({0, 10}, 4, 30), inner = with_ghosts({10, 10}, 4, 30);
  EXPECT_EQ(left.first, 0U);
  EXPECT_EQ(left.count, 14U);
  EXPECT_EQ(inner.first, 6U);
  EXPECT_EQ(inner.count, 18U);
  EXPECT_EQ(with_ghosts({20, 10}, 4, 30).end(), 30U);
}

}  // namespace
}  // namespace mssim
