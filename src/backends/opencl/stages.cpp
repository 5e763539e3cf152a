#include "backends/opencl/stages.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "backends/devices/call.h"
#include "backends/devices/program.h"
#include "integrators/coefficients.h"

namespace mssim {
namespace {

/// Launches between two waits for the queue to run empty: waiting is rare enough to cost nothing, and a
/// driver never has to hold more unfinished commands than this.
constexpr std::size_t longest_queue = 256;

/// `state` and `next` change roles after every step, or where they share memory their ghosts do.
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
                           const OpenclDevice& device, DeviceMemory memory, Storage storage,
                           PairLayout layout, std::vector<std::uint64_t> others)
    : integrator_(integrator),
      device_(device),
      memory_(memory),
      storage_(storage),
      layout_(std::move(layout)) {
  const std::vector<Pair> stored = stored_pairs(integrator, storage);
  others.insert(others.end(), stored.size(), layout_.floats * sizeof(float));
  others.push_back(pair_kinds * layout_.ghost_floats * sizeof(float));
  require_memory(device, others);

  const cl::Device cl_device(device.id, true);
  context_ = cl::Context(cl_device);
  queue_ = cl::CommandQueue(context_, cl_device);
  // Zeros in the padding too, so that no arithmetic there meets a denormal number, which can be slow.
  const auto make_zeros = [&](std::optional<OpenclBuffer<float>>& buffer, std::size_t floats) {
    buffer.emplace(context_, device_, memory_, floats);
    buffer->write(queue_, [](std::span<float> array) { std::fill(array.begin(), array.end(), 0.0F); });
  };
  for (const Pair pair : stored) make_zeros(pairs_[index(pair)], layout_.floats);
  if (layout_.ghost_floats > 0) make_zeros(ghosts_, pair_kinds * layout_.ghost_floats);
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
      for (const Pair pair : stage_arguments({integrator_, stage, storage_}))
        kernel.setArg(argument++, arrays(pair, swapped).buffer());
      if (ghosts_) {
        kernel.setArg(argument++, ghosts_->buffer());
        kernel.setArg(argument++, cl_int{swapped ? 1 : 0});
      }
      for (const auto& buffer : arguments_) kernel.setArg(argument++, buffer.buffer());
      kernels_[swapped ? 1 : 0].push_back(kernel);
    }
  set_state(start);
  step(2);  // in both roles of the pairs
  set_state(start);
}

const OpenclBuffer<float>& OpenclStages::arrays(Pair pair, bool swapped) const {
  const Pair stored = storage_of(integrator_, pair, storage_);
  return *pairs_[index(role(stored, swapped && swaps_state(integrator_, storage_)))];
}

void OpenclStages::set_state(const State& state) {
  const auto put = [&](std::span<float> memory, std::size_t place, std::size_t node) {
    const Vec3d &x = state.position[node], &v = state.velocity[node];
    const std::array values{x.x, x.y, x.z, v.x, v.y, v.z};
    for (std::size_t i = 0; i < values.size(); ++i)
      memory[place + layout_.component[i]] = static_cast<float>(values[i]);
  };
  opencl_call<std::runtime_error>([&] {
    arrays(Pair::state, swapped_).write(queue_, [&](std::span<float> memory) {
      for (std::size_t node = 0; node < layout_.node.size(); ++node) put(memory, layout_.node[node], node);
      for (const auto& [place, node] : layout_.copies) put(memory, place, node);
    });
    if (!ghosts_) return;
    ghosts_->write(queue_, [&](std::span<float> memory) {
      const std::size_t first = index(role(Pair::state, swapped_)) * layout_.ghost_floats;
      for (const auto& [place, node] : layout_.ghosts) put(memory, first + place, node);
    });
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
    const OpenclBuffer<float>& present = arrays(Pair::state, swapped_);
    const auto memory = present.map(queue_, CL_MAP_READ);
    State state;
    for (const std::size_t node : layout_.node) {
      const auto number = [&](std::size_t i) { return double{memory[node + layout_.component[i]]}; };
      state.position.push_back({number(0), number(1), number(2)});
      state.velocity.push_back({number(3), number(4), number(5)});
    }
    present.unmap(queue_, memory, CL_MAP_READ);
    queue_.finish();
    return state;
  });
}

}  // namespace mssim
