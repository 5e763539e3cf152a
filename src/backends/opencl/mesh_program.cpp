#include "backends/opencl/mesh_program.h"

#include <sstream>

#include "backends/devices/program.h"

namespace mssim {
namespace {

std::string kernel_text(const StoredStage& stage) {
  const std::size_t number = stage.number;
  const std::string gathered = name_of(stage, stage.stage().gather);
  std::ostringstream text;
  text << "__kernel void " << stage_kernel_name(number) << "(" << pair_parameters(stage)
       << "__constant struct StepParameters* step,\n"
          "    __constant struct MeshParameters* parameters, __global const uint* restrict first_entry,\n"
          "    __global const uint* restrict neighbour, __global const float* restrict stiffness_rest,\n"
          "    __global const float* restrict stiffness, __global const float* restrict damping,\n"
          "    __global const int* restrict held) {\n"
          "  const Mesh mesh = {first_entry, neighbour, stiffness_rest, stiffness, damping, held};\n"
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

}  // namespace

std::size_t mesh_slice_lanes(int lanes) {
  // Where a work-item owns one node, hardware reads the entries of 32 of them at once.
  return lanes > 1 ? static_cast<std::size_t>(lanes) : 32;
}

std::string mesh_program_text(const Integrator& integrator, int lanes) {
  std::string text =
      "#define MSSIM_SLICE " + std::to_string(mesh_slice_lanes(lanes)) + "\n" +
      program_text(lanes, {"lanes.h", "records.h", "spring_law.h", "acceleration_law.h", "floor_law.h",
                           "surroundings.h", "touch_floor.h", "step_parameters.h", "stage.h",
                           "mesh_parameters.h", "mesh_stage.cl"});
  for (std::size_t number = 0; number < integrator.stage_count; ++number) {
    const StoredStage stage{integrator, number, Storage::separate};
    text += update_text(stage) + kernel_text(stage);
  }
  return text;
}

}  // namespace mssim
