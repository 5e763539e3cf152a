#include "backends/opencl/grid_program.h"

#include <sstream>

#include "backends/opencl/program.h"
#include "backends/opencl/stencil.h"

namespace mssim {
namespace {

std::string kernel_text(const Stage& stage, std::size_t number, bool walks) {
  const std::string gathered = gathered_name(stage);
  const std::string update = "update_" + std::to_string(number) + "(" + pair_names_of(stage) + "site, node, ";
  std::ostringstream text;
  text << "__kernel void " << stage_kernel_name(number) << "(" << pair_parameters(stage)
       << "__constant struct StepParameters* step,\n"
          "    __constant struct GridParameters* grid, __global const int* restrict pin_rows,\n"
          "    __global const int* restrict pins"
       << (walks ? ", __global float* restrict sums" : "") << ") {\n";
  if (walks)
    text << "  const int block = (int)get_global_id(0);\n"
            "  const int first_row = block * grid->block_rows;\n"
            "  const int end_row = min(first_row + grid->block_rows, grid->rows);\n"
            "  sums += block * 9 * grid->stride;\n"
            "  int row = max(first_row - 2, 0);\n"
            "  clear_sums(sums, row, grid);\n"
            "  for (; row < end_row; ++row) {\n"
            "    Carry carry;\n"
            "    clear_carry(&carry);\n"
            "    for (int column = 0; column < grid->columns; column += MSSIM_LANES) {\n"
            "      const Site site = site_at(row, column, grid, pin_rows, pins);\n"
         << "      const Node node = load_node(" << gathered << ", site, 0, 0, grid);\n"
         << "      const Vector forces = walk_springs(" << gathered << ", site, node, &carry, sums, grid);\n"
         << "      if (row >= first_row) " << update << "forces, grid, step);\n"
         << "    }\n"
            "  }\n";
  else
    text << "  const Site site = site_at((int)get_global_id(1), (int)get_global_id(0), grid, pin_rows, "
            "pins);\n"
         << "  const Node node = load_node(" << gathered << ", site, 0, 0, grid);\n"
         << "  " << update << "gather_springs(" << gathered << ", site, node, grid), grid, step);\n";
  text << "}\n";
  return text.str();
}

}  // namespace

bool grid_program_walks(int lanes) { return lanes > 1; }

std::string grid_program_text(const Integrator& integrator, int lanes) {
  std::string text =
      program_text(lanes, {"lanes.h", "spring_law.h", "floor_law.h", "surroundings.h", "step_parameters.h",
                           "stage.h", "grid_parameters.h", "grid_stage.cl"});
  const bool walks = grid_program_walks(lanes);
  text += walks ? walk_springs_text() : gather_springs_text();
  for (std::size_t stage = 0; stage < integrator.stage_count; ++stage)
    text += update_text(integrator, stage) + kernel_text(integrator.stages[stage], stage, walks);
  return text;
}

}  // namespace mssim
