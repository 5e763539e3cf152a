#include "backends/opencl/programs.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "backends/devices/device_queue.h"
#include "model/system.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::array<std::string_view, pair_kinds> pair_names{"state", "next", "trial_a", "trial_b"};
std::string name(Slot slot) { return std::string(name_of(slot)); }

/// The name of the arrays of `stored` in kernels.
std::string name_of(Pair stored) { return std::string(pair_names[index(stored)]); }

/// The sum of an assignment, the last term first, so the large first term is added last.
std::string sum_of_terms(const Assignment& assignment, std::size_t stage, std::size_t number) {
  const auto factor = [&](std::size_t term) {
    return fmt::format("(Real)(step->coefficients[{}][{}][{}])", stage, number, term);
  };
  const std::size_t last = term_count(assignment) - 1;
  std::string sum = "times(" + factor(last) + ", " + name(assignment.terms[last].slot) + ")";
  for (std::size_t term = last; term-- > 1;)
    sum = "times_plus(" + factor(term) + ", " + name(assignment.terms[term].slot) + ", " + sum + ")";
  if (last > 0) sum = "plus(" + name(assignment.terms[0].slot) + ", " + sum + ")";
  return sum;
}

/// Does the stage write into the arrays of `stored`?
bool writes_stored(const StoredStage& stage, Pair stored) {
  for (std::size_t i = 0; i < pair_kinds; ++i)
    if (const Pair pair = static_cast<Pair>(i); stage.written(pair) == stored && writes(stage.stage(), pair))
      return true;
  return false;
}

/// The pairs of stage_arguments as parameters, and as arguments of a call, each followed by a comma.
std::string pair_parameters(const StoredStage& stage) {
  std::string text;
  for (const Pair pair : stage_arguments(stage))
    text += fmt::format("__global {}float* restrict {}, ", writes_stored(stage, pair) ? "" : "const ",
                        name_of(pair));
  return text;
}

/// The call that reads or writes the slot's memory; kernels/*_stage.cl define these functions.
std::string access(const char* what, Slot slot, Pair arrays, const std::string& value = "") {
  return fmt::format("{}_part({}{}, {}, tile, shape)", what, value, name_of(arrays), index(slot) % 2);
}
Pair pair_of(Slot slot) { return static_cast<Pair>(index(slot) / 2); }

/// `update_N`: the assignments of stage N for the nodes of a tile, after the sum of their springs. Its
/// parameters are the pairs, the tile, its nodes, the spring forces per mass, the shape of the topology and
/// the step parameters. The topology must define Tile, Shape, load_part and store_part.
std::string update_text(const StoredStage& stored_stage) {
  const auto& [integrator, number, storage] = stored_stage;
  const Stage& stage = stored_stage.stage();
  const Slot x = position_slot(stage.gather), v = velocity_slot(stage.gather);
  std::ostringstream text;
  text << "\n/* " << integrator.name << ", stage " << number << " */\n"
       << "MSSIM_INLINE void update_" << number << "(" << pair_parameters(stored_stage)
       << "Tile tile, Node node, Vector spring_forces, Shape shape, __constant struct StepParameters* step) "
          "{\n"
       << "  Vector " << name(x) << " = node.x, " << name(v) << " = node.v;\n"
       << "  Vector a = acceleration(spring_forces, node.v, tile.free, step);\n";
  for (std::size_t i = 0; i < slot_kinds; ++i)
    if (const Slot slot = static_cast<Slot>(i); slot != Slot::a && slot != x && slot != v) {
      if (i < memory_slots && reads(stage, slot))
        text << "  Vector " << name(slot) << " = " << access("load", slot, stored_stage.stored(pair_of(slot)))
             << ";\n";
      else if (writes(stage, slot))
        text << "  Vector " << name(slot) << ";\n";
    }
  for (std::size_t assignment = 0; assignment < assignment_count(stage); ++assignment)
    text << "  " << name(stage.assignments[assignment].out) << " = "
         << sum_of_terms(stage.assignments[assignment], number, assignment) << ";\n";
  if (number + 1 == integrator.stage_count)
    text << "  touch_floor(&" << name(Slot::x_next) << ", &" << name(Slot::v_next)
         << ", tile.free, &step->surroundings);\n";
  for (std::size_t i = 0; i < memory_slots; ++i)
    if (const Slot slot = static_cast<Slot>(i); writes(stage, slot))
      text << "  " << access("store", slot, stored_stage.written(pair_of(slot)), name(slot) + ", ") << ";\n";
  text << "}\n";
  return text.str();
}

