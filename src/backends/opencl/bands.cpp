#include "backends/opencl/bands.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "backends/devices/buffer.h"
#include "backends/devices/call.h"
#include "backends/devices/device_queue.h"
#include "backends/opencl/band_shape.h"
#include "backends/opencl/grid_arguments.h"
#include "backends/opencl/grid_program.h"
#include "backends/opencl/step_parameters.h"

namespace mssim {
namespace {

/// A cloth in bands, a launch a few steps.
class OpenclBands final : public Backend {
 public:
  OpenclBands(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s,
              const OpenclDevice& device, DeviceMemory memory, const BandShape& shape)
      : layout_(shape.state_layout()),
        ghost_layout_(shape.ghost_layout()),
        steps_per_launch_(static_cast<int>(shape.steps)),
        queue_(device, memory),
        state_((require_memory(device, bytes_of(shape, integrator)), queue_.zeros<float>(layout_.floats))),
        ghosts_(queue_.zeros<float>(2 * ghost_layout_.floats)) {
    const BandLayout& bands = shape.bands;
    GridParameters parameters = grid_parameters_of(system, grid);
    parameters.height = static_cast<int>(bands.height);
    parameters.ghosts = static_cast<int>(shape.ghosts);
    parameters.ring = static_cast<int>(shape.ring());
    const auto offset = [&](std::size_t row) {
      return row % bands.height * bands.lanes + row / bands.height;
    };
    std::vector<cl_int> unpinned(bands.height * bands.lanes, 0);
    for (std::size_t row = 0; row < bands.rows; ++row) unpinned[offset(row)] = -1;
    Masks free(bands.columns, unpinned.size());
    for (const std::uint32_t pin : system.pins)
      free.mask(pin % bands.columns, unpinned)[offset(pin / bands.columns)] = 0;
    // All columns without a pin share the last mask.
    const auto last = static_cast<cl_int>(free.numbers.size() / unpinned.size());
    free.numbers.insert(free.numbers.end(), unpinned.begin(), unpinned.end());
    std::replace(free.mask_of.begin(), free.mask_of.end(), -1, last);

    const StepParameters step = step_parameters_of(system, integrator, dt_s);
    add_argument(std::span(&step, 1));
    add_argument(std::span<const GridParameters>(&parameters, 1));
    add_argument(std::span<const cl_int>(free.mask_of));
    add_argument(std::span<const cl_int>(free.numbers));
    // Zeros in the padding, so that no arithmetic there meets a denormal number, which can be slow.
    arguments_.push_back(queue_.zeros<std::byte>(ring_bytes(shape, integrator)));
    arguments_.push_back(queue_.array<std::byte>(sum_bytes(shape)));
    prepare(grid_program_text(integrator, static_cast<int>(bands.lanes)), shape.partitions);
    warm_up(*this, system.start, 2 * steps_per_launch_);
  }

  void set_state(const State& state) override {
    opencl_call<std::runtime_error>([&] {
      write_state(queue_, state_, layout_, state);
      write_state(queue_, ghosts_, ghost_layout_, state, swapped_ ? ghost_layout_.floats : 0);
    });
  }
  void step(int count) override {
    opencl_call<std::runtime_error>([&] {
      const int launches = (count + steps_per_launch_ - 1) / steps_per_launch_;
      queue_.take_steps(launches, [&](int launch) {
        const int steps = std::min(steps_per_launch_, count - launch * steps_per_launch_);
        const bool swapped = swapped_ != (launch % 2 != 0);
        return std::span(&launches_[swapped ? 1 : 0][static_cast<std::size_t>(steps) - 1], 1);
      });
      if (launches % 2 != 0) swapped_ = !swapped_;
    });
  }
  State state() const override {
    return opencl_call<std::runtime_error>([&] { return read_state(queue_, state_, layout_); });
  }
  std::string device() const override { return queue_.label(); }
  int threads() const override { return queue_.threads(); }
  int steps_per_pass() const override { return steps_per_launch_; }
  bool runs_on_host() const override { return queue_.runs_on_host(); }

 private:
  static std::uint64_t ring_bytes(const BandShape& shape, const Integrator& integrator) {
    const std::size_t pairs = stored_pairs(integrator, Storage::in_place).size() - 1;
    return shape.partitions * pairs * shape.ring() * shape.bands.column_floats() * sizeof(float);
  }
  static std::uint64_t sum_bytes(const BandShape& shape) {
    return shape.partitions * shape.ghosts / BandLayout::halo * 3 * 3 * shape.bands.height *
           shape.bands.lanes * sizeof(float);
  }
  std::array<std::uint64_t, 4> bytes_of(const BandShape& shape, const Integrator& integrator) const {
    return {layout_.floats * sizeof(float), 2 * ghost_layout_.floats * sizeof(float),
            ring_bytes(shape, integrator), sum_bytes(shape)};
  }

  template <class T>
  void add_argument(std::span<const T> values) {
    arguments_.push_back(queue_.copy_of(std::as_bytes(values)));
  }

  /// One kernel object for each number of steps and role of the ghosts, its arguments set once and for all.
  void prepare(const std::string& program_text, std::size_t partitions) {
    const cl::Program program = queue_.build(program_text);
    for (const bool swapped : {false, true})
      for (int steps = 1; steps <= steps_per_launch_; ++steps) {
        cl::Kernel kernel(program, steps_kernel_name().c_str());
        cl_uint argument = 0;
        kernel.setArg(argument++, state_.buffer());
        kernel.setArg(argument++, ghosts_.buffer());
        kernel.setArg(argument++, cl_int{swapped ? 1 : 0});
        kernel.setArg(argument++, cl_int{steps});
        for (const auto& buffer : arguments_) kernel.setArg(argument++, buffer.buffer());
        launches_[swapped ? 1 : 0].push_back({kernel, {cl::NDRange(partitions), cl::NDRange(1)}});
      }
  }

  PairLayout layout_, ghost_layout_;
  int steps_per_launch_;
  DeviceQueue queue_;
  OpenclBuffer<float> state_, ghosts_;  // ghosts: those to read and to leave, which change roles
  std::vector<OpenclBuffer<std::byte>> arguments_;
  std::array<std::vector<Launch>, 2> launches_;  // [swapped][steps - 1]
  bool swapped_ = false;                         // a launch reads the second half of the ghosts
};

}  // namespace

std::unique_ptr<Backend> make_opencl_bands(const System& system, const GridPatch& grid,
                                           const Integrator& integrator, double dt_s,
                                           const OpenclDevice& device, DeviceMemory memory, int lanes,
                                           std::optional<std::size_t> steps_in_a_launch) {
  const auto cache_bytes = cl::Device(device.id, true).getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
  return std::make_unique<OpenclBands>(system, grid, integrator, dt_s, device, memory,
                                       BandShape(grid, integrator, static_cast<std::size_t>(lanes),
                                                 device.compute_units, cache_bytes, steps_in_a_launch));
}

}  // namespace mssim
