#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/node_arrays.h"
#include "backends/layouts/spring_graph.h"
#include "backends/threads/team_gain.h"
#include "model/system.h"

namespace mssim {

/// A spring as the compliant constraint C = l - L of XPBD (M. Macklin, M. Müller, N. Chentanez, 2016), in a
/// substep of h seconds from x, v, which starts at the predicted positions y = x + h v. One iteration, as M.
/// Macklin et al. (2019) recommend, begins at lambda = 0; their Eq. 26 is then
///
///     dlambda = (-C - gamma n.(p2 - p1)) / ((1 + gamma) (w1 + w2) + alpha~),
///
/// n = (y2 - y1)/l, p = y - x, w: inverse mass, alpha~ = 1/(k h^2). The dissipation potential of a damping c
/// is c (dC/dt)^2 / 2, so beta~ = c h^2 and gamma = alpha~ beta~ / h = c/(k h). By Eq. 17 y1 changes by
/// -w1 dlambda n and y2 by the opposite. With p = h v, and all multiplied by k h^2, the velocity v1 changes
/// by
///
///     w1 h (k C + c n.(v2 - v1)) n / (1 + (h^2 k + h c) (w1 + w2)):
///
/// the force of kernels/spring_law.h at (y, v), for h seconds, divided by its own change in that time. So the
/// same law gives the impulse, with other constants; velocities carry the displacements, which single
/// precision would lose in differences of positions; and a spring without stiffness is no special case.
///
/// Returns the spring for which the law's pull is that impulse divided by the vector to the other end, kg/s.
/// Its constants, h k / (1 + ...) and h c / (1 + ...), are finite for all nonnegative k and c. rest_length in
/// m; h_s: the substep; mobility: w1 + w2, 1/kg, 0 for a held end.
template <class Real>
LinearSpring<Real> compliant_spring(const SpringMaterial& material, double rest_length, double h_s,
                                    double mobility) {
  const double impulse_per_force =
      h_s / (1 + (h_s * h_s * material.stiffness + h_s * material.damping) * mobility);
  return spring_from<Real>([=](double number) { return number * impulse_per_force; },
                           linear_spring(material, rest_length));
}

/// The colours of a cloth, in order: springs along rows, then those between the rows of a pair, then bending
/// springs across rows. In that order a walk down the rows can execute all colours of a row that do not
/// depend on later rows (BlockLevel in step_constraints.cpp), and no colour needs its own pass over the
/// cloth.
enum ClothColour : std::uint8_t {
  structural_from_even_columns,
  structural_from_odd_columns,
  bending_from_columns_01,  ///< from columns 0 and 1 of every four
  bending_from_columns_23,
  structural_below_even_rows,
  falling_below_even_rows,  ///< shear springs down and to the right
  rising_below_even_rows,   ///< shear springs up and to the right
  structural_below_odd_rows,
  falling_below_odd_rows,
  rising_below_odd_rows,
  bending_below_rows_01,  ///< from rows 0 and 1 of every four
  bending_below_rows_23,
  cloth_colours
};

/// The springs of a cloth or of bodies in the order of xpbd, for every backend: the order is part of the
/// method. A cloth has the colours of ClothColour, including empty ones; bodies have those of colour_springs.
SpringColouring spring_order(const System& system);

/// The substeps of a system, for steps in numbers of type Real.
template <class Real>
struct SmallSteps {
  double small_s;        ///< the substep, s
  Real h_s;              ///< the same in that precision, s
  Real lost;             ///< fraction of the velocity that air damping takes per substep
  Real fall;             ///< m/s, gain by gravity per substep, damped
  std::size_t substeps;  ///< per step
  SurroundingsOf<Real> surroundings;

  SmallSteps(const System& system, double dt_s)
      : small_s(dt_s / system.solver.substeps),
        h_s(static_cast<Real>(small_s)),
        lost(static_cast<Real>(small_s * system.viscous_damping / (1 + small_s * system.viscous_damping))),
        fall(static_cast<Real>(small_s * system.gravity / (1 + small_s * system.viscous_damping))),
        substeps(system.solver.substeps),
        surroundings(surroundings_of<Real>(system)) {}
};

/// Storage of the nodes of a cloth: the columns of a row in four streams, by the column's number modulo four,
///     [row][column % 4][x y z u v w][column / 4]      (u v w: velocity).
///
/// The springs of a colour (ClothColour) that begin in one stream all end in one stream, of the same row or
/// of another: a vector of each, beginning at the same position or one node further, has the ends of as many
/// springs. So no shuffle or gather is needed. Each component begins a vector.
struct QuarterLayout {
  static constexpr std::size_t streams = 4, components = 6;

