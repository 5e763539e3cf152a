#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "model/system.h"

namespace mssim {

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
  /// The same of the nodes at which seams meet: the crotch; none where seams do not meet.
  std::optional<double> meeting_rise = {};
  /// Rows of two panels, sewn to each other at both ends, which do not go once around the limb between them.
  std::size_t rows = 0, rows_astray = 0;
  /// Elongation over rest length of structural and shear springs: the median, what 99 % and 99.9 % are below,
  /// and the largest.
  double elongation_50 = 0, elongation_99 = 0, elongation_999 = 0, elongation_max = 0;
  /// Edges of cells that run through a face of another layer (garment/layers/cloth_crossings.h), whether the
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

}  // namespace mssim
