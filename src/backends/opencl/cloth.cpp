#include "backends/opencl/cloth.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>

#include "backends/layouts/node_arrays.h"
#include "backends/opencl/programs.h"
#include "kernels/parameters.h"

namespace mssim {
namespace {

constexpr std::size_t halo = BandLayout::halo;

/// Parameters of a cloth for the kernels of both shapes.
GridParameters grid_parameters_of(const System& system, const GridPatch& patch) {
  GridParameters grid{};
  grid.rows = static_cast<int>(patch.rows);
  grid.columns = static_cast<int>(patch.columns);
  const std::vector<SpringPerMass> springs = springs_per_mass(system, patch);
  for (const GridSpringKind kind : {structural, shear, bending}) {
    grid.constants[kind] = std::bit_cast<SpringFloats>(springs[kind].constants);
    grid.stiffness_rest[kind] = springs[kind].stiffness_rest;
  }
  return grid;
}

/// Masks of integers, one for every row or column that differs from the others.
struct Masks {
  std::vector<cl_int> mask_of;  ///< [rows or columns] a mask, or a negative number
  std::vector<cl_int> numbers;  ///< [masks][length]
  std::size_t length;

  Masks(std::size_t count, std::size_t mask_length) : mask_of(count, -1), length(mask_length) {}

  /// The mask of a row or column; copied from `model` if it has none.
  std::span<cl_int> mask(std::size_t number, const std::vector<cl_int>& model) {
    if (mask_of[number] < 0) {
      mask_of[number] = static_cast<cl_int>(numbers.size() / length);
      numbers.insert(numbers.end(), model.begin(), model.end());
    }
    return std::span(numbers).subspan(static_cast<std::size_t>(mask_of[number]) * length, length);
  }
};

/// One work-item per node (kernels/grid_nodes.cl).
std::unique_ptr<Backend> make_grid_nodes(const System& system, const GridPatch& grid,
                                         const Integrator& integrator, double dt_s,
                                         const OpenclDevice& device, DeviceMemory memory) {
  constexpr std::size_t left_halo = 16;  // floats; keeps every row aligned to what hardware reads
  // A group is a tile, along a row and rows, so that most neighbours of its nodes are its own; 64 wide, at
  // least as wide as the SIMD groups of any hardware.
  const std::size_t largest = cl::Device(device.id, true).getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  const std::array<std::size_t, 2> local{std::min<std::size_t>(64, largest),
                                         std::clamp<std::size_t>(largest / 64, 1, 4)};
  const std::array global{round_up(grid.columns, local[0]), round_up(grid.rows, local[1])};
  const std::size_t stride = left_halo + round_up(global[0], left_halo);
  const std::size_t plane = (global[1] + 2 * halo) * stride + left_halo;
  if (6 * plane > std::numeric_limits<cl_int>::max())
    throw Unsupported(
        "the cloth needs OpenCL buffers of more than the 8191 MiB that the kernels' 32-bit offsets reach");
  PairLayout pair(6 * plane, plane);
  for (std::size_t node = 0; node < grid.nodes(); ++node)
    pair.node.push_back((node / grid.columns + halo) * stride + left_halo + node % grid.columns);
  GridParameters parameters = grid_parameters_of(system, grid);
  parameters.stride = static_cast<int>(stride);
  parameters.plane = static_cast<int>(plane);
  Masks pinned(grid.rows, stride);
  const std::vector<cl_int> none(stride, 0);
  for (const std::uint32_t pin : system.pins) pinned.mask(pin / grid.columns, none)[pin % grid.columns] = -1;
  return std::make_unique<OpenclStages>(
      system, integrator, dt_s, device, memory,
      StageKernels{std::move(pair),
                   {bytes_of(parameters), bytes_of(pinned.mask_of), bytes_of(pinned.numbers)},
                   grid_program_text(integrator, 1),
                   {cl::NDRange(global[0], global[1]), cl::NDRange(local[0], local[1])}});
}

/// A cloth in bands, with several steps per launch.
class OpenclBands final : public OpenclBackend {
 public:
  OpenclBands(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s,
              const OpenclDevice& device, DeviceMemory memory, const BandShape& shape)
      : OpenclBackend(system, integrator, dt_s, device, memory, shape.state_layout(),
                      std::array<std::uint64_t, 4>{shape.state_floats() * sizeof(float),
                                                   2 * shape.ghost_floats() * sizeof(float),
                                                   ring_bytes(shape, integrator), sum_bytes(shape)}),
        ghost_layout_(shape.ghost_layout()),
        steps_per_launch_(static_cast<int>(shape.steps)),
        state_(queue_.zeros<float>(layout_.floats)),
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

