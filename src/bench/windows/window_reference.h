#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/verification/verification.h"
#include "bench/windows/windowed_cloth.h"
#include "integrators/integrator.h"

namespace mssim {

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

}  // namespace mssim
