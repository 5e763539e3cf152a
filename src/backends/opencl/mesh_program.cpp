#include "backends/opencl/mesh_program.h"

#include <sstream>

#include "backends/devices/program.h"

namespace mssim {
namespace {

/// What a kernel is given of the bodies, and what it knows of them.
struct MeshText {
  const char* parameters;
  const char* members;  ///< of Mesh
};
constexpr MeshText sliced{
    "__global const uint* restrict first_entry, __global const uint* restrict neighbour,\n"
    "    __global const float* restrict stiffness_rest, __global const float* restrict stiffness,\n"
    "    __global const float* restrict damping, __global const int* restrict held",
    "first_entry, neighbour, stiffness_rest, stiffness, damping, held"};
constexpr MeshText alike{
    "__global const uint4* restrict slices, __global const uint2* restrict springs,\n"
    "    __global const float2* restrict constants",
    "slices, springs, constants"};

std::string kernel_text(const StoredStage& stage, const MeshText& mesh) {
  const std::size_t number = stage.number;
  const std::string gathered = name_of(stage, stage.stage().gather);
  std::ostringstream text;
  text << "__kernel void " << stage_kernel_name(number) << "(" << pair_parameters(stage)
       << "__constant struct StepParameters* step,\n"
          "    __constant struct MeshParameters* parameters, "
       << mesh.parameters << ") {\n  const Mesh mesh = {" << mesh.members
       << "};\n"
          "  const uint first = (uint)get_global_id(0) * parameters->tiles_per_item;\n"
          "  const uint end = min(first + parameters->tiles_per_item, parameters->tiles);\n"
          "  for (uint number = first; number < end; ++number) {\n"
          "    const Tile tile = tile_at(number, &mesh);\n"
       << "    const Node node = load_node(" << gathered << ", tile);\n"
       << "    update_" << number << "(" << pair_names_of(stage) << "tile, node, gather_springs(" << gathered
       << ", tile, node, &mesh), &mesh, step);\n"
       << "  }\n"
          "}\n";
  return text.str();
}

/// A kernel for each stage behind what they have in common.
std::string with_kernels(std::string text, const Integrator& integrator, const MeshText& mesh) {
  for (std::size_t number = 0; number < integrator.stage_count; ++number) {
    const StoredStage stage{integrator, number, Storage::separate};
    text += update_text(stage) + kernel_text(stage, mesh);
  }
  return text;
}

}  // namespace

std::size_t mesh_slice_lanes(int lanes) {
  // Where a work-item owns one node, hardware reads the entries of 32 of them at once.
  return lanes > 1 ? static_cast<std::size_t>(lanes) : 32;
}

std::string mesh_program_text(const Integrator& integrator, int lanes) {
  return with_kernels(
      slices_program_text(
          mesh_slice_lanes(lanes), lanes,
          {"lanes.h", "records.h", "spring_law.h", "acceleration_law.h", "floor_law.h", "surroundings.h",
           "touch_floor.h", "step_parameters.h", "stage.h", "mesh_parameters.h", "mesh_stage.cl"}),
      integrator, sliced);
}

std::size_t alike_slice_lanes(int lanes) {
  // Where a work-item owns one node, slices of as many bodies as vectors hold elsewhere leave few lanes
  // empty.
  return lanes > 1 ? static_cast<std::size_t>(lanes) : 16;
}

std::string alike_program_text(const Integrator& integrator, int lanes) {
  return with_kernels(slices_program_text(alike_slice_lanes(lanes), lanes,
                                          {"lanes.h", "spring_law.h", "acceleration_law.h", "floor_law.h",
                                           "surroundings.h", "touch_floor.h", "step_parameters.h", "stage.h",
                                           "mesh_parameters.h", "alike_slices.h", "alike_stage.cl"}),
                      integrator, alike);
}

}  // namespace mssim
