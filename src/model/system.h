#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "garment/garment.h"
#include "geometry/vec3.h"
#include "integrators/stability.h"
#include "laws/host_laws.h"

namespace mssim {

/// A spring between two nodes.
struct Spring {
  std::uint32_t first = 0;   ///< node index
  std::uint32_t second = 0;  ///< node index, different from `first`
  /// m. Single precision on purpose: every backend, including the double-precision reference, then simulates
  /// exactly the same springs, and an error against the reference is purely arithmetic.
  float rest_length = 0;
  std::uint32_t kind = 0;  ///< index into System::materials
};

/// The constants of a kind of spring.
using SpringMaterial = SpringConstants<double>;

/// One of its constants, a row of MSSIM_SPRING_CONSTANTS (kernels/spring_constants.h).
struct SpringConstantInfo {
  double SpringMaterial::*number;
  std::string_view name;             ///< in traces, and in the files of users' programs
  int per_time;                      ///< n if the constant divided by a mass contains s^-n
  std::string_view unit, h5md_unit;  ///< in the files of users' programs, and in traces
  std::string_view key, sentence;    ///< in scene files and their schema
  double most;                       ///< maximum in a scene file
  bool required;                     ///< in scene files; another constant is 0 if a file does not state it
};
/// The constants in the order of SpringMaterial.
#define MSSIM_COLUMNS(...) __VA_ARGS__
#define MSSIM_INFO(name, info) {&SpringMaterial::name, #name, MSSIM_COLUMNS info},
inline constexpr auto spring_constants =
    std::to_array<SpringConstantInfo>({MSSIM_SPRING_CONSTANTS(MSSIM_INFO)});
#undef MSSIM_INFO
#undef MSSIM_COLUMNS

/// The springs of a regular cloth, by the deformation that they resist. The numbers index GridSpringKind
/// tables and materials.
enum GridSpringKind : std::uint32_t { structural, shear, bending };

/// One row per kind of cloth spring: its name in scene files and its squared length in units of the spacing.
struct GridSpringKindInfo {
  std::string_view name;
  double length_squared;
};
/// The TABLE of kinds of cloth springs, by GridSpringKind.
inline constexpr std::array<GridSpringKindInfo, 3> grid_spring_kinds{{
    {"structural", 1},
    {"shear", 2},
    {"bending", 4},
}};

/// One spring of the stencil, as an offset from its owner to the other end. Down means towards higher rows,
/// in panels too.
struct GridSpring {
  int rows;     ///< down
  int columns;  ///< to the right
  GridSpringKind kind;
};

/// The 12-neighbour stencil of Hong et al., Figure 2, each spring once.
inline constexpr std::array<GridSpring, 6> grid_stencil{{
    {1, 0, structural},
    {0, 1, structural},
    {1, 1, shear},
    {-1, 1, shear},
    {2, 0, bending},
    {0, 2, bending},
}};

/// A regular cloth: rows x columns nodes, row-major, joined by the 12-neighbour stencil.
struct GridPatch {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  double spacing = 0;              ///< m, between neighbours of a row or a column at rest
  std::uint32_t first_column = 0;  ///< its first column in the whole cloth, if this is a window of it

  std::uint32_t nodes() const { return rows * columns; }
  std::uint32_t node(std::uint32_t row, std::uint32_t column) const { return row * columns + column; }
  /// Rest length of one kind of spring, m, as every backend uses it (see Spring::rest_length).
  float rest_length(GridSpringKind kind) const;
};

/// Consecutive rows and columns of a grid.
struct GridWindow {
  std::uint32_t row = 0, column = 0;  ///< the first ones
  std::uint32_t rows = 0, columns = 0;

  std::size_t nodes() const { return std::size_t{rows} * columns; }
};

/// Number of unique springs of a rows x columns grid, without building them:
/// structural 2rc - r - c, shear 2(r-1)(c-1), bending 2rc - 2r - 2c (for grids of at least 2 x 2).
std::uint64_t count_springs(std::uint64_t rows, std::uint64_t columns);

/// The springs of the grid in the order of their owners, each once. Throws only std::bad_alloc.
std::vector<Spring> springs_of(const GridPatch& grid);

/// Node indices a, b, c, d of a tetrahedron of positive volume: (b - a) . ((c - a) x (d - a)) > 0.
using Tetrahedron = std::array<std::uint32_t, 4>;

/// The solid bodies of a scene, one after the other. The springs are the edges of the tetrahedra.
struct TetrahedralMesh {
  std::vector<Tetrahedron> tetrahedra;
};

/// Settings of the solvers of implicit integrators.
struct SolverSettings {
  /// Relative tolerance of conjugate gradients and of Newton's method (implicit/newton/newton_method.h).
  double tolerance = 1e-5;
  std::uint32_t iterations = 10;  ///< of fast-springs: local and global steps
  std::uint32_t substeps = 10;    ///< of xpbd: substeps per step
};

/// Positions and velocities of all nodes, in the scene file's node order and in double precision: the form in
/// which states enter and leave every backend.
struct State {
  std::vector<Vec3d> position;  ///< [nodes] m
  std::vector<Vec3d> velocity;  ///< [nodes] m/s
  bool draped = false;          ///< a garment: all seams are closed, and gravity and friction act

