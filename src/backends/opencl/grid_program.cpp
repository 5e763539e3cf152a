#include "backends/opencl/grid_program.h"

#include <sstream>

#include "backends/devices/program.h"
#include "model/spring.h"

namespace mssim {
namespace {

constexpr bool is(const GridSpring& spring, int rows, int columns, GridSpringKind kind) {
  return spring.rows == rows && spring.columns == columns && spring.kind == kind;
}
static_assert(grid_stencil.size() == 6 && is(grid_stencil[0], 1, 0, structural) &&
                  is(grid_stencil[1], 0, 1, structural) && is(grid_stencil[2], 1, 1, shear) &&
                  is(grid_stencil[3], -1, 1, shear) && is(grid_stencil[4], 2, 0, bending) &&
                  is(grid_stencil[5], 0, 2, bending),
              "kernels/grid_bands.cl walks over these springs");

/// Both ends of every spring of the stencil, each for itself.
std::string gather_springs_text() {
  std::ostringstream text;
  text << "static inline Vector gather_springs(__global const float* restrict pair, Tile tile, Node node, "
          "Shape grid) {\n"
          "  Vector sum = no_vector(), on_other = no_vector();\n";
  for (const GridSpring& spring : grid_stencil)
    for (const int end : {1, -1}) {
      const std::string other =
          std::to_string(end * spring.rows) + ", " + std::to_string(end * spring.columns);
      text << "  add_spring(&sum, &on_other, node, load_node(pair, tile, " << other
           << ", grid), is_on_cloth(tile, " << other << ", grid), " << grid_spring_kinds[spring.kind].name
           << ", grid);\n";
    }
  text << "  return sum;\n}\n";
  return text.str();
}

/// "update_N(pairs, tile, node, ", to which the forces are added.
std::string update_call(const StoredStage& stage) {
  return "update_" + std::to_string(stage.number) + "(" + pair_names_of(stage) + "tile, node, ";
}

std::string nodes_kernel_text(const StoredStage& stage) {
  const std::string gathered = name_of(stage, stage.stage().gather);
  std::ostringstream text;
  text
      << "__kernel void " << stage_kernel_name(stage.number) << "(" << pair_parameters(stage)
      << "__constant struct StepParameters* step,\n    __constant struct GridParameters* grid, "
         "__global const int* restrict pin_masks,\n    __global const int* restrict pins) {\n"
         "  const Tile tile = tile_at((int)get_global_id(1), (int)get_global_id(0), grid, pin_masks, pins);\n"
      << "  const Node node = load_node(" << gathered << ", tile, 0, 0, grid);\n"
      << "  " << update_call(stage) << "gather_springs(" << gathered << ", tile, node, grid), grid, step);\n"
      << "}\n";
  return text.str();
}

/// The ghosts of a pair. The state's and those of `next` change roles after every step.
std::string ghosts_of(Pair pair) {
  return "ghosts_of(" + std::to_string(index(pair)) + (index(pair) < 2 ? " ^ swapped" : "") +
         ", ghosts, &partition, grid)";
}

std::string bands_kernel_text(const StoredStage& stage) {
  const Pair gather = stage.stage().gather;
  std::ostringstream text;
  text
      << "__kernel void " << stage_kernel_name(stage.number) << "(" << pair_parameters(stage)
      << "__global float* ghosts, int swapped, __constant struct StepParameters* step,\n"
         "    __constant struct GridParameters* grid, __global const int* restrict free_masks,\n"
         "    __global const int* restrict is_free, __global float* restrict sums) {\n"
         "  const Partition partition = partition_of((int)get_global_id(0), (int)get_global_size(0), grid);\n"
         "  sums += partition.number * 3 * sums_floats(grid);\n"
         "  int column = max(partition.first - 2, 0);\n"
         "  clear_sums(sums, column, grid);\n"
         "  for (; column < partition.end; ++column) {\n"
      << "    const Column at = column_at(column, " << name_of(stage, gather) << ", " << ghosts_of(gather)
      << ", sums, &partition, grid);\n"
         "    __global const int* mask = is_free + free_masks[column] * grid->height * MSSIM_LANES;\n"
         "    Carry carry = begin_column(&at, grid);\n"
         "    for (int row = 0; row < grid->height; ++row) {\n"
         "      const Node node = load_node(at.here, row);\n"
         "      const Vector forces = walk_row(&at, node, row, &carry, grid);\n"
         "      if (column < partition.first) continue;\n"
         "      const Tile tile = {column_start(column, grid) + row * row_floats,\n"
         "                         load_aligned_mask(mask + row * MSSIM_LANES)};\n"
      << "      " << update_call(stage) << "forces, grid, step);\n"
      << "    }\n"
         "    end_column(&at, &carry, grid);\n"
         "    if (column < partition.first) continue;\n";
  for (std::size_t i = 0; i < pair_kinds; ++i)
    if (const Pair pair = static_cast<Pair>(i); writes_to_gather(stage.integrator, stage.number, pair))
      text << "    finish_column(column, " << name_of(stage, pair) << ", " << ghosts_of(pair)
           << ", &partition, grid);\n";
  text << "  }\n}\n";
  return text.str();
}

}  // namespace

bool grid_program_walks(int lanes) { return lanes > 1; }

std::string grid_program_text(const Integrator& integrator, int lanes) {
  const bool walks = grid_program_walks(lanes);
  std::string text =
      program_text(lanes, {"lanes.h", "spring_law.h", "acceleration_law.h", "floor_law.h", "surroundings.h",
                           "touch_floor.h", "step_parameters.h", "stage.h", "grid_parameters.h",
                           "grid_spring.h", walks ? "grid_bands.cl" : "grid_nodes.cl"});
  std::string kinds;
  for (std::size_t kind = 0; kind < grid_spring_kinds.size(); ++kind)
    kinds += "#define " + std::string(grid_spring_kinds[kind].name) + " " + std::to_string(kind) + "\n";
  text = kinds + text;
  if (!walks) text += gather_springs_text();
  for (std::size_t number = 0; number < integrator.stage_count; ++number) {
    const StoredStage stage{integrator, number, walks ? Storage::in_place : Storage::separate};
    text += update_text(stage) + (walks ? bands_kernel_text(stage) : nodes_kernel_text(stage));
  }
  return text;
}

}  // namespace mssim
