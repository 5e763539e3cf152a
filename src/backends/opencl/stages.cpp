#include "backends/opencl/stages.h"

#include <cstring>
#include <stdexcept>

#include "backends/layouts/node_arrays.h"
#include "backends/opencl/programs.h"
#include "integrators/coefficients.h"
#include "kernels/parameters.h"

namespace mssim {
namespace {

constexpr Storage storage = Storage::separate;

/// The sizes of all buffers, bytes.
std::vector<std::uint64_t> buffers_of(const Integrator& integrator, const StageKernels& kernels) {
  std::vector<std::uint64_t> bytes(stored_pairs(integrator, storage).size(),
                                   kernels.layout.floats * sizeof(float));
  for (const std::string_view argument : kernels.arguments) bytes.push_back(argument.size());
  return bytes;
}

}  // namespace

OpenclBackend::OpenclBackend(const System& system, const Integrator& integrator, double dt_s,
                             const OpenclDevice& device, DeviceMemory memory, const PairLayout& layout,
                             std::span<const std::uint64_t> buffers)
    : layout_(layout), queue_(device, memory) {
  require_memory(device, buffers);
  StepParameters step{};
  step.surroundings = surroundings_of(system);
  const Coefficients<float> coefficients = coefficients_of<float>(integrator, dt_s);
  static_assert(sizeof(coefficients) == sizeof(step.coefficients));
  std::memcpy(step.coefficients, coefficients.data(), sizeof(step.coefficients));
  add_argument(bytes_of(step));
}

void OpenclBackend::add_launch(bool swapped, cl::Kernel kernel, cl_uint argument, const WorkItems& items) {
  for (const auto& buffer : arguments_) kernel.setArg(argument++, buffer.buffer());
  launches_[swapped ? 1 : 0].push_back({std::move(kernel), items});
}

void OpenclBackend::write_state(const OpenclBuffer<float>& buffer, const PairLayout& layout,
                                const State& state, std::size_t first) const {
  opencl_call<std::runtime_error>([&] {
    buffer.write([&](std::span<float> memory) {
      const auto put = [&](std::size_t offset, std::size_t node) {
        float* const x = memory.data() + first + offset;
        write_vector(x, layout.step, state.position[node]);
        write_vector(x + layout.to_velocity, layout.step, state.velocity[node]);
      };
      for (std::size_t node = 0; node < layout.node.size(); ++node) put(layout.node[node], node);
      for (const auto& [offset, node] : layout.copies) put(offset, node);
    });
  });
}

State OpenclBackend::read_state(const OpenclBuffer<float>& buffer) const {
  return opencl_call<std::runtime_error>([&] {
    return buffer.read([&](std::span<const float> memory) {
      State state;
      for (const std::size_t offset : layout_.node) {
        const float* const x = memory.data() + offset;
        state.add(read_vector(x, layout_.step), read_vector(x + layout_.to_velocity, layout_.step));
      }
      return state;
    });
  });
}

OpenclStages::OpenclStages(const System& system, const Integrator& integrator, double dt_s,
                           const OpenclDevice& device, DeviceMemory memory, const StageKernels& kernels)
    : OpenclBackend(system, integrator, dt_s, device, memory, kernels.layout,
                    buffers_of(integrator, kernels)),
      stored_springs_(kernels.stored_springs) {
  // Zeros in the padding too, so that no arithmetic there meets a denormal number, which can be slow.
  for (const Pair pair : stored_pairs(integrator, storage))
    pairs_[index(pair)] = queue_.zeros<float>(layout_.floats);
  for (const std::string_view argument : kernels.arguments) add_argument(argument);
  const cl::Program program = queue_.build(kernels.program);
  for (const bool swapped : {false, true})
    for (std::size_t stage = 0; stage < integrator.stage_count; ++stage) {
      cl::Kernel kernel(program, stage_kernel_name(stage).c_str());
      cl_uint argument = 0;
      for (const Pair pair : stage_arguments({integrator, stage, storage}))
        kernel.setArg(argument++, arrays(pair, swapped).buffer());
      add_launch(swapped, kernel, argument, kernels.items);
    }
  warm_up(*this, system.start, 2);  // in both roles of the pairs
}

const OpenclBuffer<float>& OpenclStages::arrays(Pair pair, bool swapped) const {
  if (swapped && pair == Pair::state) return *pairs_[index(Pair::next)];
  if (swapped && pair == Pair::next) return *pairs_[index(Pair::state)];
  return *pairs_[index(pair)];
}

void OpenclStages::step(int count) {
  opencl_call<std::runtime_error>([&] {
    queue_.take_steps(count, [&](int step) -> const std::vector<Launch>& {
      return launches_[swapped_ != (step % 2 != 0) ? 1 : 0];
    });
    if (count % 2 != 0) swapped_ = !swapped_;
  });
}

}  // namespace mssim
