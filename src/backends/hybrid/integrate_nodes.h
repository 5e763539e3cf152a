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

/// How a device computes the forces of springs that lie in some layout.
struct SpringKernel {
  std::string text;  ///< of the program
  const char* name;  ///< of its kernel
  /// What a work-item takes some of in turn: its last arguments are how many there are and how many it takes.
  std::size_t parts;
  std::size_t pair_floats, force_floats;  ///< its first two arguments: a pair of nodes, the forces
  std::vector<std::span<const std::byte>> constants;  ///< the arguments between these
};

/// What the host's threads need to sum the spring forces at the nodes and to integrate them, with one
/// integrator and one dt (hybrid.cpp makes it). Nodes are records (kernels/records.h), forces lie as
/// PackedSprings places them, four floats each, N.
struct HostNodes : ExplicitSteps {
  PackedSprings packed;
  /// [slices][inverse mass, held][16]: 1/kg; 1 where nothing may move (pinned, or no node), else 0.
  AlignedArray constants;
  std::vector<SpringConstants<float>> materials;  ///< System::materials

  HostNodes(const System& system, const Integrator& method, double dt_s);

  std::size_t slices() const { return packed.slices(); }
  void write(const State& state, float* pair) const { write_records(state, packed.slot, pair); }
  State read(const float* pair) const { return read_records(pair, packed.slot); }
  /// What the device is to do. It refers to this.
  SpringKernel spring_kernel(int lanes) const;
  /// Gives up what the device has a copy of.
  void forget_units();
};

/// HostNodes for alike bodies: what the host's threads need to sum the forces of their springs and to
/// integrate.
struct AlikeNodes : ExplicitSteps {
  AlikeSprings springs;

  /// `bodies`: all of the system.
  AlikeNodes(const System& system, const std::vector<AlikeBodies>& bodies, const Integrator& method,
             double dt_s);

  std::size_t slices() const { return springs.slices.count; }
  void write(const State& state, float* pair) const { springs.slices.write(state, pair); }
  State read(const float* pair) const { return springs.slices.read(pair); }
  std::uint64_t stored_springs() const { return springs.subtracted.size(); }
  /// What the device is to do. It refers to this.
  SpringKernel spring_kernel(int lanes) const;
  /// Gives up what the device has a copy of.
  void forget_units() { springs.springs = {}; }
};

/// What a stage reads and writes, as mapped: `pairs` by role, and the forces of all springs, in the layout of
/// the nodes that it belongs to.
struct MappedNodes {
  std::array<float*, pair_kinds> pairs{};
  const float* forces = nullptr;
};

/// The host's vector code for one instruction set, for nodes in a layout (HostNodes, AlikeNodes).
template <class Nodes>
struct NodeKernel {
  const char* instruction_set;  ///< Highway's name for it
  /// Sums the forces at the nodes of the slices [begin, end) and runs the assignments of a stage.
  void (*integrate)(const Nodes& nodes, const MappedNodes& mapped, std::size_t stage, std::size_t begin,
                    std::size_t end);
};

/// The kernels that this processor can run, the best first.
std::vector<NodeKernel<HostNodes>> node_kernels();
std::vector<NodeKernel<AlikeNodes>> alike_node_kernels();

}  // namespace mssim