constexpr bool is(const GridSpring& spring, int rows, int columns, GridSpringKind kind) {
  return spring.rows == rows && spring.columns == columns && spring.kind == kind;
}
static_assert(grid_stencil.size() == 6 && is(grid_stencil[0], 1, 0, structural) &&
                  is(grid_stencil[1], 0, 1, structural) && is(grid_stencil[2], 1, 1, shear) &&
                  is(grid_stencil[3], -1, 1, shear) && is(grid_stencil[4], 2, 0, bending) &&
                  is(grid_stencil[5], 0, 2, bending),
              "kernels/grid_bands.cl walks over these springs");

/// Both ends of every spring of the stencil, separately.
std::string gather_springs_text() {
  std::ostringstream text;
  text << "static inline Vector gather_springs(__global const float* restrict pair, Tile tile, Node node, "
          "Shape grid) {\n"
          "  Vector sum = no_vector(), on_other = no_vector();\n";
  for (const GridSpring& spring : grid_stencil)
    for (const int end : {1, -1}) {
      const std::string other = fmt::format("{}, {}", end * spring.rows, end * spring.columns);
      text << "  add_spring(&sum, &on_other, node, load_node(pair, tile, " << other
           << ", grid), is_on_cloth(tile, " << other << ", grid), " << grid_spring_kinds[spring.kind].name
           << ", grid);\n";
    }
  text << "  return sum;\n}\n";
  return text.str();
}

/// "update_N(pairs, tile, node, ", to which the forces are added.
std::string update_call(const StoredStage& stage) {
  std::string text = fmt::format("update_{}(", stage.number);
  for (const Pair pair : stage_arguments(stage)) text += name_of(pair) + ", ";
  return text + "tile, node, ";
}

std::string nodes_kernel_text(const StoredStage& stage) {
  const std::string gathered = name_of(stage.stored(stage.stage().gather));
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

/// The pairs other than the state of which a walk keeps columns, in the order of their rings.
std::vector<Pair> ring_pairs(const Integrator& integrator) {
  std::vector<Pair> pairs = stored_pairs(integrator, Storage::in_place);
  std::erase(pairs, Pair::state);
  return pairs;
}

/// The expression for row 0 of a column of the arrays of `stored`.
std::string column_of(const Integrator& integrator, Pair stored, const std::string& column) {
  const std::string end = column + ", walk, grid)";
  if (stored == Pair::state) return "state_column(" + end;
  const std::vector<Pair> rings = ring_pairs(integrator);
  const auto ring = std::ranges::find(rings, stored) - rings.begin();
  return fmt::format("ring_column({}, {}", ring, end);
}

/// Executes the stage in one column, if it updates that or one of the next two, on which its springs act.
/// `number`: index of the stage in the launch; `after`: number of later stages.
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
      << "\n__kernel void " << steps_kernel_name
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

/// Parameters of a kernel for bodies.
struct MeshText {
  const char* parameters;
  const char* members;  ///< of Mesh
};
constexpr MeshText sliced{
    "__global const uint* restrict first_entry, __global const uint* restrict neighbour,\n"
    "    __global const float* restrict stiffness_rest, __global const float* restrict constants,\n"
    "    __global const int* restrict held",
    "first_entry, neighbour, stiffness_rest, constants, held"};
constexpr MeshText alike{
    "__global const uint4* restrict slices, __global const uint2* restrict springs,\n"
    "    __global const struct SpringFloats* restrict constants",
    "slices, springs, constants"};

std::string kernel_text(const StoredStage& stage, const MeshText& mesh) {
  const std::size_t number = stage.number;
  const std::string gathered = name_of(stage.stored(stage.stage().gather));
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
       << "    " << update_call(stage) << "gather_springs(" << gathered
       << ", tile, node, &mesh), &mesh, step);\n"
       << "  }\n"
          "}\n";
  return text.str();
}

/// The common text followed by a kernel for each stage.
std::string with_kernels(std::string text, const Integrator& integrator, const MeshText& mesh) {
  for (std::size_t number = 0; number < integrator.stage_count; ++number) {
    const StoredStage stage{integrator, number, Storage::separate};
    text += update_text(stage) + kernel_text(stage, mesh);
  }
  return text;
}

}  // namespace