    add_argument(bytes_of(parameters));
    add_argument(bytes_of(free.mask_of));
    add_argument(bytes_of(free.numbers));
    // Zeros in the padding too, so that no arithmetic meets a denormal number, which can be slow.
    arguments_.push_back(queue_.zeros<char>(ring_bytes(shape, integrator)));
    arguments_.push_back(queue_.array<char>(sum_bytes(shape)));
    const cl::Program program = queue_.build(grid_program_text(integrator, static_cast<int>(bands.lanes)));
    for (const bool swapped : {false, true})
      for (int steps = 1; steps <= steps_per_launch_; ++steps) {
        cl::Kernel kernel(program, steps_kernel_name);
        kernel.setArg(0, state_.buffer());
        kernel.setArg(1, ghosts_.buffer());
        kernel.setArg(2, cl_int{swapped ? 1 : 0});
        kernel.setArg(3, cl_int{steps});
        add_launch(swapped, kernel, 4, {cl::NDRange(shape.partitions), cl::NDRange(1)});
      }
    warm_up(*this, system.start, 2 * steps_per_launch_);
  }

  void set_state(const State& state) override {
    write_state(state_, layout_, state);
    write_state(ghosts_, ghost_layout_, state, swapped_ ? ghost_layout_.floats : 0);
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
  State state() const override { return read_state(state_); }
  int steps_per_pass() const override { return steps_per_launch_; }

 private:
  static std::uint64_t ring_bytes(const BandShape& shape, const Integrator& integrator) {
    const std::size_t pairs = stored_pairs(integrator, Storage::in_place).size() - 1;
    return shape.partitions * pairs * shape.ring() * shape.bands.column_floats() * sizeof(float);
  }
  static std::uint64_t sum_bytes(const BandShape& shape) {
    return shape.partitions * shape.ghosts / BandLayout::halo * 3 * 3 * shape.bands.height *
           shape.bands.lanes * sizeof(float);
  }

  PairLayout ghost_layout_;
  int steps_per_launch_;
  OpenclBuffer<float> state_, ghosts_;  // ghosts: to be read and to be written, alternating
};

}  // namespace

std::unique_ptr<Backend> make_opencl_grid(const System& system, const GridPatch& grid,
                                          const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes,
                                          std::optional<std::size_t> steps_in_a_launch) {
  if (lanes == 1) return make_grid_nodes(system, grid, integrator, dt_s, device, memory);
  const auto cache_bytes = cl::Device(device.id, true).getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
  return std::make_unique<OpenclBands>(system, grid, integrator, dt_s, device, memory,
                                       BandShape(grid, integrator, static_cast<std::size_t>(lanes),
                                                 device.compute_units, cache_bytes, steps_in_a_launch));
}

BandShape::BandShape(const GridPatch& grid, const Integrator& integrator, std::size_t lanes,
                     std::size_t units, std::uint64_t cache_bytes,
                     std::optional<std::size_t> steps_in_a_launch)
    : bands(grid, lanes) {
  constexpr std::size_t most_stages = 16;  // whose columns still fit in a second-level cache
  constexpr std::size_t most_partitions_per_unit = 4;
  // If half of the cache does not hold the state, it comes from memory: more steps per launch then also mean
  // fewer passes over it, as in the host's walk.
  const bool fits = bands.columns * bands.column_floats() * sizeof(float) <= cache_bytes / 2;
  const std::size_t fewest = fits ? 1 : stages_under_way / integrator.stage_count;
  const std::size_t first = steps_in_a_launch.value_or(fewest);
  const std::size_t last = steps_in_a_launch.value_or(most_stages / integrator.stage_count);
  BandShape best = with(first, units, integrator);
  for (std::size_t count = first; count <= last; ++count)
    for (std::size_t per_unit = 1; per_unit <= most_partitions_per_unit; ++per_unit) {
      const BandShape shape = with(count, per_unit * units, integrator);
      if (shape.step_cost(integrator, units) < best.step_cost(integrator, units)) best = shape;
    }
  *this = best;
}

BandShape BandShape::with(std::size_t steps_in_a_launch, std::size_t most_partitions,
                          const Integrator& integrator) const {
  BandShape shape = *this;
  shape.steps = steps_in_a_launch;
  shape.ghosts = halo * integrator.stage_count * shape.steps;
  // A partition's ghosts belong to the adjacent partitions.
  shape.partitions = std::clamp<std::size_t>(bands.columns / shape.ghosts, 1, most_partitions);
  return shape;
}

double BandShape::step_cost(const Integrator& integrator, std::size_t units) const {
  // In units of 4 ns, the time of a node and stage with PoCL on two cores of Zen 4 or of an Intel Xeon. A
  // launch that wakes both threads of a virtual machine takes 36 to 41 microseconds on the Xeon; on Zen 4 a
  // nearly empty one, which wakes one thread, took 4. With a value between them, the chosen steps were at
  // most 2 % from the best on the Xeon, and would also be if a launch took 6 microseconds and these costs
  // hold. More steps mean fewer launches and more ghosts, which are computed twice; more partitions let
  // others take over part of a delayed compute unit's share.
  constexpr double launch = 6000;
  constexpr double unevenness = 0.05;  // fraction of a partition's time by which the last one is late
  const auto number = [](std::size_t count) { return static_cast<double>(count); };
  // The first stage walks over all ghosts of a side, the last one over none.
  const double sides = std::min(number(partitions) - 1, 2.0);
  const double columns = number(bands.columns) / number(partitions) + sides / 2 * number(ghosts);
  const double in_turn = std::max(1.0, number(partitions) / number(units));
  return launch / number(steps) +
         number(integrator.stage_count * bands.rows) * columns * (in_turn + unevenness);
}

std::size_t BandShape::ring() const { return std::bit_ceil(ghosts); }

PairLayout BandShape::state_layout() const {
  PairLayout pair(state_floats(), bands.lanes);
  for (std::size_t row = 0; row < bands.rows; ++row)
    for (std::size_t column = 0; column < bands.columns; ++column)
      pair.node.push_back(column * bands.column_floats() + bands.offset(row));
  const Places halos = rows_in_halos();
  for (std::size_t column = 0; column < bands.columns; ++column)
    for (const auto& [offset, row] : halos)
      pair.copies.emplace_back(column * bands.column_floats() + offset, row * bands.columns + column);
  return pair;
}

PairLayout BandShape::ghost_layout() const {
  PairLayout pair(ghost_floats(), bands.lanes);
  Places places = rows_in_halos();
  for (std::size_t row = 0; row < bands.rows; ++row) places.emplace_back(bands.offset(row), row);
  for (std::size_t number = 0; number < partitions * 2 * ghosts; ++number) {
    const std::size_t partition = number / (2 * ghosts), ghost = number % (2 * ghosts);
    const std::size_t column = first(ghost < ghosts ? partition : partition + 1) + ghost - ghosts;
    if (column >= bands.columns) continue;  // left of the cloth it wraps to a huge number
    for (const auto& [offset, row] : places)
      pair.copies.emplace_back(number * bands.column_floats() + offset, row * bands.columns + column);
  }
  return pair;
}

BandShape::Places BandShape::rows_in_halos() const {
  Places places;
  for (std::size_t row = 0; row < bands.rows; ++row) {
    const std::size_t lane = row / bands.height, in_band = row % bands.height + halo;
    if (in_band < 2 * halo && lane > 0)
      places.emplace_back((in_band + bands.height) * bands.row_floats() + lane - 1, row);
    if (in_band >= bands.height && lane + 1 < bands.lanes)
      places.emplace_back((in_band - bands.height) * bands.row_floats() + lane + 1, row);
  }
  return places;
}

}  // namespace mssim
