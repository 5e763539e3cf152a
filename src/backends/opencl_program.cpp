#include "backends/opencl_program.h"

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "backends/backend.h"
#include "backends/opencl_stencil.h"
#include "model/data_folder.h"

namespace mssim {
namespace {

constexpr std::array<std::string_view, pair_kinds> pair_names{"state", "next", "trial_a", "trial_b"};
constexpr std::array<std::string_view, slot_kinds> slot_names{
    "x", "v", "x_next", "v_next", "x_a", "v_a", "x_b", "v_b", "a", "temporary_1", "temporary_2"};

std::string name(Pair pair) { return std::string(pair_names[index(pair)]); }
std::string name(Slot slot) { return std::string(slot_names[index(slot)]); }

std::string kernel_file(const char* file) {
  const auto path = data_folder() / "kernels" / file;
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || text.str().empty())
    throw std::runtime_error("cannot read " + path.string() + ", which the OpenCL backends are made from");
  return text.str();
}

bool writes_pair(const Stage& stage, Pair pair) {
  return writes(stage, position_slot(pair)) || writes(stage, velocity_slot(pair));
}

bool uses_pair(const Stage& stage, Pair pair) {
  return stage.gather == pair || writes_pair(stage, pair) || reads(stage, position_slot(pair)) ||
         reads(stage, velocity_slot(pair));
}

/// Where the slot's three planes begin for the work-item's nodes, as an expression.
std::string address(Slot slot) {
  const std::size_t pair = index(slot) / 2;
  const bool velocity = index(slot) % 2 == 1;
  return std::string(pair_names[pair]) + " + site.first" + (velocity ? " + 3 * grid->plane" : "");
}

/// A line's sum, the last term first, so that the large first term is added last.
std::string sum_of_terms(const Line& line, std::size_t stage, std::size_t number) {
  const auto factor = [&](std::size_t term) {
    return "(Real)(grid->coefficients[" + std::to_string(stage) + "][" + std::to_string(number) + "][" +
           std::to_string(term) + "])";
  };
  const std::size_t last = term_count(line) - 1;
  std::string sum = "times(" + factor(last) + ", " + name(line.terms[last].slot) + ")";
  for (std::size_t term = last; term-- > 1;)
    sum = "times_plus(" + factor(term) + ", " + name(line.terms[term].slot) + ", " + sum + ")";
  if (last > 0) sum = "plus(" + name(line.terms[0].slot) + ", " + sum + ")";
  return sum;
}

/// The stage's kernel and what it does with the nodes of one site once their springs are summed.
std::string stage_text(const Integrator& integrator, std::size_t number, bool walks) {
  const Stage& stage = integrator.stages[number];
  const Slot x = position_slot(stage.gather), v = velocity_slot(stage.gather);
  const std::string suffix = std::to_string(number);
  std::string parameters, arguments;
  for (const Pair pair : stage_arguments(stage)) {
    parameters += std::string("__global ") + (writes_pair(stage, pair) ? "" : "const ") + "float* restrict " +
                  name(pair) + ", ";
    arguments += name(pair) + ", ";
  }

  std::ostringstream text;
  text << "\n/* " << integrator.name << ", stage " << number << " */\n"
       << "static inline void update_" << suffix << "(" << parameters
       << "Site site, Node node, Vector spring_forces, __constant struct GridParameters* grid) {\n"
       << "  Vector " << name(x) << " = node.x, " << name(v) << " = node.v;\n"
       << "  Vector a = acceleration(spring_forces, node.v, site, grid);\n";
  for (std::size_t i = 0; i < slot_kinds; ++i)
    if (const Slot slot = static_cast<Slot>(i); slot != Slot::a && slot != x && slot != v) {
      if (i < memory_slots && reads(stage, slot))
        text << "  Vector " << name(slot) << " = load_vector_aligned(" << address(slot)
             << ", grid->plane);\n";
      else if (writes(stage, slot))
        text << "  Vector " << name(slot) << ";\n";
    }
  for (std::size_t line = 0; line < line_count(stage); ++line)
    text << "  " << name(stage.lines[line].out) << " = " << sum_of_terms(stage.lines[line], number, line)
         << ";\n";
  if (number + 1 == integrator.stage_count)
    text << "  touch_floor(&" << name(Slot::x_next) << ", &" << name(Slot::v_next) << ", site, grid);\n";
  for (std::size_t i = 0; i < memory_slots; ++i)
    if (const Slot slot = static_cast<Slot>(i); writes(stage, slot))
      text << "  store_vector_aligned(" << name(slot) << ", " << address(slot) << ", grid->plane);\n";
  text << "}\n"
       << "__kernel void " << stage_kernel_name(number) << "(" << parameters
       << "__constant struct GridParameters* grid, __global const int* restrict pin_rows,\n"
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
         << "      const Node node = load_node(" << name(stage.gather) << ", site, 0, 0, grid);\n"
         << "      const Vector forces = walk_springs(" << name(stage.gather)
         << ", site, node, &carry, sums, grid);\n"
         << "      if (row >= first_row) update_" << suffix << "(" << arguments
         << "site, node, forces, grid);\n"
         << "    }\n"
            "  }\n";
  else
    text << "  const Site site = site_at((int)get_global_id(1), (int)get_global_id(0), grid, pin_rows, "
            "pins);\n"
         << "  const Node node = load_node(" << name(stage.gather) << ", site, 0, 0, grid);\n"
         << "  update_" << suffix << "(" << arguments << "site, node, gather_springs(" << name(stage.gather)
         << ", site, node, grid), grid);\n";
  text << "}\n";
  return text.str();
}

}  // namespace

std::string stage_kernel_name(std::size_t stage) { return "stage_" + std::to_string(stage); }

std::vector<Pair> stage_arguments(const Stage& stage) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < pair_kinds; ++i)
    if (uses_pair(stage, static_cast<Pair>(i))) pairs.push_back(static_cast<Pair>(i));
  return pairs;
}

bool grid_program_walks(int lanes) { return lanes > 1; }

std::string grid_program_text(const Integrator& integrator, int lanes) {
  std::string text = "#define MSSIM_LANES " + std::to_string(lanes) + "\n";
  for (const char* file : {"lanes.h", "spring_law.h", "floor_law.h", "grid_parameters.h", "grid_stage.cl"})
    text += kernel_file(file);
  const bool walks = grid_program_walks(lanes);
  text += walks ? walk_springs_text() : gather_springs_text();
  for (std::size_t stage = 0; stage < integrator.stage_count; ++stage)
    text += stage_text(integrator, stage, walks);
  return text;
}

std::string packed_springs_program_text(int lanes) {
  std::string text = "#define MSSIM_LANES " + std::to_string(lanes) + "\n";
  for (const char* file : {"lanes.h", "records.h", "spring_law.h", "packed_springs.cl"})
    text += kernel_file(file);
  return text;
}

cl::Program build_program(const cl::Context& context, const cl::Device& device, const std::string& text) {
  const bool exact =
      (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  cl::Program program(context, text);
  try {
    program.build(device, exact ? "-cl-fp32-correctly-rounded-divide-sqrt" : "");
  } catch (const cl::BuildError& error) {
    std::string log = error.getBuildLog().empty() ? "" : error.getBuildLog().front().second;
    log = log.substr(0, log.find('\n', log.find("error")));
    throw Unavailable(opencl_failure(error.what(), error.err()) + " on " + device.getInfo<CL_DEVICE_NAME>() +
                      ": " + log);
  }
  return program;
}

}  // namespace mssim
