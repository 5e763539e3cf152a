#include "backends/opencl/stages.h"

#include <cstring>
#include <stdexcept>
#include <utility>

#include "backends/devices/call.h"
#include "backends/devices/program.h"
#include "integrators/coefficients.h"

namespace mssim {
namespace {

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
    : integrator_(integrator), storage_(storage), layout_(std::move(layout)), queue_(device, memory) {
  const std::vector<Pair> stored = stored_pairs(integrator, storage);
  others.insert(others.end(), stored.size(), layout_.floats * sizeof(float));
  others.push_back(pair_kinds * layout_.ghost_floats * sizeof(float));
  require_memory(device, others);

  // Zeros in the padding too, so that no arithmetic there meets a denormal number, which can be slow.
  for (const Pair pair : stored) pairs_[index(pair)] = queue_.zeros<float>(layout_.floats);
  if (layout_.ghost_floats > 0) ghosts_ = queue_.zeros<float>(pair_kinds * layout_.ghost_floats);
  const StepParameters step = step_parameters_of(system, integrator, dt_s);
  add_argument(std::span(&step, 1));
}

void OpenclStages::prepare(const std::string& program_text, const WorkItems& items, const State& start) {
  const cl::Program program = queue_.build(program_text);
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
      launches_[swapped ? 1 : 0].push_back({kernel, items});
    }
  warm_up(*this, start, 2);  // in both roles of the pairs
}

const OpenclBuffer<float>& OpenclStages::arrays(Pair pair, bool swapped) const {
  const Pair stored = storage_of(integrator_, pair, storage_);
  return *pairs_[index(role(stored, swapped && swaps_state(integrator_, storage_)))];
}

void OpenclStages::set_state(const State& state) {
  const auto put = [&](std::span<float> memory, std::size_t offset, std::size_t node) {
    const Vec3d &x = state.position[node], &v = state.velocity[node];
    const std::array values{x.x, x.y, x.z, v.x, v.y, v.z};
    for (std::size_t i = 0; i < values.size(); ++i)
      memory[offset + layout_.component[i]] = static_cast<float>(values[i]);
  };
  opencl_call<std::runtime_error>([&] {
    arrays(Pair::state, swapped_).write(queue_.commands(), [&](std::span<float> memory) {
      for (std::size_t node = 0; node < layout_.node.size(); ++node) put(memory, layout_.node[node], node);
      for (const auto& [offset, node] : layout_.copies) put(memory, offset, node);
    });
    if (!ghosts_) return;
    ghosts_->write(queue_.commands(), [&](std::span<float> memory) {
      const std::size_t first = index(role(Pair::state, swapped_)) * layout_.ghost_floats;
      for (const auto& [offset, node] : layout_.ghosts) put(memory, first + offset, node);
    });
  });
}

void OpenclStages::step(int count) {
  opencl_call<std::runtime_error>([&] {
    queue_.take_steps(count, [&](int step) -> const std::vector<Launch>& {
      return launches_[swapped_ != (step % 2 != 0) ? 1 : 0];
    });
    if (count % 2 != 0) swapped_ = !swapped_;
  });
}

State OpenclStages::state() const {
  return opencl_call<std::runtime_error>([&] {
    const OpenclBuffer<float>& present = arrays(Pair::state, swapped_);
    const auto memory = present.map(queue_.commands(), CL_MAP_READ);
    State state;
    for (const std::size_t node : layout_.node) {
      const auto number = [&](std::size_t i) { return double{memory[node + layout_.component[i]]}; };
      state.position.push_back({number(0), number(1), number(2)});
      state.velocity.push_back({number(3), number(4), number(5)});
    }
    present.unmap(queue_.commands(), memory, CL_MAP_READ);
    queue_.commands().finish();
    return state;
  });
}

}  // namespace mssim