std::string stage_kernel_name(std::size_t stage) { return fmt::format("stage_{}", stage); }

std::vector<Pair> stage_arguments(const StoredStage& stage) {
  std::vector<Pair> pairs;
  const Stage& its = stage.stage();
  for (std::size_t i = 0; i < pair_kinds; ++i) {
    const Pair pair = static_cast<Pair>(i);
    if (its.gather == pair || reads(its, position_slot(pair)) || reads(its, velocity_slot(pair)))
      add_once(pairs, stage.stored(pair));
    if (writes(its, pair)) add_once(pairs, stage.written(pair));
  }
  return pairs;
}

std::string grid_program_text(const Integrator& integrator, int lanes) {
  const bool walks = lanes > 1;
  std::string text =
      program_text(lanes, {"lanes.h", "spring_constants.h", "spring_law.h", "node_laws.h", "parameters.h",
                           "stage.h", "grid_spring.h", walks ? "grid_bands.cl" : "grid_nodes.cl"});
  std::string kinds;
  for (std::size_t kind = 0; kind < grid_spring_kinds.size(); ++kind)
    kinds += fmt::format("#define {} {}\n", grid_spring_kinds[kind].name, kind);
  text = kinds + text;
  if (!walks) text += gather_springs_text();
  for (std::size_t number = 0; number < integrator.stage_count; ++number) {
    const StoredStage stage{integrator, number, walks ? Storage::in_place : Storage::separate};
    text += update_text(stage) + (walks ? walk_stage_text(stage) : nodes_kernel_text(stage));
  }
  if (walks) text += walk_kernel_text(integrator);
  return text;
}

std::size_t mesh_slice_lanes(int lanes) {
  // If a work-item owns one node, hardware reads the entries of 32 of them at once.
  return lanes > 1 ? static_cast<std::size_t>(lanes) : 32;
}

std::string mesh_program_text(const Integrator& integrator, int lanes) {
  return with_kernels(slices_program_text(mesh_slice_lanes(lanes), lanes,
                                          {"lanes.h", "records.h", "spring_constants.h", "spring_law.h",
                                           "node_laws.h", "parameters.h", "stage.h", "mesh_stage.cl"}),
                      integrator, sliced);
}

std::size_t alike_slice_lanes(int lanes) {
  // If a work-item owns one node, slices of as many bodies as vectors on CPUs have lanes leave few lanes
  // empty.
  return lanes > 1 ? static_cast<std::size_t>(lanes) : 16;
}

std::string alike_program_text(const Integrator& integrator, int lanes) {
  return with_kernels(slices_program_text(alike_slice_lanes(lanes), lanes,
                                          {"lanes.h", "spring_constants.h", "spring_law.h", "node_laws.h",
                                           "parameters.h", "stage.h", "alike_stage.cl"}),
                      integrator, alike);
}

}  // namespace mssim
