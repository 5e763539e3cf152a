#include "backends/opencl/stages.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "backends/opencl/call.h"
#include "backends/opencl/program.h"
#include "integrators/coefficients.h"

namespace mssim {
namespace {

/// Launches between two waits for the queue to run empty: waiting is rare enough to cost nothing, and a
/// driver never has to hold more unfinished commands than this.
constexpr std::size_t longest_queue = 256;

constexpr bool all_swap_state() {
  for (const Integrator& integrator : integrators)
    if (!swaps_state(integrator, Storage::separate)) return false;
  return true;
}
static_assert(all_swap_state(), "step() swaps the two pairs after every step");

/// `state` and `next` change roles after every step.
Pair role(Pair pair, bool swapped) {
  if (swapped && pair == Pair::state) return Pair::next;
  if (swapped && pair == Pair::next) return Pair::state;
  return pair;
}

StepParameters step_parameters_of(const System& system, const Integrator& integrator, double dt_s) {
  StepParameters step{};
  step.surroundings = surroundings_of(system);
  const Coefficients<float> coefficients = coefficients_of<float>(integrator, dt_s);
  static_assert(sizeof(coefficients) == sizeof(step.coefficients));
  std::memcpy(step.coefficients, coefficients.data(), sizeof(step.coefficients));
  return step;
}

}  // namespace

OpenclStages::OpenclStages(const System& system, const Integrator& integrator, double dt_s,
                           const OpenclDevice& device, DeviceMemory memory, PairLayout layout,
                           std::vector<std::uint64_t> others)
    : integrator_(integrator), device_(device), memory_(memory), layout_(std::move(layout)) {
  const std::vector<Pair> stored = stored_pairs(integrator, Storage::separate);
  others.insert(others.end(), stored.size(), layout_.floats * sizeof(float));
  require_memory(device, others);

  const cl::Device cl_device(device.id, true);
  context_ = cl::Context(cl_device);
  queue_ = cl::CommandQueue(context_, cl_device);
  // Zeros in the padding too, so that no arithmetic there meets a denormal number, which can be slow.
  for (const Pair pair : stored) {
    auto& buffer = pairs_[index(pair)];
    buffer.emplace(context_, device_, memory_, layout_.floats);
    const auto mapped = buffer->map(queue_, CL_MAP_WRITE);
    std::fill(mapped.begin(), mapped.end(), 0.0F);
    buffer->unmap(queue_, mapped, CL_MAP_WRITE);
    queue_.finish();
  }
  const StepParameters step = step_parameters_of(system, integrator, dt_s);
  add_argument(std::span(&step, 1));
}

void OpenclStages::prepare(const std::string& program_text, const WorkItems& items, const State& start) {
  items_ = items;
  const cl::Program program = build_program(context_, cl::Device(device_.id, true), program_text);
  // One kernel object per stage and role of the pairs, its arguments set once and for all.
  for (const bool swapped : {false, true})
    for (std::size_t stage = 0; stage < integrator_.stage_count; ++stage) {
      cl::Kernel kernel(program, stage_kernel_name(stage).c_str());
      cl_uint argument = 0;
      for (const Pair pair : stage_arguments(integrator_.stages[stage]))
        kernel.setArg(argument++, pairs_[index(role(pair, swapped))]->buffer());
      for (const auto& buffer : arguments_) kernel.setArg(argument++, buffer.buffer());
      kernels_[swapped ? 1 : 0].push_back(kernel);
    }
  set_state(start);
  step(2);  // in both roles of the pairs
  set_state(start);
}

const OpenclBuffer<float>& OpenclStages::present() const {
  return *pairs_[index(role(Pair::state, swapped_))];
}

void OpenclStages::set_state(const State& state) {
  opencl_call<std::runtime_error>([&] {
    const auto memory = present().map(queue_, CL_MAP_WRITE);
    for (std::size_t node = 0; node < layout_.node.size(); ++node) {
      const Vec3d &x = state.position[node], &v = state.velocity[node];
      const std::array values{x.x, x.y, x.z, v.x, v.y, v.z};
      for (std::size_t i = 0; i < values.size(); ++i)
        memory[layout_.node[node] + layout_.component[i]] = static_cast<float>(values[i]);
    }
    present().unmap(queue_, memory, CL_MAP_WRITE);
    queue_.finish();
  });
}

void OpenclStages::step(int count) {
  opencl_call<std::runtime_error>([&] {
    std::size_t queued = 0;
    for (int i = 0; i < count; ++i) {
      for (const cl::Kernel& kernel : kernels_[swapped_ ? 1 : 0]) {
        queue_.enqueueNDRangeKernel(kernel, cl::NullRange, items_.global, items_.local);
        if (++queued % longest_queue == 0) queue_.finish();
      }
      swapped_ = !swapped_;
    }
    queue_.finish();
  });
}

State OpenclStages::state() const {
  return opencl_call<std::runtime_error>([&] {
    const auto memory = present().map(queue_, CL_MAP_READ);
    State state;
    for (const std::size_t node : layout_.node) {
      const auto number = [&](std::size_t i) { return double{memory[node + layout_.component[i]]}; };
      state.position.push_back({number(0), number(1), number(2)});
      state.velocity.push_back({number(3), number(4), number(5)});
    }
    present().unmap(queue_, memory, CL_MAP_READ);
    queue_.finish();
    return state;
  });
}

}  // namespace mssim
