#include "backends/opencl/stages.h"

#include <stdexcept>
#include <utility>

#include "backends/devices/call.h"
#include "backends/devices/program.h"
#include "backends/opencl/step_parameters.h"

namespace mssim {
namespace {

/// `state` and `next` change roles after every step.
Pair role(Pair pair, bool swapped) {
  if (swapped && pair == Pair::state) return Pair::next;
  if (swapped && pair == Pair::next) return Pair::state;
  return pair;
}

}  // namespace

OpenclStages::OpenclStages(const System& system, const Integrator& integrator, double dt_s,
                           const OpenclDevice& device, DeviceMemory memory, PairLayout layout,
                           std::vector<std::uint64_t> others)
    : integrator_(integrator), layout_(std::move(layout)), queue_(device, memory) {
  const std::vector<Pair> stored = stored_pairs(integrator, storage);
  others.insert(others.end(), stored.size(), layout_.floats * sizeof(float));
  require_memory(device, others);

  // Zeros in the padding too, so that no arithmetic there meets a denormal number, which can be slow.
  for (const Pair pair : stored) pairs_[index(pair)] = queue_.zeros<float>(layout_.floats);
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
      for (const Pair pair : stage_arguments({integrator_, stage, storage}))
        kernel.setArg(argument++, arrays(pair, swapped).buffer());
      for (const auto& buffer : arguments_) kernel.setArg(argument++, buffer.buffer());
      launches_[swapped ? 1 : 0].push_back({kernel, items});
    }
  warm_up(*this, start, 2);  // in both roles of the pairs
}

const OpenclBuffer<float>& OpenclStages::arrays(Pair pair, bool swapped) const {
  return *pairs_[index(role(pair, swapped))];
}

void OpenclStages::set_state(const State& state) {
  opencl_call<std::runtime_error>(
      [&] { write_state(queue_, arrays(Pair::state, swapped_), layout_, state); });
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
  return opencl_call<std::runtime_error>(
      [&] { return read_state(queue_, arrays(Pair::state, swapped_), layout_); });
}

}  // namespace mssim
