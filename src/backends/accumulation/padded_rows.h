#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "backends/interface/surroundings.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/spring_constants.h"
#include "integrators/coefficients.h"
#include "model/system.h"

namespace mssim {

/// A cloth as a structure of arrays, for vectors of nodes beside each other in a row:
///
///     [row -2 .. rows + 1][x y z u v w][column]       (u v w: velocity)
///
/// Column 0 begins a vector, and so does each component of each row. A ring of two nodes surrounds the cloth,
/// so that whatever a spring of the stencil would lead to can be loaded. What lies behind the last column is
/// also what lies before the first one of the next component: a ring is never written and stays zero.
struct RowLayout {
  std::size_t lanes;
  std::size_t rows, columns;  ///< of the cloth
  std::size_t margin;         ///< floats before column 0, whole vectors
  std::size_t pitch;          ///< floats from one component of a row to the next, whole vectors

  RowLayout(const GridPatch& grid, std::size_t lane_count);

  static constexpr std::size_t ring = 2;        ///< longest spring, in rows or columns
  static constexpr std::size_t components = 6;  ///< position and velocity
  std::size_t row_floats() const { return components * pitch; }
  /// Floats from an array's start to the x of a node.
  std::size_t offset(std::size_t row, std::size_t column) const {
    return (row + ring) * row_floats() + margin + column;
  }
  /// Floats of an array, with a margin behind its last row.
  std::size_t floats() const { return (rows + 2 * ring) * row_floats() + margin; }
};

/// What the vector code needs to take steps: one cloth, one integrator, one dt.
struct PaddedRows {
  /// A node that is put back after every update.
  struct Pin {
    std::size_t offset;  ///< RowLayout::offset
    std::array<float, 3> position;
  };

  RowLayout layout;
  const Integrator* integrator = nullptr;
  Coefficients<float> coefficients{};
  std::vector<SpringConstants> springs;  ///< [kinds]
  Surroundings surroundings{};
  std::size_t threads = 1;
  std::vector<Pin> pins;                       ///< row by row
  std::vector<std::size_t> first_pin;          ///< [rows + 1] where a row's pins begin
  std::array<AlignedArray, pair_kinds> pairs;  ///< [RowLayout::floats]; empty where not stored
  std::array<float*, pair_kinds> base{};       ///< of `pairs`, by role: `state` and `next` change places

  /// Throws Unsupported where the nodes differ in mass. Set a state before the first step.
  PaddedRows(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
             std::size_t lanes, std::size_t thread_count);
  void set_state(const State& state);
  State state() const;
};

}  // namespace mssim
