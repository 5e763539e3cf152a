#include "backends/opencl/grid_program.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "backends/devices/program.h"
#include "model/system.h"

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

/// The pairs besides the state that a walk keeps columns of, in the order of their rings.
std::vector<Pair> ring_pairs(const Integrator& integrator) {
  std::vector<Pair> pairs = stored_pairs(integrator, Storage::in_place);
  std::erase(pairs, Pair::state);
  return pairs;
}

/// Where row 0 of a column of the arrays of `stored` begins.
std::string column_of(const Integrator& integrator, Pair stored, const std::string& column) {
  const std::string end = column + ", walk, grid)";
  if (stored == Pair::state) return "state_column(" + end;
  const std::vector<Pair> rings = ring_pairs(integrator);
  const auto ring = std::ranges::find(rings, stored) - rings.begin();
  return "ring_column(" + std::to_string(ring) + ", " + end;
}

/// Takes the stage through one column, if it is one of those that it updates or of the two before them, whose
/// springs act on them. `number`: of the stage in the launch, before `after` others.
std::string walk_stage_text(const StoredStage& stage) {
  const Integrator& integrator = stage.integrator;
  const Pair gather = stage.stored(stage.stage().gather);
  std::ostringstream text;
  text << "static inline void walk_stage_" << stage.number
       << "(int column, int number, int after, const Walk* walk, __constant struct StepParameters* step,\n"
          "    Shape grid, __global const int* restrict free_masks, __global const int* restrict is_free) {\n"
          "  const int begin = max(walk->partition.first - halo * after, 0);\n"
          "  const int end = min(walk->partition.end + halo * after, grid->columns);\n"
          "  const int start = max(begin - halo, 0);\n"
          "  if (column < start || column >= end) return;\n";
  for (const Pair pair : stage_arguments(stage))
    text << "  __global float* const " << name_of(pair) << " = " << column_of(integrator, pair, "column")
         << ";\n";
  text << "  const Column at = column_at(column, number, " << name_of(gather) << ", "
       << column_of(integrator, gather, "column + 1") << ",\n      "
       << column_of(integrator, gather, "column + 2")
       << ", walk, grid);\n"
          "  if (column == start) clear_sums(&at, grid);\n"
          "  __global const int* mask = is_free + free_masks[column] * grid->height * MSSIM_LANES;\n"
          "  Carry carry = begin_column(&at, grid);\n"
          "  for (int row = 0; row < grid->height; ++row) {\n"
          "    const Node node = load_node(at.here, row);\n"
          "    const Vector forces = walk_row(&at, node, row, &carry, "
       << (gather == Pair::state)
       << ", grid);\n"
          "    if (column < begin) continue;\n"
          "    const Tile tile = {(size_t)row * row_floats, load_aligned_mask(mask + row * MSSIM_LANES)};\n"
       << "    " << update_call(stage)
       << "forces, grid, step);\n"
          "  }\n"
          "  end_column(&at, &carry, grid);\n"
          "  if (column < begin) return;\n";
  for (std::size_t i = 0; i < pair_kinds; ++i)
    if (const Pair pair = static_cast<Pair>(i); writes_to_gather(integrator, stage.number, pair))
      text << "  fill_halo_rows(" << name_of(stage.written(pair)) << ", grid);\n";
  if (stage.number + 1 == integrator.stage_count)
    text << "  if (after == 0) leave_ghosts(column, walk, grid);\n";
  text << "}\n";
  return text.str();
}

std::string walk_kernel_text(const Integrator& integrator) {
  const std::string stages = std::to_string(integrator.stage_count);
  std::ostringstream text;
  text
      << "\n__kernel void " << steps_kernel_name()
      << "(__global float* state, __global float* ghosts, int swapped, int steps,\n"
         "    __constant struct StepParameters* step, __constant struct GridParameters* parameters,\n"
         "    __global const int* restrict free_masks, __global const int* restrict is_free, __global float* "
         "rings,\n    __global float* sums) {\n"
      << "  const struct GridParameters copy = *parameters;\n  const struct GridParameters* const grid = "
         "&copy;\n"
      << "  const Walk walk = walk_of((int)get_global_id(0), (int)get_global_size(0), swapped, "
      << ring_pairs(integrator).size()
      << ", state, ghosts,\n      rings, sums, grid);\n"
         "  const int last = steps * "
      << stages
      << " - 1;\n"
         "  const int end = walk.partition.end + halo * last;\n"
         "  for (int head = max(walk.partition.first - halo * (last + 1), 0); head < end; ++head)\n"
         "    for (int first = 0; first <= last; first += "
      << stages << ") {\n";
  for (std::size_t number = 0; number < integrator.stage_count; ++number)
    text << "      walk_stage_" << number << "(head - halo * (first + " << number << "), first + " << number
         << ", last - first - " << number << ", &walk, step, grid, free_masks, is_free);\n";
  text << "    }\n}\n";
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
    text += update_text(stage) + (walks ? walk_stage_text(stage) : nodes_kernel_text(stage));
  }
  if (walks) text += walk_kernel_text(integrator);
  return text;
}

std::string steps_kernel_name() { return "take_steps"; }

}  // namespace mssim
