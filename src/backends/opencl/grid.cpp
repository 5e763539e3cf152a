#include "backends/opencl/grid.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "backends/opencl/bands.h"
#include "backends/opencl/grid_arguments.h"
#include "backends/opencl/grid_program.h"
#include "backends/opencl/stages.h"

namespace mssim {
namespace {

constexpr std::size_t round_up(std::size_t value, std::size_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

/// One work-item a node (kernels/grid_nodes.cl).
struct NodeShape {
  GridPatch grid;
  std::array<std::size_t, 2> local;   // along a row, rows
  std::array<std::size_t, 2> global;  // multiples of `local`
  std::size_t stride, plane;          // floats

  static constexpr std::size_t halo_rows = 2;   // above and below, as far as the stencil reaches
  static constexpr std::size_t left_halo = 16;  // floats; keeps every row aligned to what hardware reads

  // A tile, so that most neighbours of a group's nodes are its own; 64 wide, as wide as any hardware's groups
  // of lanes.
  NodeShape(const GridPatch& patch, const OpenclDevice& device) : grid(patch) {
    const std::size_t largest = cl::Device(device.id, true).getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    local = {std::min<std::size_t>(64, largest), std::clamp<std::size_t>(largest / 64, 1, 4)};
    global = {round_up(grid.columns, local[0]), round_up(grid.rows, local[1])};
    stride = left_halo + round_up(global[0], left_halo);
    plane = (global[1] + 2 * halo_rows) * stride + left_halo;
    if (6 * plane > std::numeric_limits<cl_int>::max())
      throw Unsupported(
          "the cloth needs OpenCL buffers of more than the 8191 MiB that the kernels' 32-bit offsets reach");
  }

  PairLayout pair_layout() const {
    PairLayout pair;
    pair.floats = 6 * plane;
    for (std::size_t node = 0; node < grid.nodes(); ++node)
      pair.node.push_back((node / grid.columns + halo_rows) * stride + left_halo + node % grid.columns);
    for (std::size_t i = 0; i < pair.component.size(); ++i) pair.component[i] = i * plane;
    return pair;
  }
};

class OpenclGridNodes final : public OpenclStages {
 public:
  OpenclGridNodes(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
                  DeviceMemory memory, const NodeShape& shape)
      : OpenclStages(system, integrator, dt_s, device, memory, shape.pair_layout(), {}) {
    GridParameters parameters = grid_parameters_of(system, shape.grid);
    parameters.stride = static_cast<int>(shape.stride);
    parameters.plane = static_cast<int>(shape.plane);
    Masks pinned(shape.grid.rows, shape.stride);
    const std::vector<cl_int> none(shape.stride, 0);
    for (const std::uint32_t pin : system.pins)
      pinned.mask(pin / shape.grid.columns, none)[pin % shape.grid.columns] = -1;
    add_argument(std::span<const GridParameters>(&parameters, 1));
    add_argument(std::span<const cl_int>(pinned.mask_of));
    add_argument(std::span<const cl_int>(pinned.numbers));
    prepare(grid_program_text(integrator, 1),
            {cl::NDRange(shape.global[0], shape.global[1]), cl::NDRange(shape.local[0], shape.local[1])},
            system.start);
  }
};

}  // namespace

std::unique_ptr<Backend> make_opencl_grid(const System& system, const GridPatch& grid,
                                          const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes) {
  if (grid_program_walks(lanes))
    return make_opencl_bands(system, grid, integrator, dt_s, device, memory, lanes);
  return std::make_unique<OpenclGridNodes>(system, integrator, dt_s, device, memory, NodeShape(grid, device));
}

}  // namespace mssim
