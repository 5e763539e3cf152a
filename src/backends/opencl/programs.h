#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "integrators/integrator.h"

namespace mssim {

// Texts of the programs of the `opencl` backend: files of kernels/, and text generated from the table of
// integrators. They depend only on the integrator and on `lanes` (nodes at a time).

/// Steps a grid: with one lane one kernel per stage of the integrator, whose work-items own a node each
/// (kernels/grid_nodes.cl); with several one kernel that takes steps, whose work-items walk over columns of
/// bands (kernels/grid_bands.cl).
std::string grid_program_text(const Integrator& integrator, int lanes);
/// Name of the kernel that takes steps in a walk.
inline constexpr const char* steps_kernel_name = "take_steps";

/// The program that steps a sliced graph with one kernel per stage of the integrator (kernels/mesh_stage.cl),
/// and the number of nodes per slice that it requires.
std::string mesh_program_text(const Integrator& integrator, int lanes);
std::size_t mesh_slice_lanes(int lanes);

/// The program that steps alike bodies (kernels/alike_stage.cl), and the number of bodies per slice.
std::string alike_program_text(const Integrator& integrator, int lanes);
std::size_t alike_slice_lanes(int lanes);

/// Name of the stage's kernel.
std::string stage_kernel_name(std::size_t stage);

/// A stage, and the pairs that share memory. Pairs that share it have one name and are one argument. In
/// place, stages follow each other in a walk (walk_writes_to).
struct StoredStage {
  const Integrator& integrator;
  std::size_t number;
  Storage storage;

  const Stage& stage() const { return integrator.stages[number]; }
  /// The arrays of `pair` before the stage.
  Pair stored(Pair pair) const { return storage_of(integrator, pair, storage); }
  /// The arrays that the stage writes `pair` to.
  Pair written(Pair pair) const {
    return storage == Storage::in_place ? walk_writes_to(integrator, number, pair) : stored(pair);
  }
};

/// The stored pairs whose buffers are the first arguments of the stage's kernel, in their order. The step
/// parameters follow (kernels/parameters.h), then the topology's arguments.
std::vector<Pair> stage_arguments(const StoredStage& stage);

}  // namespace mssim
