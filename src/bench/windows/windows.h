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

/// A cloth that no process on this machine holds as a whole, and the windows in which it is verified.
struct WindowedCloth {
  GridPatch grid;
  std::uint64_t springs = 0;        ///< unique ones of the whole
  std::vector<GridWindow> windows;  ///< of equal size, without overlap
  /// Builds the nodes of a window and the springs between them, at the scene's start state.
  std::function<System(const GridWindow& window)> build;

  std::uint64_t nodes() const { return std::uint64_t{grid.rows} * grid.columns; }
};

/// Default number of windows for a cloth in `parts` parts.
inline std::size_t usual_windows(std::size_t parts) { return parts + 8; }

/// The fewest windows with which every part of the cloth has one: two corners, and the seams between the
/// parts.
inline std::size_t fewest_windows(std::size_t parts) { return parts + 1; }

/// Chooses at most `count` windows of equal size without overlap, in this order: two opposite corners; the
/// seams between the columns of `parts` parts (part_of in layouts/band_grid.h), so that every part has a
/// window; the middle of the pinned row; the other corners; then places spread evenly over the cloth. Equal
/// arguments give equal windows. A small cloth has room for fewer.
std::vector<GridWindow> choose_windows(const GridPatch& grid, std::size_t parts,
                                       std::optional<std::uint32_t> pinned_row, std::size_t count);

/// Numbers of steps after which the reference of a window has a state; a sample has one of these lengths.
inline constexpr std::array<int, 13> window_looks{1, 2, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100};
static_assert(window_looks.back() == verification_steps);

/// Result of the double-precision reference in one window.
struct WindowReference {
  GridWindow window;
  System system;                       ///< the window's nodes and the springs between them
  std::vector<State> states;           ///< at window_looks that are comparable and before contact
  std::optional<std::string> failure;  ///< why there is no reference

  /// The state after `steps` steps, one of window_looks.
  const State& after(int steps) const {
    return states.at(static_cast<std::size_t>(std::ranges::find(window_looks, steps) - window_looks.begin()));
  }
};

/// Upper bound of the bytes of the reference of such a window.
double window_reference_bytes(const Integrator& integrator, const GridWindow& window, const GridPatch& grid);

/// The references of all windows of a cloth. Cloth and integrator must outlive them.
struct WindowReferences {
  const WindowedCloth& cloth;
  const Integrator& integrator;
  double dt_s = 0;
  std::vector<WindowReference> windows = {};
  int steps = 0;  ///< after which all windows have a state
  std::optional<std::string> failure = {};
};

/// Runs the references of all windows for verification_steps, `at_once` at the same time, each on the
/// window's domain of dependence only.
///
/// A spring is at most two rows or columns long. So a node's acceleration depends on nodes at most two away,
/// and a stage's result on the previous stage's result there. At a cut edge of the domain, the outermost two
/// rows miss springs: after k stages the outermost 2 k rows are wrong. All other rows have seen the same
/// neighbours as in the whole cloth, summed in the same order, so they are bitwise identical (with an
/// integrator that is ahead, equal to rounding in double precision). ghost_columns (layouts/band_grid.h)
/// gives the width for any number of steps. Edges of the cloth itself cause no error. Rows that have become
/// wrong are dropped every few steps.
WindowReferences run_window_references(const WindowedCloth& cloth, const Integrator& integrator, double dt_s,
                                       std::size_t at_once);

/// find_blow_up from the scene's start for a backend whose states are those of the windows
/// (make_window_backend). The node has its number in the whole cloth.
std::optional<BlowUp> find_blow_up(Backend& backend, const WindowedCloth& cloth, int steps);

/// Compares every window of `state`, which the backend has `steps` steps after the scene's start. `steps` is
/// one of window_looks, at most reference.steps. The position error is the largest of all nodes, each window
/// has its own tolerance, and the energy is that of all windows together. There is no hash of the state. Only
/// steps the backend if the state is not finite.
Verification compare_windows(Backend& backend, const State& state, const WindowReferences& reference,
                             int steps);

/// Steps the backend from the scene's start for reference.steps steps and compares it.
Verification verify_windows(Backend& backend, const WindowReferences& reference);

/// "verified in 9 windows, 0.4 % of the nodes".
std::string share_seen(const WindowedCloth& cloth);

}  // namespace mssim
