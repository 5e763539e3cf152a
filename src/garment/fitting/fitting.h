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

/// When a garment counts as settled, and how long that may take.
struct SettlingRule {
  double window_s = 0.05;    ///< of simulated time
  double distance = 0.0005;  ///< m that nodes may move within it
  double fraction = 0.99;    ///< of the nodes that must move less
  double longest_s = 4;      ///< of simulated time, seaming included
};

/// How a dressing went.
struct DressingResult {
  State state;                            ///< at the end
  std::int64_t iterations = 0;            ///< steps in all
  std::optional<std::int64_t> seamed_at;  ///< steps after which all seams were closed
  bool settled = false;                   ///< or else the longest time was over
  double simulated_s = 0;
};

/// Called after every window with the state and the number of steps; returns whether to go on.
using OnWindow = std::function<bool(const State& state, std::int64_t iterations)>;

/// Moments of a dressing to look at: the start, those of the grid, and the end. They change nothing.
struct DressingFrames {
  FrameGrid grid;
  /// Called with the state and the number of steps; none where nobody looks.
  std::function<void(const State& state, std::int64_t iterations)> on_frame;
};

/// Dresses: from the system's start until the seams are closed and the garment has settled, or the longest
/// time is over. A frame at the end of a window comes after on_window.
DressingResult dress(DressingBackend& backend, const System& system, double dt_s, const SettlingRule& rule,
                     const OnWindow& on_window, const DressingFrames& frames = {});

/// How a dressed garment sits, measured on its nodes and faces and on the body's own mesh, never on the maps
/// that the simulation collides with.
struct Fit {
  double largest_gap = 0;          ///< m, of all joints
  std::size_t nodes_inside = 0;    ///< of the body
  double deepest_node = 0;         ///< m below the body's surface
  double deepest_face_sample = 0;  ///< m, of 5 x 5 samples in every cell
  /// m, the largest distance from the body of a node that is to lie close to it (CloseCloth), and the height
  /// of that node; none where no node is to. Hollows of the body are bridged, as taut cloth does, so that no
  /// point of a face is further away than the face's nodes.
  std::optional<double> side_distance = {}, side_distance_height = {};
  /// m, how far the upper edges of a layer's panels hang above where the pattern puts them, on average;
  /// below, where negative: of the layer where that is farthest off.
  double upper_edge_rise = 0;
  /// m, the rise of the nodes at which seams meet (the crotch), on average; none where seams do not meet.
  std::optional<double> meeting_rise = {};
  /// Rows of two panels, sewn to each other at both ends, which do not go once around the limb between them.
  std::size_t rows = 0, rows_astray = 0;
  /// Elongation over rest length of structural and shear springs: the median, what 99 % and 99.9 % are below,
  /// and the largest.
  double elongation_50 = 0, elongation_99 = 0, elongation_999 = 0, elongation_max = 0;
  /// Edges of cells that run through a face of another layer (count_crossings), whether the
  /// layers touch each other in the simulation or not.
  std::size_t crossings = 0;
};

/// What a fit is measured against.
struct FitBody {
  /// How deep each point lies inside the body, m; 0 outside.
  std::function<std::vector<double>(std::span<const Vec3d> points)> depths;
  /// The middle of the limb that a point is about, at the point's height.
  std::function<Vec3d(const Vec3d& point)> limb_middle;
  /// How far points are outside of the body whose hollows between two heights, m, are bridged, m; asked where
  /// a garment has cloth that is to lie close.
  std::function<std::vector<double>(std::span<const Vec3d> points, double lowest, double highest)> distances =
      {};
};

/// `system.topology` is a Garment.
Fit fit_of(const System& system, const std::vector<Vec3d>& position, const FitBody& body);

/// The points of a panel's cells at fractions 0, 1/4 .. 1 of both sides, on the cell's two triangles: its
/// corners (row, column), (row, column + 1), (row + 1, column) and the other half. [cells * 25]
std::vector<Vec3d> face_samples(const GarmentPanel& panel, const std::vector<Vec3d>& position);

/// What a dressed garment must keep to count as dressed.
struct FitBounds {
  double largest_gap = 1e-3;       ///< m
  double deepest = 1e-3;           ///< m that any point of the cloth may be inside the body
  double side_distance = 0.012;    ///< m
  double elongation_99 = 0.06;     ///< that 99 % of the structural and shear springs stay below
  double elongation_999 = 0.08;    ///< the same of 99.9 %
  double upper_edge_shift = 0.02;  ///< m, up or down
  double meeting_shift = 0.03;     ///< m, up or down
  double rows_astray = 0;
  double crossings = 0;  ///< of layers
};

/// One number of a fit, for a listing.
struct FitCheck {
  std::string name;  ///< ends in its unit
  double value = 0;
  std::optional<double> bound;  ///< on its magnitude; none where it has none
  std::string shown_bound;      ///< "1", or "±20" where the number may have either sign; empty without bound
  std::optional<bool> within;   ///< whether it keeps it
};

/// All numbers that the fit has, in one order.
std::vector<FitCheck> fit_checks(const Fit& fit, const FitBounds& bounds);

/// What is out of bounds, each what happened, the number and its bound, and what to try: that the garment was
/// not sewn in time, did not settle, or a number of its fit.
std::vector<std::string> misfits(const DressingResult& result, const Fit& fit, const FitBounds& bounds);

}  // namespace mssim