  std::size_t lanes, rows, columns;
  std::size_t pitch;  ///< floats from one component of a stream to the next, an odd number of vectors

  QuarterLayout(const GridPatch& grid, std::size_t lane_count)
      : lanes(lane_count),
        rows(grid.rows),
        columns(grid.columns),
        pitch(odd_pitch((columns + streams - 1) / streams, lanes)) {}

  std::size_t row_floats() const { return streams * components * pitch; }
  /// Floats from the start to the x of a node.
  std::size_t offset(std::size_t row, std::size_t column) const {
    return row * row_floats() + column % streams * components * pitch + column / streams;
  }
  /// Nodes of a stream with a node of their row `right` columns further: springs that begin in it.
  std::size_t springs(std::size_t stream, std::size_t right) const {
    const std::size_t end = stream + right;
    return end < columns ? (columns - end - 1) / streams + 1 : 0;
  }
};

/// A cloth, for vectors of springs of a colour.
struct QuarteredRows : SmallSteps<float> {
  static constexpr std::size_t block_rows = 4;  ///< rows per block of a pass
  QuarterLayout layout;
  AlignedArray nodes;  ///< [QuarterLayout::row_floats] for each row; padding is zero
  AlignedArray rest;   ///< in the same places, their rounding errors (carried_sum-inl.h)
  /// [1 + rows with pins][streams][pitch] 1 if a node may move, 0 for pins and padding.
  AlignedArray free;
  std::vector<const float*> free_of_row;  ///< [rows] into `free`; its start if the row has no pin

  /// By GridSpringKind, between free nodes and between a free one and a pin; divided by the mass of a node,
  /// so the impulse on a free end is its change of velocity.
  std::vector<LinearSpring<float>> of_free, of_pinned;
  std::size_t threads = 1;
  std::size_t depth = 1;  ///< substeps per pass over the cloth
  TeamGain team_gain;

  /// Lays out a cloth. Set a state before the first step. Throws Unsupported if the nodes differ in mass.
  QuarteredRows(const System& system, double dt_s, std::size_t lanes, std::size_t thread_count);
  void set_state(const State& state);
  State state() const;
  std::size_t blocks() const { return (layout.rows + block_rows - 1) / block_rows; }
  bool has_pins(std::size_t row) const { return free_of_row[row] != free.data(); }
};

/// Bodies for vectors of `lanes` springs of a colour: the nodes as records (node_arrays.h), renumbered so
/// that neighbours are near each other (reverse Cuthill-McKee), and the springs interleaved. Unconnected
/// components are stepped separately, in parts, each of which stays in a thread's cache for all substeps of a
/// call.
struct SpringBatches : SmallSteps<float> {
  /// Springs of a colour with the same constants, in vectors [begin, end) of `springs`.
  struct Batch {
    std::size_t begin, end;
    SpringConstants<float> constants;       ///< those of compliant_spring
    float first_mobility, second_mobility;  ///< 1/kg
  };
  /// Vectors [begin, end) of nodes and colours [first_colour, end_colour) of one or several bodies.
  struct Part {
    std::size_t begin, end;
    std::size_t first_colour, end_colour;
  };

  std::size_t lanes = 0;
  std::vector<std::uint32_t> slot;  ///< [nodes] record of the scene's node
  AlignedArray nodes;               ///< [slots][record_floats]
  AlignedArray rest;  ///< [slots / lanes][x y z u v w][lanes] their rounding errors (carried_sum-inl.h)
  AlignedArray free;  ///< [slots] 1 if a node may move, 0 for pins and padding
  /// [vectors][3][lanes] offsets of the records of both ends, in units of offset_floats and as std::uint32_t,
  /// then the stiffness_rest of compliant_spring. The last vector of a batch repeats its last spring, which
  /// writes the same result again.
  AlignedArray springs;
  static constexpr std::size_t offset_floats = record_floats, rest_components = 6;
  std::vector<Batch> batches;
  std::vector<IndexRange> colours;  ///< the batches of each
  std::vector<Part> parts;

  std::size_t threads = 1;
  std::vector<std::vector<std::size_t>> own_parts;  ///< [threads] parts of one thread alone
  std::vector<std::size_t> shared_parts;            ///< parts of all threads together, colour by colour

  TeamGain team_gain;  ///< for the threads that share parts

  /// With at most `thread_count` threads. Set a state before the first step.
  SpringBatches(const System& system, double dt_s, std::size_t lane_count, std::size_t thread_count);
  void set_state(const State& state);
  State state() const;

  std::size_t vectors(const IndexRange& colour) const {
    return batches[colour.end - 1].end - batches[colour.begin].begin;
  }
};

}  // namespace mssim
