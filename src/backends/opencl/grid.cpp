#include "backends/opencl/grid.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "backends/opencl/grid_program.h"
#include "backends/opencl/stages.h"
#include "kernels/grid_parameters.h"

namespace mssim {
namespace {

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

  PairLayout pair_layout(std::size_t nodes) const {
    PairLayout pair{.floats = 6 * plane, .node = {}, .component = {}};
    for (std::size_t node = 0; node < nodes; ++node) pair.node.push_back(offset(node));
    for (std::size_t i = 0; i < pair.component.size(); ++i) pair.component[i] = i * plane;
    return pair;
  }
};

GridParameters parameters_of(const System& system, const GridPatch& patch, const PlaneLayout& layout,
                             const Range& range) {
  if (6 * layout.plane > std::numeric_limits<cl_int>::max())
    throw Unsupported(
        "the cloth needs OpenCL buffers of more than the 8191 MiB that the kernels' 32-bit offsets reach");
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

class OpenclGrid final : public OpenclStages {
 public:
  OpenclGrid(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s,
             const OpenclDevice& device, DeviceMemory memory, int lanes, const Range& range,
             const PlaneLayout& layout)
      : OpenclStages(system, integrator, dt_s, device, memory, layout.pair_layout(system.nodes()), {}) {
    const GridParameters parameters = parameters_of(system, grid, layout, range);
    const PinLines pins(system, grid.rows, layout);
    add_argument(std::span(&parameters, 1));
    add_argument(std::span<const cl_int>(pins.line_of_row));
    add_argument(std::span<const cl_int>(pins.pinned));
    // [blocks][3 rows][3 planes][stride]
    if (range.walks()) add_buffer(range.global[0] * 9 * layout.stride * sizeof(float));
    prepare(grid_program_text(integrator, lanes),
            {cl::NDRange(range.global[0], range.global[1]), cl::NDRange(range.local[0], range.local[1])},
            system.start);
  }
};

}  // namespace

std::unique_ptr<Backend> make_opencl_grid(const System& system, const GridPatch& grid,
                                          const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes) {
  const Range range = range_for(grid, device, lanes);
  return std::make_unique<OpenclGrid>(system, grid, integrator, dt_s, device, memory, lanes, range,
                                      PlaneLayout(grid, range));
}

}  // namespace mssim
