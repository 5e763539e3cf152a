#include "backends/opencl.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "backends/opencl_buffer.h"
#include "backends/opencl_call.h"
#include "backends/opencl_program.h"
#include "integrators/coefficients.h"
#include "kernels/grid_parameters.h"

namespace mssim {
namespace {

/// Launches between two waits for the queue to run empty: waiting is rare enough to cost nothing, and a
/// driver never has to hold more unfinished commands than this.
constexpr std::size_t longest_queue = 256;

constexpr std::size_t round_up(std::size_t value, std::size_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

/// Rows of a block, where work-items walk over blocks: the two further rows that each block walks over shall
/// be a small share, and yet every compute unit shall have a block, or better several, so that one that was
/// held up leaves some of its share to the others.
std::size_t block_rows(std::size_t rows, std::size_t compute_units) {
  constexpr std::size_t good_rows = 32, good_blocks_per_unit = 4;
  const std::size_t blocks =
      std::clamp(rows / good_rows, compute_units, good_blocks_per_unit * compute_units);
  return (rows + blocks - 1) / blocks;
}

/// Work-items of a launch, and what each of them does.
struct Range {
  std::array<std::size_t, 2> global;  // along a row, rows; multiples of `local`
  std::array<std::size_t, 2> local;
  std::size_t block_rows;  // 0 where each work-item owns one node

  bool walks() const { return block_rows > 0; }
};

Range range_for(const GridPatch& grid, const OpenclDevice& device, int lanes) {
  if (grid_program_walks(lanes)) {
    const std::size_t rows = block_rows(grid.rows, device.compute_units);
    return {.global = {(grid.rows + rows - 1) / rows, 1}, .local = {1, 1}, .block_rows = rows};
  }
  // A tile, so that most neighbours of a group's nodes are its own; 64 wide, as wide as any hardware's groups
  // of lanes.
  const std::size_t largest = cl::Device(device.id, true).getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  const std::array<std::size_t, 2> local{std::min<std::size_t>(64, largest),
                                         std::clamp<std::size_t>(largest / 64, 1, 4)};
  return {.global = {round_up(grid.columns, local[0]), round_up(grid.rows, local[1])},
          .local = local,
          .block_rows = 0};
}

/// Where nodes lie in the planes of a pair (kernels/grid_parameters.h).
struct PlaneLayout {
  std::size_t columns, stride, plane;  // floats

  static constexpr std::size_t halo_rows = 2;   // above and below, as far as the stencil reaches
  static constexpr std::size_t left_halo = 16;  // floats; keeps every row aligned to the widest vector

  PlaneLayout(const GridPatch& grid, const Range& range)
      : columns(grid.columns),
        stride(left_halo + round_up(range.walks() ? grid.columns : range.global[0], left_halo)),
        plane(((range.walks() ? grid.rows : range.global[1]) + 2 * halo_rows) * stride + left_halo) {}

  std::size_t offset(std::size_t node) const {
    return (node / columns + halo_rows) * stride + left_halo + node % columns;
  }
  std::size_t floats_per_pair() const { return 6 * plane; }
};

/// Throws Unsupported unless the device can hold `pairs` buffers of this layout.
void check_size(const PlaneLayout& layout, std::size_t pairs, const OpenclDevice& device) {
  require_memory(device, std::vector<std::uint64_t>(pairs, layout.floats_per_pair() * sizeof(float)));
  if (layout.floats_per_pair() > std::numeric_limits<cl_int>::max())
    throw Unsupported(
        "the cloth needs OpenCL buffers of more than the 8191 MiB that the kernels' 32-bit "
        "offsets reach");
}

GridParameters parameters_of(const System& system, const GridPatch& patch, const Integrator& integrator,
                             double dt_s, const PlaneLayout& layout, const Range& range) {
  GridParameters grid{};
  grid.rows = static_cast<int>(patch.rows);
  grid.columns = static_cast<int>(patch.columns);
  grid.stride = static_cast<int>(layout.stride);
  grid.plane = static_cast<int>(layout.plane);
  grid.block_rows = static_cast<int>(range.block_rows);
  const double mass = require_uniform_mass(system);
  for (const GridSpringKind kind : {structural, shear, bending}) {
    const SpringMaterial& material = system.materials[kind];
    grid.stiffness[kind] = static_cast<float>(material.stiffness / mass);
    grid.stiffness_rest[kind] = static_cast<float>(material.stiffness * patch.rest_length(kind) / mass);
    grid.damping[kind] = static_cast<float>(material.damping / mass);
  }
  grid.viscous_damping = static_cast<float>(system.viscous_damping);
  grid.gravity = static_cast<float>(system.gravity);
  grid.floor_height = static_cast<float>(system.floor.height);
  grid.restitution = static_cast<float>(system.floor.restitution);
  grid.friction = static_cast<float>(system.floor.friction);
  const Coefficients<float> coefficients = coefficients_of<float>(integrator, dt_s);
  static_assert(sizeof(coefficients) == sizeof(grid.coefficients));
  std::memcpy(grid.coefficients, coefficients.data(), sizeof(grid.coefficients));
  return grid;
}

/// Which nodes are pinned, as grid_stage.cl reads it.
struct PinLines {
  std::vector<cl_int> line_of_row;  ///< [rows] line in `pinned`, or -1
  std::vector<cl_int> pinned;       ///< [lines][stride] -1 for a pinned node; at least one line

  PinLines(const System& system, std::size_t rows, const PlaneLayout& layout)
      : line_of_row(rows, -1), pinned(layout.stride, 0) {
    cl_int lines = 0;
    for (const std::uint32_t pin : system.pins) {
      cl_int& line = line_of_row[pin / layout.columns];
      if (line < 0) line = lines++;
      pinned.resize(std::max(pinned.size(), static_cast<std::size_t>(lines) * layout.stride), 0);
      pinned[static_cast<std::size_t>(line) * layout.stride + pin % layout.columns] = -1;
    }
  }
};

class OpenclCloth final : public Backend {
 public:
  OpenclCloth(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s,
              const OpenclDevice& device, int lanes)
      : device_(device),
        nodes_(system.nodes()),
        range_(range_for(grid, device, lanes)),
        layout_(grid, range_) {
    std::vector<Pair> stored;
    for (std::size_t i = 0; i < pair_kinds; ++i)
      if (stores(integrator, static_cast<Pair>(i), Storage::separate)) stored.push_back(static_cast<Pair>(i));
    check_size(layout_, stored.size(), device);

    const cl::Device cl_device(device.id, true);
    context_ = cl::Context(cl_device);
    queue_ = cl::CommandQueue(context_, cl_device);
    const GridParameters parameters = parameters_of(system, grid, integrator, dt_s, layout_, range_);
    const PinLines pins(system, grid.rows, layout_);
    parameters_ = filled_buffer(std::span(&parameters, 1));
    pin_rows_ = filled_buffer(std::span(pins.line_of_row));
    pins_ = filled_buffer(std::span(pins.pinned));
    // Zeros in the padding too, so that no arithmetic there meets a denormal number, which can be slow.
    const std::vector<float> zeros(layout_.floats_per_pair());
    for (const Pair pair : stored) pairs_[index(pair)] = filled_buffer(std::span(zeros));
    if (range_.walks())
      sums_.emplace(context_, range_.global[0] * 9 * layout_.stride, device.shares_host_memory);
    make_kernels(integrator, build_program(context_, cl_device, grid_program_text(integrator, lanes)));

    // Drivers finish compiling at a kernel's first launch with a range: take it here, in both roles of the
    // pairs.
    set_state(system.start);
    step(2);
    set_state(system.start);
  }

  void set_state(const State& state) override {
    opencl_call<std::runtime_error>([&] {
      const auto memory = present().map(queue_, CL_MAP_WRITE);
      for (std::size_t node = 0; node < nodes_; ++node) {
        float* at = &memory[layout_.offset(node)];
        for (const Vec3d& value : {state.position[node], state.velocity[node]})
          for (const double component : {value.x, value.y, value.z}) {
            *at = static_cast<float>(component);
            at += layout_.plane;
          }
      }
      present().unmap(queue_, memory);
      queue_.finish();
    });
  }

  void step(int count) override {
    opencl_call<std::runtime_error>([&] {
      const cl::NDRange global(range_.global[0], range_.global[1]), local(range_.local[0], range_.local[1]);
      std::size_t queued = 0;
      for (int i = 0; i < count; ++i) {
        for (const cl::Kernel& kernel : kernels_[swapped_ ? 1 : 0]) {
          queue_.enqueueNDRangeKernel(kernel, cl::NullRange, global, local);
          if (++queued % longest_queue == 0) queue_.finish();
        }
        swapped_ = !swapped_;
      }
      queue_.finish();
    });
  }

  State state() const override {
    return opencl_call<std::runtime_error>([&] {
      const auto memory = present().map(queue_, CL_MAP_READ);
      State state{std::vector<Vec3d>(nodes_), std::vector<Vec3d>(nodes_)};
      for (std::size_t node = 0; node < nodes_; ++node) {
        const float* at = &memory[layout_.offset(node)];
        const auto component = [&](std::size_t plane) { return double{at[plane * layout_.plane]}; };
        state.position[node] = {component(0), component(1), component(2)};
        state.velocity[node] = {component(3), component(4), component(5)};
      }
      present().unmap(queue_, memory);
      queue_.finish();
      return state;
    });
  }

  std::string device() const override { return device_.name; }
  int threads() const override {
    return device_.type == OpenclDeviceType::cpu ? static_cast<int>(device_.compute_units) : 1;
  }
  bool runs_on_host() const override { return device_.type == OpenclDeviceType::cpu; }

 private:
  /// A buffer with a copy of `values`.
  template <class T>
  OpenclBuffer<std::remove_const_t<T>> filled_buffer(std::span<T> values) const {
    OpenclBuffer<std::remove_const_t<T>> buffer(context_, values.size(), device_.shares_host_memory);
    const auto memory = buffer.map(queue_, CL_MAP_WRITE);
    std::copy(values.begin(), values.end(), memory.begin());
    buffer.unmap(queue_, memory);
    return buffer;
  }

  /// One kernel object per stage and role of the pairs, its arguments set once and for all.
  void make_kernels(const Integrator& integrator, const cl::Program& program) {
    for (const bool swapped : {false, true})
      for (std::size_t stage = 0; stage < integrator.stage_count; ++stage) {
        cl::Kernel kernel(program, stage_kernel_name(stage).c_str());
        cl_uint argument = 0;
        for (const Pair pair : stage_arguments(integrator.stages[stage]))
          kernel.setArg(argument++, pairs_[index(role(pair, swapped))]->buffer());
        kernel.setArg(argument++, parameters_->buffer());
        kernel.setArg(argument++, pin_rows_->buffer());
        kernel.setArg(argument++, pins_->buffer());
        if (sums_) kernel.setArg(argument++, sums_->buffer());
        kernels_[swapped ? 1 : 0].push_back(kernel);
      }
  }

  /// `state` and `next` change roles after every step.
  static Pair role(Pair pair, bool swapped) {
    if (swapped && pair == Pair::state) return Pair::next;
    if (swapped && pair == Pair::next) return Pair::state;
    return pair;
  }
  const OpenclBuffer<float>& present() const { return *pairs_[index(role(Pair::state, swapped_))]; }

  OpenclDevice device_;
  std::size_t nodes_;
  Range range_;
  PlaneLayout layout_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::array<std::optional<OpenclBuffer<float>>, pair_kinds>
      pairs_;  // [Pair], those that the integrator needs
  std::optional<OpenclBuffer<GridParameters>> parameters_;
  std::optional<OpenclBuffer<cl_int>> pin_rows_, pins_;
  std::optional<OpenclBuffer<float>> sums_;  // [blocks][3 rows][3 planes][stride], where work-items walk
  std::array<std::vector<cl::Kernel>, 2> kernels_;  // [swapped][stage]
  bool swapped_ = false;                            // the state lies in the pair `next`
};

constexpr bool all_swap_state() {
  for (const Integrator& integrator : integrators)
    if (!swaps_state(integrator, Storage::separate)) return false;
  return true;
}
static_assert(all_swap_state(), "step() swaps the two pairs after every step");

}  // namespace

std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const OpenclDevice& device, int lanes) {
  return opencl_call<Unavailable>([&]() -> std::unique_ptr<Backend> {
    return std::make_unique<OpenclCloth>(system, std::get<GridPatch>(system.topology), integrator, dt_s,
                                         device, lanes);
  });
}

std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  const OpenclDevice device = choose_opencl_device(opencl_devices(), options.device);
  return make_opencl(system, integrator, dt_s, device, lanes_for(device));
}

}  // namespace mssim
