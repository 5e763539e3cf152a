#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "garment/garment.h"
#include "geometry/vec3.h"
#include "model/topology.h"

namespace mssim {

/// How far the solvers of implicit integrators go.
struct SolverSettings {
  /// Conjugate gradients and Newton's method end where the norm of the residual has become this part of what
  /// it was.
  double tolerance = 1e-5;
  std::uint32_t iterations = 10;  ///< of fast-springs: local and global steps
  std::uint32_t substeps = 10;    ///< of xpbd: small steps in a step
};

/// Where all nodes are and how they move, in the scene file's node order and in double precision: the form in
/// which states enter and leave every backend.
struct State {
  std::vector<Vec3d> position;  ///< [nodes] m
  std::vector<Vec3d> velocity;  ///< [nodes] m/s
  bool draped = false;          ///< of a garment: all its seams are closed, and gravity and friction act
};

/// The plane y = height that nothing may fall through (kernels/node_laws.h).
struct Floor {
  double height = 0;       ///< m
  double restitution = 0;  ///< share of the falling speed that comes back, 0 to 1
  double friction = 0;     ///< Coulomb's coefficient, not negative
};

/// How the nodes hang together: what a backend may know beyond the list of springs.
using Topology = std::variant<GridPatch, TetrahedralMesh, Garment>;

/// Everything that stays constant while a scene is stepped, and the state that it starts from.
/// The acceleration of a free node is
///     a = (sum of spring forces) / node_mass[node] - viscous_damping v + (0, -gravity, 0);
/// a pinned node stays where it starts, at rest.
struct System {
  Topology topology;                      ///< all nodes belong to it
  std::vector<Spring> springs;            ///< [springs] each unique spring once
  std::vector<SpringMaterial> materials;  ///< [kinds] indexed by Spring::kind
  std::vector<std::uint32_t> pins;        ///< [pinned nodes] ascending
  std::vector<double> node_mass;          ///< [nodes] kg
  double gravity = 0;                     ///< m/s^2, downwards
  double viscous_damping = 0;             ///< 1/s
  Floor floor;                            ///< its height in single precision, like the start
  SolverSettings solver;                  ///< of implicit integrators
  /// Pinned nodes are at rest. The numbers are single precision, for the reason given at Spring::rest_length.
  State start;

  std::size_t nodes() const { return start.position.size(); }
};

/// The mass of each node, kg, where all nodes weigh the same.
std::optional<double> uniform_node_mass(const System& system);

/// Mean rest length over all springs, m: the unit of position errors.
double mean_rest_length(const System& system);

/// A system without nodes that has the laws of this one: its materials, gravity, damping, floor and solver.
System with_laws_of(const System& system);

/// The system with its floor out of reach.
System without_floor(System system);

/// Rounds to single precision.
void round_to_single(double& value);

/// Rounds all numbers of a state.
void round_to_single(State& state);

/// Rounds what a system starts from: its start state, and its floor's height.
void round_start_to_single(System& system);

/// Bounds on what the springs can do to one node, for the stability limit.
struct StiffnessBound {
  double stiffness = 0;  ///< 1/s^2, at least the largest eigenvalue of K/m
  double damping = 0;    ///< 1/s, at least the largest eigenvalue of C/m, viscous damping included
};

/// Gershgorin's bound: a node's springs all aligned, all neighbours moving against it.
StiffnessBound stiffness_bound(const System& system);

/// Moments at equal times of a simulation, from its start on: a frame is the step nearest to its time.
struct FrameGrid {
  double steps_per_frame = 1;  ///< at least 1, so that no two frames are the same step

  /// Steps done when frame `frame` is taken.
  std::int64_t step_of(std::int64_t frame) const {
    return std::llround(static_cast<double>(frame) * steps_per_frame);
  }
};

/// Nodes of a leaf of state_hash.
inline constexpr std::size_t state_hash_leaf = 4096;

/// Two states have the same hash if they agree to the last bit; others, but by accident, do not. It is a tree
/// of two levels, so that who holds only a part of the nodes can hash that part: FNV-1a of each 4096 nodes
/// (the six numbers of a node after each other, position before velocity, each a double from its lowest byte
/// on), and FNV-1a of these hashes in their order, each from its lowest byte on.
std::uint64_t state_hash(const State& state);

}  // namespace mssim
