#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "backends/devices/device.h"
#include "integrators/integrator.h"

namespace mssim {

/// The text of OpenCL programs, which consists of files in kernels/ and of what is generated from the table
/// of integrators. It depends on the integrator and on `lanes` alone (nodes or springs side by side in one
/// number: 1, 4, 8 or 16), so that a driver's cache of built programs serves every scene.

/// Text of the files in kernels/, in this order, for that many lanes. Throws std::runtime_error when one is
/// missing.
std::string program_text(int lanes, std::initializer_list<const char*> files);
/// The program text where nodes lie in slices of so many.
std::string slices_program_text(std::size_t slice_nodes, int lanes, std::initializer_list<const char*> files);

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
/// parameters follow (kernels/step_parameters.h), then what the topology needs.
std::vector<Pair> stage_arguments(const StoredStage& stage);

/// These pairs as parameters, and as arguments of a call, each with a comma behind it.
std::string pair_parameters(const StoredStage& stage);
std::string pair_names_of(const StoredStage& stage);

/// The name by which kernels know the arrays of `stored`, and those that hold `pair` until the stage.
std::string name_of(Pair stored);
std::string name_of(const StoredStage& stage, Pair pair);

/// `update_N`: the assignments of stage N for the nodes of a tile, once their springs are summed. It takes
/// the pairs, the tile, its nodes, the spring forces per mass, the shape of the topology and the step
/// parameters, and asks the topology for Tile, Shape, load_position, load_velocity, store_position and
/// store_velocity.
std::string update_text(const StoredStage& stage);

/// The built program. Square roots and divisions are correctly rounded where the device can do that.
/// Throws Unavailable with the compiler's first complaint.
cl::Program build_program(const cl::Context& context, const cl::Device& device, const std::string& text);

}  // namespace mssim
