#include "backends/devices/program.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "backends/interface/backend.h"
#include "platform/files.h"

namespace mssim {
namespace {

constexpr std::array<std::string_view, pair_kinds> pair_names{"state", "next", "trial_a", "trial_b"};
constexpr std::array<std::string_view, slot_kinds> slot_names{
    "x", "v", "x_next", "v_next", "x_a", "v_a", "x_b", "v_b", "a", "temporary_1", "temporary_2"};

std::string name(Slot slot) { return std::string(slot_names[index(slot)]); }

std::string kernel_file(const char* file) {
  const auto path = data_folder() / "kernels" / file;
  try {
    return read_file(path);
  } catch (const ReadError& error) {
    throw std::runtime_error(error.sentence(path, "the OpenCL backends are made from it"));
  }
}

bool reads_pair(const Stage& stage, Pair pair) {
  return stage.gather == pair || reads(stage, position_slot(pair)) || reads(stage, velocity_slot(pair));
}

/// The sum of an assignment, the last term first, so that the large first term is added last.
std::string sum_of_terms(const Assignment& assignment, std::size_t stage, std::size_t number) {
  const auto factor = [&](std::size_t term) {
    return "(Real)(step->coefficients[" + std::to_string(stage) + "][" + std::to_string(number) + "][" +
           std::to_string(term) + "])";
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

/// The call that reads or writes the slot's memory: kernels/*_stage.cl have these functions.
std::string access(const char* what, Slot slot, Pair arrays, const std::string& value = "") {
  const bool velocity = index(slot) % 2 == 1;
  return std::string(what) + (velocity ? "_velocity(" : "_position(") + value + name_of(arrays) +
         ", tile, shape)";
}
Pair pair_of(Slot slot) { return static_cast<Pair>(index(slot) / 2); }

}  // namespace

std::string name_of(Pair stored) { return std::string(pair_names[index(stored)]); }
std::string name_of(const StoredStage& stage, Pair pair) { return name_of(stage.stored(pair)); }

std::string pair_parameters(const StoredStage& stage) {
  std::string text;
  for (const Pair pair : stage_arguments(stage))
    text += std::string("__global ") + (writes_stored(stage, pair) ? "" : "const ") + "float* restrict " +
            name_of(pair) + ", ";
  return text;
}

std::string pair_names_of(const StoredStage& stage) {
  std::string text;
  for (const Pair pair : stage_arguments(stage)) text += name_of(pair) + ", ";
  return text;
}

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

std::string stage_kernel_name(std::size_t stage) { return "stage_" + std::to_string(stage); }

std::vector<Pair> stage_arguments(const StoredStage& stage) {
  std::vector<Pair> pairs;
  const auto add = [&](Pair arrays) {
    if (std::find(pairs.begin(), pairs.end(), arrays) == pairs.end()) pairs.push_back(arrays);
  };
  for (std::size_t i = 0; i < pair_kinds; ++i) {
    const Pair pair = static_cast<Pair>(i);
    if (reads_pair(stage.stage(), pair)) add(stage.stored(pair));
    if (writes(stage.stage(), pair)) add(stage.written(pair));
  }
  return pairs;
}

std::string program_text(int lanes, std::initializer_list<const char*> files) {
  std::string text = "#define MSSIM_LANES " + std::to_string(lanes) + "\n";
  for (const char* file : files) text += kernel_file(file);
  return text;
}

std::string slices_program_text(std::size_t slice_nodes, int lanes,
                                std::initializer_list<const char*> files) {
  return "#define MSSIM_SLICE " + std::to_string(slice_nodes) + "\n" + program_text(lanes, files);
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
