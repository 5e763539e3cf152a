#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/node_arrays.h"
#include "backends/layouts/packed_springs.h"
#include "model/system.h"

namespace mssim {

/// The computation of the spring forces of a layout on a device.
struct SpringKernel {
  std::string text;  ///< text of the program
  const char* name;  ///< name of its kernel
  /// Units of work; a work-item takes some of them in turn: the last arguments are their number and the
  /// number per item.
  std::size_t parts;
  std::size_t pair_floats, force_floats;  ///< its first two arguments: a pair of nodes, the forces
  std::vector<std::span<const std::byte>> constants;  ///< the arguments between those
};

/// Data with which the host's threads sum the spring forces at the nodes and integrate them, for one
/// integrator and one dt (made in hybrid.cpp). Nodes are records (kernels/records.h), forces are in the order
/// of PackedSprings, four floats each, N.
struct HostNodes : ExplicitSteps<float> {
  PackedSprings packed;
  /// [slices][inverse mass, held][16]: 1/kg; 1 if pinned or padding, else 0.
  AlignedArray constants;
  std::vector<SpringConstants<float>> materials;  ///< System::materials

  HostNodes(const System& system, const Integrator& method, double dt_s);

  std::size_t slices() const { return packed.slices(); }
  void write(const State& state, float* pair) const { write_records(state, packed.slot, pair); }
  State read(const float* pair) const { return read_records(pair, packed.slot); }
  /// The device's work; refers to this object.
  SpringKernel spring_kernel(int lanes) const;
  /// Frees the data of which the device has a copy.
  void forget_units();
};

/// HostNodes for alike bodies: data with which the host's threads sum the spring forces and integrate.
struct AlikeNodes : ExplicitSteps<float> {
  AlikeSprings springs;

  /// `bodies`: all bodies of the system.
  AlikeNodes(const System& system, const std::vector<AlikeBodies>& bodies, const Integrator& method,
             double dt_s);

  std::size_t slices() const { return springs.slices.count; }
  void write(const State& state, float* pair) const { springs.slices.write(state, pair); }
  State read(const float* pair) const { return springs.slices.read(pair); }
  std::uint64_t stored_springs() const { return springs.subtracted.items.size(); }
  /// The device's work; refers to this object.
  SpringKernel spring_kernel(int lanes) const;
  /// Frees the data of which the device has a copy.
  void forget_units() { springs.springs = {}; }
};

/// Mapped data of a stage: `pairs` by role, and the forces of all springs, in the layout of the corresponding
/// nodes.
struct MappedNodes {
  std::array<float*, pair_kinds> pairs{};
  const float* forces = nullptr;
};

/// The host's vector code for one instruction set, for nodes in a layout (HostNodes, AlikeNodes).
template <class Nodes>
struct NodeKernel {
  const char* instruction_set;  ///< Highway's name for it
  /// Sums the forces at the nodes of the slices [begin, end) and executes the assignments of a stage.
  void (*integrate)(const Nodes& nodes, const MappedNodes& mapped, std::size_t stage, std::size_t begin,
                    std::size_t end);
};

/// The kernels that this CPU can run, the best first.
std::vector<NodeKernel<HostNodes>> node_kernels();
std::vector<NodeKernel<AlikeNodes>> alike_node_kernels();

}  // namespace mssim
