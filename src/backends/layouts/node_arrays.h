#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "backends/interface/backend.h"
#include "integrators/coefficients.h"
#include "model/system.h"

namespace mssim {

/// The least multiple of `multiple`, which must be positive, that is at least `value`.
constexpr std::size_t round_up(std::size_t value, std::size_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

/// Indices from `begin` up to, not including, `end`.
struct IndexRange {
  std::size_t begin, end;
};

/// Divides items into `count` ranges of about equal cost, of which some may be empty. cost_before(i): total
/// cost of the items before the i-th.
template <class CostBefore>
std::vector<IndexRange> balanced_ranges(IndexRange items, std::size_t count, const CostBefore& cost_before) {
  const std::size_t before = cost_before(items.begin), cost = cost_before(items.end) - before;
  std::vector<IndexRange> ranges;
  std::size_t end = items.begin;
  for (std::size_t range = 0; range < count; ++range) {
    const std::size_t begin = end, target = before + cost * (range + 1) / count;
    while (end < items.end && cost_before(end + 1) <= target) ++end;
    ranges.push_back({begin, end});
  }
  return ranges;
}

/// The largest number of threads, up to `most`, for which each has one of these units of work; at least one.
constexpr std::size_t threads_for(std::size_t units, std::size_t most) {
  return std::clamp<std::size_t>(most, 1, std::max<std::size_t>(1, units));
}

/// `floats` in whole vectors, an odd number of them: rows and components at a distance of a power of two
/// share a few sets of the first-level cache.
constexpr std::size_t odd_pitch(std::size_t floats, std::size_t lanes) {
  const std::size_t whole = round_up(floats, lanes);
  return whole / lanes % 2 == 0 ? whole + lanes : whole;
}

/// Offset of the first number of a slot in an array [slices][numbers][lanes]; the others follow at a distance
/// of `lanes`.
constexpr std::size_t slot_offset(std::size_t slot, std::size_t numbers, std::size_t lanes) {
  return slot / lanes * numbers * lanes + slot % lanes;
}

/// Reads a vector in space whose components are `step` numbers apart.
template <class Real>
Vec3d read_vector(const Real* from, std::size_t step) {
  return {double{from[0]}, double{from[step]}, double{from[2 * step]}};
}
/// Writes such a vector, rounded to Real.
template <class Real>
void write_vector(Real* to, std::size_t step, const Vec3d& value) {
  to[0] = static_cast<Real>(value.x);
  to[step] = static_cast<Real>(value.y);
  to[2 * step] = static_cast<Real>(value.z);
}

/// Writes a state, rounded to float, to arrays of positions and of velocities, in which the layout has each
/// node at offset(node), component_step() floats from a component to the next.
template <class Layout>
void write_fields(const Layout& layout, const State& state, float* x, float* v) {
  for (std::size_t node = 0; node < state.position.size(); ++node) {
    write_vector(x + layout.offset(node), layout.component_step(), state.position[node]);
    write_vector(v + layout.offset(node), layout.component_step(), state.velocity[node]);
  }
}
/// Reads the state of `nodes` nodes from such arrays.
template <class Layout>
State read_fields(const Layout& layout, std::size_t nodes, const float* x, const float* v) {
  State state{std::vector<Vec3d>(nodes), std::vector<Vec3d>(nodes)};
  for (std::size_t node = 0; node < nodes; ++node) {
    state.position[node] = read_vector(x + layout.offset(node), layout.component_step());
    state.velocity[node] = read_vector(v + layout.offset(node), layout.component_step());
  }
  return state;
}

/// A node of a cloth that is reset after every update.
template <class Real>
struct PlacedPin {
  std::size_t offset;  ///< numbers from the start of its row or column to the node's x
  std::array<Real, 3> position;
};

/// An array of numbers (Real: float or double), aligned for every vector width and for the devices' zero-copy
/// buffers. Its memory is zero and, if large, requests huge pages, which made the 350,000-node cloth 2 to
/// 14 % faster.
template <class Real>
class AlignedArrayOf {
 public:
  /// Bytes: a page, also the granularity of zero-copy buffers.
  static constexpr std::size_t alignment = 4096;

  AlignedArrayOf() = default;
  /// `size` numbers, all zero and untouched: the first writer determines their NUMA node. Throws
  /// std::bad_alloc.
  explicit AlignedArrayOf(std::size_t size);

  Real* data() { return data_.get(); }
  const Real* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(Real); }

 private:
  struct Unmap {
    std::size_t bytes;
    void operator()(Real* data) const;
  };
  std::unique_ptr<Real, Unmap> data_{nullptr, Unmap{0}};
  std::size_t size_ = 0;
};
using AlignedArray = AlignedArrayOf<float>;

/// Nodes as records of eight numbers, x y z 0 u v w 0 (u v w: velocity), half a cache line of floats, as in
/// kernels/records.h: a vector of neighbours is gathered by loading whole records and transposing them in
/// registers. On two Zen 4 cores with 38,148 nodes that is 3.6 times as fast as gather instructions on
/// separate components.
constexpr std::size_t record_floats = 8;

/// Writes the record of every node: node i's is number `slot[i]`. Rounds to Real.
template <class Real>
void write_records(const State& state, std::span<const std::uint32_t> slot, Real* records) {
  for (std::size_t node = 0; node < slot.size(); ++node) {
    Real* const record = records + std::size_t{slot[node]} * record_floats;
    write_vector(record, 1, state.position[node]);
    write_vector(record + record_floats / 2, 1, state.velocity[node]);
    record[3] = record[7] = 0;
  }
}

/// Reads the records that `write_records`, or later a backend, wrote.
template <class Real>
State read_records(const Real* records, std::span<const std::uint32_t> slot) {
  State state;
  for (const std::uint32_t number : slot) {
    const Real* const record = records + std::size_t{number} * record_floats;
    state.add(read_vector(record, 1), read_vector(record + record_floats / 2, 1));
  }
  return state;
}

/// Components of each node of a cloth as a structure of arrays, for vectors of consecutive nodes of a row:
///
///     [row -2 .. rows + 1][component][column]
///
/// Column 0 begins a vector, and so does each component of each row. A ring of two nodes surrounds the cloth,
/// so that the other end of every stencil spring can be loaded. The floats after the last column are also
/// those before the first column of the next component: the ring is never written and stays zero.
template <std::size_t component_count>
struct RowLayout {
  std::size_t lanes;
  std::size_t rows, columns;  ///< of the cloth
  std::size_t margin;         ///< floats before column 0, whole vectors
  std::size_t pitch;          ///< floats from one component of a row to the next, whole vectors