  /// Appends a node.
  void add(const Vec3d& x, const Vec3d& v) {
    position.push_back(x);
    velocity.push_back(v);
  }
};

/// The plane y = height through which nothing may fall (kernels/node_laws.h).
struct Floor {
  double height = 0;       ///< m
  double restitution = 0;  ///< fraction of the falling speed that is reversed, 0 to 1
  double friction = 0;     ///< Coulomb's coefficient, not negative
};

/// The structure of the nodes, beyond the list of springs.
using Topology = std::variant<GridPatch, TetrahedralMesh, Garment>;

/// Everything that stays constant while a scene is stepped, and its start state.
/// The acceleration of a free node is
///     a = (sum of spring forces) / node_mass[node] - viscous_damping v + (0, -gravity, 0);
/// a pinned node keeps its start position, at rest.
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
  /// Pinned nodes are at rest. The numbers are rounded to single precision; see Spring::rest_length.
  State start;

  std::size_t nodes() const { return start.position.size(); }
};

/// System::materials in another precision.
template <class Real>
std::vector<SpringConstants<Real>> materials_of(const System& system) {
  std::vector<SpringConstants<Real>> materials;
  for (const SpringMaterial& material : system.materials)
    materials.push_back(constants_from<Real>(std::identity(), material));
  return materials;
}

/// The mass of each node, kg, if all nodes have the same mass; else nothing.
std::optional<double> uniform_node_mass(const System& system);

/// Mean rest length over all springs, m, or 1 m without springs: the unit of position errors.
double mean_rest_length(const System& system);

/// A system without nodes and with this one's laws: materials, gravity, damping, floor and solver.
System with_laws_of(const System& system);

/// The system with its floor out of reach.
System without_floor(System system);

/// Rounds to single precision.
void round_to_single(double& value);

/// Rounds all numbers of a state to single precision.
void round_to_single(State& state);

/// Rounds a system's initial data to single precision: its start state and its floor's height.
void round_start_to_single(System& system);

/// The bound of the system's modes, for the stability limits of its integrators, by Gershgorin: all springs
/// of a node aligned, all neighbours moving against it. Has parts, a material each, if materials damp in
/// different proportions to their stiffness.
ModeBound mode_bound(const System& system);

/// The largest eigenvalues of a system about a state: they limit the step of an explicit integrator.
struct Spectrum {
  double stiffness = 0;  ///< 1/s^2, of M^-1 K: the square of the fastest angular frequency
  double damping = 0;    ///< 1/s, of M^-1 C, viscous damping included
};

/// The spectral radii of M^-1 K and M^-1 C at `state`, by power iteration (for example Golub and Van Loan,
/// Matrix Computations, section 7.3.1) from a fixed pseudo-random vector: x becomes M^-1 K x, and its
/// Rayleigh quotient in the inner product of M, which is at most the largest eigenvalue, converges to it. K
/// and C are the derivatives of the spring forces with respect to positions and velocities
/// (kernels/spring_law.h) with pinned nodes fixed. Ends when a hundred iterations have raised the quotient by
/// less than a thousandth, or after 3,000. A garment's joints and contacts are not included.
Spectrum spectrum_at(const System& system, const State& state);

/// Equidistant times of a simulation, from its start on; a frame is the step nearest to its time.
struct FrameGrid {
  double steps_per_frame = 1;  ///< at least 1, so that no two frames are the same step

  /// Number of steps before frame `frame`; at most 2^62, which no simulation takes.
  std::int64_t step_of(std::int64_t frame) const {
    return std::llround(std::min(static_cast<double>(frame) * steps_per_frame, 0x1p62));
  }
};

/// Nodes per leaf of state_hash.
inline constexpr std::size_t state_hash_leaf = 4096;

/// Two states have the same hash if they are bitwise identical; other pairs collide only by accident. The
/// hash is a tree of two levels, so a process with a part of the nodes can hash that part: FNV-1a of each
/// 4096 nodes (a node's six numbers, position before velocity, each a double from its lowest byte on), and
/// FNV-1a of these hashes in order, each from its lowest byte on.
std::uint64_t state_hash(const State& state);

/// The mechanical energy of a state, J.
struct Energy {
  double kinetic = 0;
  double elastic = 0;        ///< of all springs, zero at rest length
  double gravitational = 0;  ///< zero on the floor
  double total() const { return kinetic + elastic + gravitational; }
};

/// Losses of mechanical energy since the start, J.
struct EnergyLosses {
  double damping = 0;      ///< by the springs and by the air
  double friction = 0;     ///< by sliding on the floor
  double bounce = 0;       ///< by the floor otherwise; negative if putting nodes back on it adds energy
  double integration = 0;  ///< by the integrator's error off the floor; negative if it adds energy
  double total() const { return damping + friction + bounce + integration; }
};

/// Energy of `state` in double precision. Pinned nodes are included, at their constant height.
Energy energy_of(const System& system, const State& state);

/// The work on the nodes that none of these energies include, in words; empty if EnergyLosses account for
/// everything.
std::string_view energies_leave_out(const System& system);

/// Energy of one spring, J.
double elastic_energy(const System& system, const Spring& spring, const State& state);

/// Power dissipated by damping of the springs and of the air in `state`, W: the sum of spring_loss over all
/// springs, and of viscous_damping m v^2 over all nodes.
double damping_power(const System& system, const State& state);

}  // namespace mssim
