#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "garment/stepping/dressing_backend.h"
#include "model/system.h"

namespace mssim {

/// When a garment counts as settled, and the longest time for that.
struct SettlingRule {
  double window_s = 0.05;    ///< of simulated time
  double distance = 0.0005;  ///< m that nodes may move within a window
  double fraction = 0.99;    ///< of the nodes; more than these must move less
  double longest_s = 4;      ///< of simulated time, seaming included
};

/// Outcome of a dressing.
struct DressingResult {
  State state;                            ///< at the end
  std::int64_t iterations = 0;            ///< steps in all
  std::optional<std::int64_t> seamed_at;  ///< steps after which all seams were closed
  bool settled = false;                   ///< else the longest time was over
  double simulated_s = 0;
};

/// Called after every window with the state and the number of steps; returns whether to continue.
using OnWindow = std::function<bool(const State& state, std::int64_t iterations)>;

/// Steps of a dressing between two calls of on_steps.
inline constexpr std::int64_t most_dressing_steps_at_once = 240;

/// Frames of a dressing: the start, those of the grid, and the end. They do not change the result.
struct DressingFrames {
  FrameGrid grid;
  /// Called with the state and the number of steps; none: no frames.
  std::function<void(const State& state, std::int64_t iterations)> on_frame = {};
  /// Called at least every most_dressing_steps_at_once steps; an exception ends the dressing. None: not
  /// called.
  std::function<void()> on_steps = {};
};

/// Dresses from the system's start until the seams are closed and the garment has settled, or until the
/// longest time is over. on_window precedes a frame at the end of its window.
DressingResult dress(DressingBackend& backend, const System& system, double dt_s, const SettlingRule& rule,
                     const OnWindow& on_window, const DressingFrames& frames = {});

/// The fit of a dressed garment, measured on its nodes and faces and on the body's mesh, not on the maps that
/// the simulation collides with.
struct Fit {
  double largest_gap = 0;          ///< m, of all joints
  std::size_t nodes_inside = 0;    ///< of the body
  double deepest_node = 0;         ///< m below the body's surface
  double deepest_face_sample = 0;  ///< m, of 5 x 5 samples in every cell
  /// m, the largest distance from the body of a node that must lie close to it (CloseCloth), and the height
  /// of that node; none without such nodes. Hollows of the body are bridged, as by taut cloth, so that no
  /// point of a face is further away than the face's nodes.
  std::optional<double> side_distance = {}, side_distance_height = {};
  /// m, mean height of the upper edges of a layer's panels above their place in the pattern, of the layer
  /// with the largest deviation; negative: below.
  double upper_edge_rise = 0;
  /// m, mean height of Garment::crotch above its place in the pattern; none without jeans.
  std::optional<double> crotch_rise = {};
  /// Closed rows of cloth, and those of them that do not go once around their limb; none without closed rows.
  /// A closed row consists of rows of panels, each sewn by its right end to the left end of the next, and the
  /// last to the first; or of one, sewn to itself.
  std::optional<std::size_t> rows = {}, rows_astray = {};
  /// Elongation over rest length of structural and shear springs: the median, the 99 % and 99.9 % quantiles
  /// and the maximum.
  double elongation_50 = 0, elongation_99 = 0, elongation_999 = 0, elongation_max = 0;
  /// Edges of cells that run through a face of another layer (count_crossings), whether or not the simulation
  /// has collisions between layers.
  std::size_t crossings = 0;
};

/// Functions of the body that a fit needs.
struct FitBody {
  /// Depth of each point inside the body, m; 0 outside.
  std::function<std::vector<double>(std::span<const Vec3d> points)> depths;
  /// Points of the axes around each of which a closed row of cloth with this middle must go once: of a leg,
  /// of both, or of the trunk.
  std::function<std::vector<Vec3d>(const Vec3d& middle)> limb_axes;
  /// Distances of points from the body, m, with hollows bridged between two heights, m. Needed for a garment
  /// with cloth that must lie close.
  std::function<std::vector<double>(std::span<const Vec3d> points, double lowest, double highest)> distances =
      {};
};

/// `system.topology` is a Garment.
Fit fit_of(const System& system, const std::vector<Vec3d>& position, const FitBody& body);

/// Points of a panel's cells at fractions 0, 1/4 .. 1 of both sides, on the cell's two triangles: that of the
/// corners (row, column), (row, column + 1), (row + 1, column), and the other half. [cells * 25]
std::vector<Vec3d> face_samples(const GarmentPanel& panel, const std::vector<Vec3d>& position);

/// Bounds within which a garment counts as dressed.
struct FitBounds {
  double largest_gap = 1e-3;       ///< m
  double deepest = 1e-3;           ///< m, depth of any point of the cloth inside the body
  double side_distance = 0.012;    ///< m
  double elongation_99 = 0.06;     ///< of 99 % of the structural and shear springs
  double elongation_999 = 0.08;    ///< of 99.9 % of them
  double upper_edge_shift = 0.02;  ///< m, up or down
  double crotch_shift = 0.03;      ///< m, up or down
  double rows_astray = 0;
  double crossings = 0;  ///< of layers
};

/// One number of a fit, for a listing.
struct FitCheck {
  std::string name;  ///< with its unit at the end
  double value = 0;
  std::optional<std::string> bound;  ///< on its magnitude: "1", or "±20" if it may have either sign
  std::optional<bool> within;        ///< whether the number is within its bound
};

/// All numbers of the fit, in a fixed order.
std::vector<FitCheck> fit_checks(const Fit& fit, const FitBounds& bounds);

/// The faults of a dressing: seams that did not close in time, a garment that did not settle, and numbers of
/// the fit out of bounds. Each names what happened, the number and its bound, and a remedy.
std::vector<std::string> misfits(const DressingResult& result, const Fit& fit, const FitBounds& bounds);

}  // namespace mssim
