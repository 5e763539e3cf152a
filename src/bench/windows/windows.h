#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "bench/verification/verification.h"
#include "integrators/integrator.h"
#include "model/system.h"

namespace mssim {

/// A cloth of which no process here has the whole, and the windows by which it is verified.
struct WindowedCloth {
  GridPatch grid;
  std::uint64_t springs = 0;        ///< unique ones of the whole
  std::vector<GridWindow> windows;  ///< of one size; no two overlap
  /// Builds the nodes of a window with the springs between them, at the scene's start state.
  std::function<System(const GridWindow& window)> build;

  std::uint64_t nodes() const { return std::uint64_t{grid.rows} * grid.columns; }
  std::uint64_t nodes_in_windows() const {
    return windows.empty() ? 0 : windows.size() * windows.front().nodes();
  }
};

/// The number that a node of a window has in the whole cloth.
inline std::size_t node_of_cloth(const GridWindow& window, std::size_t node, const GridPatch& grid) {
  return (window.row + node / window.columns) * grid.columns + window.column + node % window.columns;
}

/// Windows that a cloth is verified in unless a number is asked for.
inline std::size_t usual_windows(std::size_t parts) { return parts + 8; }

/// The fewest with which every part of the cloth has one: two corners, and the seams between the parts.
inline std::size_t fewest_windows(std::size_t parts) { return parts + 1; }

/// At most so many windows of one size, of which no two overlap: two opposite corners; the seams between the
/// columns of so many parts (part_of of layouts/band_grid.h), so that every part has a window; the middle
/// of the pinned row; the other corners; and then places spread evenly over the cloth. The same ones for the
/// same arguments. On a small cloth there are fewer, because they leave each other no room.
std::vector<GridWindow> choose_windows(const GridPatch& grid, std::size_t parts,
                                       std::optional<std::uint32_t> pinned_row, std::size_t count);

/// A window, and so many rows and columns beside it, as far as the cloth goes.
GridWindow domain_of(const GridWindow& window, std::size_t reach, const GridPatch& grid);

/// Steps after which the reference of a window has a state: a sample ends at one of them.
inline constexpr std::array<int, 13> window_looks{1, 2, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100};
static_assert(window_looks.back() == verification_steps);

/// What the double-precision reference reaches in one window.
struct WindowReference {
  GridWindow window;
  System system;              ///< its nodes, and the springs between them
  std::vector<State> states;  ///< at the looks before what they follow from touches the floor, and comparable
  std::optional<std::string> failure;  ///< why there is no reference

  /// Its state after so many steps, one of window_looks.
  const State& after(int steps) const {
    return states.at(static_cast<std::size_t>(std::ranges::find(window_looks, steps) - window_looks.begin()));
  }
};

/// Runs the reference of a window for verification_steps, of the window's domain of dependence alone.
///
/// A spring is at most two rows or columns long, so that the acceleration of a node follows from what is at
/// most two away from it, and a stage's result from the stage before it there. Where the domain is cut, the
/// outermost two rows miss springs: after k stages the outermost 2 k rows are wrong, and all others have
/// seen what they see in the whole, summed in the same order: they have the same bits (of an integrator that
/// is ahead, to rounding in double precision). ghost_columns (layouts/band_grid.h) says it for any
/// number of steps. Where the domain ends because the cloth does, nothing is wrong. What becomes wrong is
/// dropped every few steps.
WindowReference run_window_reference(const WindowedCloth& cloth, const GridWindow& window,
                                     const Integrator& integrator, double dt_s);

/// Bytes that the reference of a window of so many rows and columns takes at most.
double window_reference_bytes(const Integrator& integrator, const GridWindow& window, const GridPatch& grid);

/// Those of all windows of a cloth.
struct WindowReferences {
  std::vector<WindowReference> windows;
  int steps = 0;  ///< after which all of them have a state
  std::optional<std::string> failure;
};

/// Runs the references of all windows, so many at the same time.
WindowReferences run_window_references(const WindowedCloth& cloth, const Integrator& integrator, double dt_s,
                                       std::size_t at_once);

/// The first node of the windows that is not finite, by its number in the whole cloth.
std::optional<std::size_t> first_bad_node(const WindowBackend& backend, const WindowedCloth& cloth);

/// The first step of so many from the scene's start after which a window is not finite.
std::optional<BlowUp> find_blow_up(WindowBackend& backend, const WindowedCloth& cloth, int steps);

/// Compares the backend, so many steps after the scene's start, in every window; at most reference.steps, and
/// one of window_looks. The position error is that of the worst node, each window has a tolerance of its own,
/// and the energy is that of all windows together. There is no hash of the state. Leaves the backend in any
/// state.
Verification compare_windows(WindowBackend& backend, const WindowedCloth& cloth, const Integrator& integrator,
                             const WindowReferences& reference, int steps, double dt_s);

/// Steps the backend from the scene's start, as far as there is a reference, and compares it.
Verification verify_windows(WindowBackend& backend, const WindowedCloth& cloth, const Integrator& integrator,
                            const WindowReferences& reference, double dt_s);

/// "verified in 9 windows, 0.4 % of the nodes".
std::string share_seen(const WindowedCloth& cloth);

}  // namespace mssim
