// The walk over a banded cloth: stages follow each other, partitions are adjacent, with ghosts between them.
// Compiled for the integrators of MSSIM_STAGES, in MSSIM_REAL.
#include "backends/vectors/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_bands.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "backends/openmp/column_walk-inl.h"
#include "backends/threads/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
inline namespace MSSIM_PRECISION {

/// Copies half a vector `count` times; the sources are from_stride numbers apart, the targets to_stride.
HWY_INLINE void copy_half(Real* to, std::size_t to_stride, const Real* from, std::size_t from_stride,
                          std::size_t count) {
  const hn::Half<RealTag> d;
  for (std::size_t n = 0; n < count; ++n)
    hn::Store(hn::Load(d, from + n * from_stride), d, to + n * to_stride);
}

/// Copies the ghost columns of a pass at one side of a partition, in one half, from the adjacent partition,
/// as soon as they are available. Adds the time to `waited` if it was long.
HWY_NOINLINE inline void take_ghosts(const BandLayout& layout, BandPartitionOf<Real>& partition,
                                     EdgeColumns<Real>& edge, std::size_t first, std::size_t half,
                                     std::uint64_t pass, TeamGain::Duration& waited) {
  edge.pass.wait_for(pass, waited);
  for (std::size_t i = 0; i < partition.ghosts; ++i) {
    Real* to = partition.column(layout, Pair::state, first + i) + layout.offset(0);
    const Real* from = edge.column(layout, pass, i);
    if (layout.halves == 1)
      std::memcpy(to, from, EdgeColumns<Real>::column_floats(layout) * sizeof(Real));
    else
      copy_half(to + half * layout.bands, layout.lanes, from, layout.bands,
                layout.height * BandLayout::components);
  }
}

/// Copies the ghost columns of a pass at the cut between the halves of a folded partition: each half gets, in
/// its own lanes, the columns at the other one's end.
HWY_NOINLINE inline void take_ghosts_of_halves(const BandLayout& layout, BandPartitionOf<Real>& partition) {
  const auto copy = [&](std::size_t to, std::size_t to_half, std::size_t from) HWY_ATTR {
    const auto lanes_of = [&](std::size_t column, std::size_t half) HWY_ATTR {
      return partition.column(layout, Pair::state, column) + layout.offset(0) + half * layout.bands;
    };
    copy_half(lanes_of(to, to_half), layout.lanes, lanes_of(from, 1 - to_half), layout.lanes,
              layout.height * BandLayout::components);
  };
  const std::size_t end = partition.end();
  for (std::size_t i = 0; i < partition.ghosts; ++i) {
    copy(partition.first - partition.ghosts + i, 1, end - partition.ghosts + i);
    copy(end + i, 0, partition.first + i);
  }
}

/// Prefetches the memory at an edge of a partition, a few lines at a time during the walk: the lines to be
/// read, and those to be written, which the adjacent thread has read, are in that thread's cache. A core has
/// few outstanding requests, which its own columns need too, so all requests at once would delay the walk.
/// Time of a step with two threads on an Intel Xeon, relative to all requests two columns ahead or at the
/// start of a pass: 0.93 at 50 x 50, 0.97 at 100 x 100, 0.98 at 200 x 200.
class EdgeAhead {
 public:
  /// `mine`: the edge for the adjacent partition, from which `theirs` is read in a pass.
  HWY_INLINE EdgeAhead(const BandLayout& layout, EdgeColumns<Real>& mine, EdgeColumns<Real>& theirs,
                       std::uint64_t pass)
      : write_(mine.column(layout, pass + 1, 0)),
        read_(theirs.column(layout, pass, 0)),
        theirs_(&theirs),
        pass_(pass) {}
  EdgeAhead() = default;  ///< at an end of the cloth: no prefetch

  /// Prefetches `floats` more numbers, of `all`, once the other thread has published the data to be read: it
  /// has then also read the data to be overwritten.
  HWY_INLINE void ask(std::size_t floats, std::size_t all) {
    constexpr std::size_t line_floats = 64 / sizeof(Real);
    if (!theirs_ || asked_ >= all || !theirs_->pass.has_reached(pass_)) return;
    for (const std::size_t end = std::min(all, asked_ + floats); asked_ < end; asked_ += line_floats) {
      ask_to_write(write_ + asked_);
      hwy::Prefetch(read_ + asked_);
    }
  }

 private:
  static HWY_INLINE void ask_to_write(const Real* line) {
#if HWY_ARCH_X86
    asm volatile("prefetchw %0" : : "m"(*line));
#else
    __builtin_prefetch(line, 1);
#endif
  }

  Real* write_ = nullptr;
  const Real* read_ = nullptr;
  const EdgeColumns<Real>* theirs_ = nullptr;
  std::uint64_t pass_ = 0;
  std::size_t asked_ = 0;
};

/// Copies a complete column of a partition if it is a ghost of another one in the next pass.
HWY_INLINE void leave_column(const BandLayout& layout, BandPartitionOf<Real>& partition, std::size_t column,
                             std::uint64_t pass) {
  const auto leave = [&](EdgeColumns<Real>& edge, std::size_t number, std::size_t half) HWY_ATTR {
    Real* to = edge.column(layout, pass + 1, number);
    const Real* from = partition.column(layout, Pair::state, column) + layout.offset(0);
    if (layout.halves == 1)
      std::memcpy(to, from, EdgeColumns<Real>::column_floats(layout) * sizeof(Real));
    else
      copy_half(to, layout.bands, from + half * layout.bands, layout.lanes,
                layout.height * BandLayout::components);
    if (number + 1 == partition.ghosts) edge.pass.reach(pass + 1);
  };
  const std::size_t number = column - partition.first, behind = partition.end() - column;
  if (number < partition.ghosts && partition.left.exists()) leave(partition.left, number, 0);
  if (behind <= partition.ghosts && partition.right.exists())
    leave(partition.right, partition.ghosts - behind, layout.halves - 1);
}

/// Resets the pins of a newly written column in every pair that the stage has written and that a later stage,
/// or the next step's first, gathers.
template <std::size_t method, std::size_t stage>
HWY_INLINE void put_pins_back(const BandLayout& layout, BandPartitionOf<Real>& partition,
                              std::size_t column) {
  const auto put_back = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) MSSIM_INLINE_LAMBDA {
    constexpr Pair pair = static_cast<Pair>(i), stored = walk_writes_to(integrators[method], stage, pair);
    if constexpr (writes_to_gather(integrators[method], stage, pair))
      for (const PlacedPin<Real>& pin : partition.pins[partition.local(column)])
        for (std::size_t k = 0; k < 3; ++k) {
          Real* component = partition.column(layout, stored, column) + pin.offset + k * lane_count();
          component[0] = pin.position[k];
          component[3 * lane_count()] = 0;
        }
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) MSSIM_INLINE_LAMBDA {
    (put_back(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<pair_kinds>{});
}

/// Forces on a stage's current column and on the next one, as in ColumnView.
using ForcesUnderWay = std::array<Real*, 2>;

/// One of the active stages in a partition.
struct StageUnderWay {
  std::size_t begin, end;  ///< columns that it updates
  ForcesUnderWay forces;
};

/// The view of a column for a stage that gathers `gather`.
HWY_NOINLINE inline ColumnView view_of(const BandLayout& layout, BandPartitionOf<Real>& partition,
                                       const StageUnderWay& under_way, Pair gather, std::size_t column) {
  const std::size_t to_row_0 = layout.offset(0);
  ColumnView view;
  view.rows = partition.column_rows[partition.local(column)];
  view.here = partition.column(layout, gather, column) + to_row_0;
  view.next = partition.column(layout, gather, column + 1) + to_row_0;
  view.next_2 = partition.column(layout, gather, column + 2) + to_row_0;
  for (std::size_t i = 0; i < pair_kinds; ++i)
    view.pairs[i] = partition.pairs[i].size() == 0
                        ? nullptr
                        : partition.column(layout, static_cast<Pair>(i), column) + to_row_0;
  view.forces_here = under_way.forces[0];
  view.forces_next = under_way.forces[1];
  return view;
}

/// Executes the stage in one column, if it updates that or one of the next two, on which its springs act.
template <std::size_t method, std::size_t stage>
HWY_INLINE void walk_stage(const BandGridOf<Real>& bands, BandPartitionOf<Real>& partition,
                           StageUnderWay& under_way, std::size_t column) {
  const BandLayout& layout = bands.layout;
  constexpr Pair gather =
      storage_of(integrators[method], integrators[method].stages[stage].gather, Storage::in_place);
  const ColumnView view = view_of(layout, partition, under_way, gather, column);
  const std::size_t behind = bands.columns - 1 - column;
  if (column + 2 == under_way.begin)
    walk_column_before<right_2>(bands, view);
  else if (column + 1 == under_way.begin)
    walk_column_before<to_next_column | right_2>(bands, view);
  else if (behind >= BandLayout::halo)
    walk_inner_column<method, stage>(bands, view);
  else
    walk_last_column<method, stage>(bands, view, behind);
  if (column >= under_way.begin) put_pins_back<method, stage>(layout, partition, column);
  std::swap(under_way.forces[0], under_way.forces[1]);
}

/// The first `count` stages of a pass over a partition, before its first column.
inline std::array<StageUnderWay, stages_under_way> stages_of_pass(const BandGridOf<Real>& bands,
                                                                  BandPartitionOf<Real>& partition,
                                                                  std::size_t count) {
  std::array<StageUnderWay, stages_under_way> stages;
  for (std::size_t i = 0; i < count; ++i) {
    // Includes the neighbours' columns that later stages need.
    const std::size_t reach = BandLayout::halo * (count - 1 - i);
    stages[i].begin = partition.first - std::min(partition.first, reach);
    stages[i].end = std::min(partition.end() + reach, bands.columns);
    for (std::size_t f = 0; f < 2; ++f)
      stages[i].forces[f] = partition.forces.data() + (2 * i + f) * bands.layout.force_floats();
    std::memset(stages[i].forces[0], 0, 2 * bands.layout.force_floats() * sizeof(Real));
  }
  return stages;
}

/// A thread's pass over partitions.
struct BandPass {
  std::uint64_t number;        ///< index among all passes over the cloth
  std::size_t steps;           ///< steps in this pass
  TeamGain::Duration& waited;  ///< see take_ghosts
};

/// Takes the steps of a pass over the columns of a partition, one stage after the other. `messages` progress
/// meanwhile (null: none). `handed_on`: null, or, for the thread that walks over all partitions, the forces
/// left by the previous partition, if any, and by this one; with one active stage in a cloth that is not
/// folded they replace recomputing the columns before this partition.
///
/// Columns of other partitions from the previous pass are read as late as possible, and own columns are
/// published as soon as they are complete. No set is overwritten while it is read: a thread that publishes
/// columns for a pass has seen those that the reader published in the previous pass, after reading the same
/// set.
template <std::size_t method>
HWY_INLINE void walk_partition(BandGridOf<Real>& bands, std::size_t p, const BandPass& pass,
                               ColumnMessages* messages, std::optional<ForcesUnderWay>* handed_on) {
  constexpr std::size_t stages = integrators[method].stage_count, distance = BandLayout::halo;
  const std::size_t count = pass.steps * stages;
  BandPartitionOf<Real>& partition = bands.partitions[p];
  std::array<StageUnderWay, stages_under_way> under_way = stages_of_pass(bands, partition, count);
  const bool goes_on = handed_on && *handed_on && count == 1 && bands.layout.halves == 1;
  if (goes_on) under_way[0].forces = **handed_on;
  const std::size_t start =
      goes_on ? partition.first : under_way[0].begin - std::min(under_way[0].begin, distance);
  const std::size_t end = under_way[count - 1].end + distance * (count - 1);
  const std::size_t own_end = partition.end();
  constexpr std::size_t columns_an_advance = 8;  // some microseconds
  const bool has_next = p + 1 < bands.partitions.size();
  // Edges of the next pass and of this one; both within two thirds of the columns.
  EdgeAhead left_ahead, right_ahead;
  if (p > 0 && !handed_on)
    left_ahead = EdgeAhead(bands.layout, partition.left, bands.partitions[p - 1].right, pass.number + 1);
  if (has_next && !handed_on)
    right_ahead = EdgeAhead(bands.layout, partition.right, bands.partitions[p + 1].left, pass.number);
  const std::size_t edge_floats = partition.ghosts * EdgeColumns<Real>::column_floats(bands.layout);
  const std::size_t floats_ahead = edge_floats * 3 / (2 * partition.count) + 1;
  if (bands.layout.halves > 1) take_ghosts_of_halves(bands.layout, partition);
  if (p > 0 && !goes_on)
    take_ghosts(bands.layout, partition, bands.partitions[p - 1].right, partition.first - partition.ghosts, 0,
                pass.number, pass.waited);
  for (std::size_t head = start; head < end; ++head) {
    if (messages && head % columns_an_advance == 0) messages->advance();
    if (head >= partition.first) {
      left_ahead.ask(floats_ahead, edge_floats);
      right_ahead.ask(floats_ahead, edge_floats);
    }
    // Before any of the last own columns is published.
    if (has_next && head + partition.ghosts == own_end)
      take_ghosts(bands.layout, partition, bands.partitions[p + 1].left, own_end, bands.layout.halves - 1,
                  pass.number, pass.waited);
    for (std::size_t step = 0; step < pass.steps; ++step)
      for_each_stage<method>([&](auto stage) HWY_ATTR {
        const std::size_t i = step * stages + stage, behind = distance * i;
        if (head < behind + (under_way[i].begin - std::min(under_way[i].begin, distance)) ||
            head >= behind + under_way[i].end)
          return;
        walk_stage<method, stage>(bands, partition, under_way[i], head - behind);
      });
    const std::size_t behind = distance * (count - 1);
    if (head >= behind + partition.first && head < behind + own_end)
      leave_column(bands.layout, partition, head - behind, pass.number);
  }
  if (handed_on) *handed_on = under_way[0].forces;
}

/// Passes between meetings of a cloth's threads, which check whether several threads pay off: enough to make
/// meetings a small fraction of the time.
HWY_INLINE std::size_t passes_between_meetings(const BandGridOf<Real>& bands) {
  constexpr std::size_t updates = 100'000;  // node updates: about a tenth of a millisecond
  const std::size_t of_a_pass = bands.layout.rows * bands.layout.halves * bands.own.count *
                                bands.steps_per_pass * bands.integrator->stage_count;
  return std::max<std::size_t>(1, updates / std::max<std::size_t>(1, of_a_pass));
}

template <std::size_t method>
HWY_INLINE void step_method(BandGridOf<Real>& bands, std::size_t count) {
  // Every thread computes its own columns completely: the order of every sum depends only on the cloth, and
  // the result is bitwise identical for any number of threads and processes.
  const std::size_t partitions = bands.partitions.size();
  const bool has_edges = bands.threads < partitions;
  const std::size_t passes = (count + bands.steps_per_pass - 1) / bands.steps_per_pass;
  // Every stride-th inner partition from `first` on; the first thread walks the edges before.
  const auto walk = [&](std::size_t first, std::size_t stride, std::size_t pass,
                        TeamGain::Duration& waited) HWY_ATTR {
    const BandPass its{bands.passes + pass,
                       std::min(bands.steps_per_pass, count - pass * bands.steps_per_pass), waited};
    std::optional<ForcesUnderWay> forces;
    const auto walk_one =
        [&](std::size_t p, ColumnMessages* messages, std::optional<ForcesUnderWay>* handed_on = nullptr)
            HWY_ATTR { walk_partition<method>(bands, p, its, messages, handed_on); };
    ColumnMessages* const messages = first == 0 ? bands.messages : nullptr;
    if (messages && pass > 0) messages->finish();
    if (messages && has_edges) {
      if (bands.first_inner > 0) walk_one(0, nullptr);
      if (bands.first_inner + bands.threads < partitions) walk_one(partitions - 1, nullptr);
      messages->begin();
    }
    for (std::size_t p = first; p < bands.threads; p += stride)
      walk_one(bands.first_inner + p, messages, stride == 1 ? &forces : nullptr);
    if (messages && !has_edges) messages->begin();
  };
  const auto pass_alone = [&](std::size_t pass) HWY_ATTR {
    if (pass >= passes) return false;
    TeamGain::Duration waited{};
    walk(0, 1, pass, waited);
    return true;
  };
  const std::size_t begin = bands.team_gain.take_rounds(pass_alone);
  const std::size_t between_meetings = passes_between_meetings(bands);
  // Other threads wait until all have started, and until all have ended: in a call of a few passes on a busy
  // machine that may be all of the time.
  using Clock = TeamGain::Clock;
  const Clock::time_point call = Clock::now();
  Clock::time_point first_has_ended = call;
  TeamGain::Duration first_waited{};
  const auto take_passes = [&](const Team& team) HWY_ATTR {
    TeamGain::Duration waited{};
    const bool is_first_of_several = team.threads > 1 && team.thread == 0;
    if (is_first_of_several) waited = Clock::now() - call;
    std::size_t before_meeting = between_meetings;
    for (std::size_t pass = begin; pass < passes; ++pass) {
      walk(team.thread, team.threads, pass, waited);
      if (team.threads == 1 || --before_meeting > 0) continue;
      pass +=
          team.end_round([&](std::size_t taken) HWY_ATTR { return pass_alone(pass + 1 + taken); }, waited);
      waited = {};
      before_meeting = between_meetings;
    }
    if (is_first_of_several) {
      first_has_ended = Clock::now();
      first_waited = waited;
    }
  };
  if (begin < passes) with_team(bands.threads, take_passes, bands.team_gain, call);
  if (first_has_ended != call) {
    bands.team_gain.add_wait(first_waited + (Clock::now() - first_has_ended));
    bands.team_gain.begins_alone(static_cast<TeamGain::Duration::rep>(bands.threads), &Clock::now);
  }
  if (bands.messages && passes > 0) bands.messages->finish();
  bands.passes += passes;
}

template <std::size_t stages>
void step_bands(BandGridOf<Real>& bands, int count) {
  with_integrator(*bands.integrator, [&](auto method) HWY_ATTR {
    if constexpr (Stages<stages>::have(integrators[method]))
      step_method<method>(bands, static_cast<std::size_t>(count));
  });
}

namespace {
StepKernel<BandGridOf<Real>> band_kernel() { return kernel_here(&step_bands<MSSIM_STAGES>); }
}  // namespace

}  // namespace MSSIM_PRECISION
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
MSSIM_COMPILED_KERNELS(BandGridOf<MSSIM_REAL>, band_kernel)
}  // namespace mssim
#endif
