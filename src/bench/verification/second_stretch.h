#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"
#include "model/system.h"

namespace mssim {

/// Tetrahedra that need no mesher.
struct SolidBlock {
  std::vector<Vec3d> position;  ///< [nodes] m
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< of the tetrahedra, each once, ascending
};

/// Adds a block of nx x ny x nz nodes, `spacing` m apart, x fastest, from `corner` on: each cube of
/// neighbours cut into six tetrahedra around its diagonal (Kuhn's cut).
void add_block(SolidBlock& blocks, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double spacing,
               const Vec3d& corner);

/// The second part of a verification: a small scene of the same kind, materials, laws and step, near the
/// origin, where positions are rounded least. It moves more than a scene does at its start, and meets a
/// floor, on which it slides. What a large scene hides shows here: one spring of many, a few thousandths of a
/// stiffness, the air, the floor.
struct SecondStretch {
  System system;  ///< a cloth of 13 x 17 nodes, or two blocks of 4 x 5 x 6 nodes
  int steps = 0;
  State state;             ///< of the double-precision reference after them
  double tolerance = 0;    ///< on the position error, in mean rest lengths
  std::size_t landed = 0;  ///< nodes that have met the floor by then, and slid on it
};

/// Runs the reference of the second stretch of a scene that is a cloth or bodies: up to 400 steps. It ends
/// before the first step in which a rounding may decide whether a node meets the floor, and where roundings
/// stay within the tolerance (position_tolerance), as a reference beside it shows that is rounded to single
/// precision after every step. Of eight starts it takes the first that goes half of the way with ten nodes
/// that land, or the one that goes furthest.
SecondStretch run_second_stretch(const System& scene, const Integrator& integrator, double dt_s);

/// Why a backend made for the stretch's system and at its start is wrong; nothing where it is right.
std::optional<std::string> verify_second(Backend& backend, const SecondStretch& stretch);

}  // namespace mssim
