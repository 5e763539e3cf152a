#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "integrators/integrator.h"

namespace mssim {

// Texts of the programs of the `opencl` backend: files of kernels/, and what is generated from the table of
// integrators. They depend on the integrator and on `lanes` (nodes side by side) alone.

/// Steps a grid: with one lane a kernel per stage of the integrator, where a work-item owns a node
/// (kernels/grid_nodes.cl); with several one kernel that takes steps, where a work-item walks over columns of
/// bands (kernels/grid_bands.cl).
std::string grid_program_text(const Integrator& integrator, int lanes);
/// Name of the kernel that takes steps in a walk.
inline constexpr const char* steps_kernel_name = "take_steps";

/// Steps a sliced graph by one kernel per stage of the integrator (kernels/mesh_stage.cl), and the nodes in a
/// slice of the graph that it reads.
std::string mesh_program_text(const Integrator& integrator, int lanes);
std::size_t mesh_slice_lanes(int lanes);

/// Steps alike bodies (kernels/alike_stage.cl), and the bodies in a slice of them.
std::string alike_program_text(const Integrator& integrator, int lanes);
std::size_t alike_slice_lanes(int lanes);

/// Name of the stage's kernel.
std::string stage_kernel_name(std::size_t stage);

/// A stage, and which pairs share memory. Pairs that share it have one name and are one argument. In place,
/// stages follow each other in a walk (walk_writes_to).
struct StoredStage {
  const Integrator& integrator;
  std::size_t number;
  Storage storage;

  const Stage& stage() const { return integrator.stages[number]; }
  /// The arrays that hold `pair` until the stage.
  Pair stored(Pair pair) const { return storage_of(integrator, pair, storage); }
  /// The arrays that the stage writes `pair` to.
  Pair written(Pair pair) const {
    return storage == Storage::in_place ? walk_writes_to(integrator, number, pair) : stored(pair);
  }
};

/// The stored pairs whose buffers are the first arguments of the stage's kernel, in their order. The step
/// parameters follow (kernels/parameters.h), then what the topology needs.
std::vector<Pair> stage_arguments(const StoredStage& stage);

}  // namespace mssim