  RowLayout(const GridPatch& grid, std::size_t lane_count)
      : lanes(lane_count),
        rows(grid.rows),
        columns(grid.columns),
        margin(round_up(ring, lanes)),
        pitch(odd_pitch(margin + columns, lanes)) {}

  static constexpr std::size_t ring = 2;  ///< longest spring, in rows or columns
  static constexpr std::size_t components = component_count;
  std::size_t row_floats() const { return components * pitch; }
  /// Floats from an array's start to the first component of a node.
  std::size_t offset(std::size_t row, std::size_t column) const {
    return (row + ring) * row_floats() + margin + column;
  }
  /// The same for a node by its number in the scene.
  std::size_t offset(std::size_t node) const { return offset(node / columns, node % columns); }
  /// Floats from a component of a node to its next one.
  std::size_t component_step() const { return pitch; }
  /// Floats of an array, with a margin after its last row.
  std::size_t floats() const { return (rows + 2 * ring) * row_floats() + margin; }

  /// Columns of a row, in vectors of `vector_lanes`, whose nodes have all springs of the stencil.
  IndexRange inner_columns(std::size_t row, std::size_t vector_lanes) const {
    if (row < ring || row + ring >= rows || columns < margin + ring) return {0, 0};
    return {margin, margin + (columns - ring - margin) / vector_lanes * vector_lanes};
  }
};

/// Parameters of explicit steps, independent of the layout: one integrator, one dt.
template <class Real>
struct ExplicitSteps {
  const Integrator* integrator;
  Coefficients<Real> coefficients;
  SurroundingsOf<Real> surroundings;

  ExplicitSteps(const System& system, const Integrator& method, double dt_s)
      : integrator(&method),
        coefficients(coefficients_of<Real>(method, dt_s)),
        surroundings(surroundings_of<Real>(system)) {}
};

/// Explicit steps whose pairs have their own arrays.
template <class Real>
struct SeparateSteps : ExplicitSteps<Real> {
  std::array<AlignedArrayOf<Real>, pair_kinds> pairs;  ///< empty if not stored
  std::array<Real*, pair_kinds> base{};                ///< of `pairs`, by role: `state` and `next` swap

  using ExplicitSteps<Real>::ExplicitSteps;
  /// Allocates the pairs, `size` numbers each.
  void make_pairs(std::size_t size) {
    for (const Pair pair : stored_pairs(*this->integrator, Storage::separate)) {
      pairs[index(pair)] = AlignedArrayOf<Real>(size);
      base[index(pair)] = pairs[index(pair)].data();
    }
  }
};

/// base^exponent as a product, which std::pow does not round as.
constexpr double whole_power(double base, int exponent) {
  double product = 1;
  for (int i = 0; i < std::abs(exponent); ++i) product *= base;
  return exponent < 0 ? 1 / product : product;
}

/// A spring divided by the mass of a node, so that its force is an acceleration.
template <class Real>
using SpringPerMassOf = LinearSpring<Real>;
using SpringPerMass = SpringPerMassOf<float>;

/// Makes it from rest_length in m and mass in kg. `unit_s`: the unit of time, s.
template <class Real = float>
SpringPerMassOf<Real> spring_per_mass(const SpringMaterial& material, double rest_length, double mass,
                                      double unit_s = 1) {
  auto spring = linear_spring(material, rest_length);
  for (const SpringConstantInfo& constant : spring_constants)
    spring.constants.*constant.number *= whole_power(unit_s, constant.per_time);
  spring.stiffness_rest *= whole_power(unit_s, 2);
  return spring_from<Real>([mass](double number) { return number / mass; }, spring);
}

/// Writes the constants of one spring or node, `step` numbers apart. Returns the position after the last.
template <class Real>
Real* write_constants(Real* to, std::size_t step, const SpringConstants<Real>& constants) {
  for (const Real number : numbers_of(constants)) {
    *to = number;
    to += step;
  }
  return to;
}

/// SpringPerMass of a cloth's springs, by GridSpringKind. `unit_s`: as in spring_per_mass. Throws Unsupported
/// if its nodes differ in mass.
template <class Real = float>
std::vector<SpringPerMassOf<Real>> springs_per_mass(const System& system, const GridPatch& grid,
                                                    double unit_s = 1) {
  const double mass = require_uniform_mass(system);
  std::vector<SpringPerMassOf<Real>> springs;
  for (const GridSpringKind kind : {structural, shear, bending})
    springs.push_back(spring_per_mass<Real>(system.materials[kind],
                                            static_cast<double>(grid.rest_length(kind)), mass, unit_s));
  return springs;
}

}  // namespace mssim
