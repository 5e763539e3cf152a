#include "backends/opencl/grid.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "backends/grid_bands/band_sheet.h"
#include "backends/opencl/grid_program.h"
#include "backends/opencl/stages.h"
#include "kernels/grid_parameters.h"

namespace mssim {
namespace {

constexpr std::size_t round_up(std::size_t value, std::size_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

/// What both shapes are told.
GridParameters parameters_of(const System& system, const GridPatch& patch) {
  GridParameters grid{};
  grid.rows = static_cast<int>(patch.rows);
  grid.columns = static_cast<int>(patch.columns);
  const double mass = require_uniform_mass(system);
  for (const GridSpringKind kind : {structural, shear, bending}) {
    const SpringMaterial& material = system.materials[kind];
    grid.stiffness[kind] = static_cast<float>(material.stiffness / mass);
    grid.stiffness_rest[kind] = static_cast<float>(material.stiffness * patch.rest_length(kind) / mass);
    grid.damping[kind] = static_cast<float>(material.damping / mass);
  }
  return grid;
}

/// Lines of numbers, one for every row or column that differs from the others.
struct Lines {
  std::vector<cl_int> line_of;  ///< [rows or columns] a line, or a negative number
  std::vector<cl_int> numbers;  ///< [lines][length]
  std::size_t length;

  Lines(std::size_t count, std::size_t line_length) : line_of(count, -1), length(line_length) {}

  /// The line of a row or column; made from `model` where there is none.
  std::span<cl_int> line(std::size_t number, const std::vector<cl_int>& model) {
    if (line_of[number] < 0) {
      line_of[number] = static_cast<cl_int>(numbers.size() / length);
      numbers.insert(numbers.end(), model.begin(), model.end());
    }
    return std::span(numbers).subspan(static_cast<std::size_t>(line_of[number]) * length, length);
  }
};

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
    PairLayout pair{.floats = 6 * plane, .node = {}, .copies = {}, .component = {}};
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
    GridParameters parameters = parameters_of(system, shape.grid);
    parameters.stride = static_cast<int>(shape.stride);
    parameters.plane = static_cast<int>(shape.plane);
    Lines pinned(shape.grid.rows, shape.stride);
    const std::vector<cl_int> none(shape.stride, 0);
    for (const std::uint32_t pin : system.pins)
      pinned.line(pin / shape.grid.columns, none)[pin % shape.grid.columns] = -1;
    add_argument(std::span<const GridParameters>(&parameters, 1));
    add_argument(std::span<const cl_int>(pinned.line_of));
    add_argument(std::span<const cl_int>(pinned.numbers));
    prepare(grid_program_text(integrator, 1),
            {cl::NDRange(shape.global[0], shape.global[1]), cl::NDRange(shape.local[0], shape.local[1])},
            system.start);
  }
};

/// Few work-items, each a walk over columns of bands (kernels/grid_bands.cl).
struct BandShape {
  BandLayout bands;
  std::size_t item_columns;

  BandShape(const GridPatch& grid, const OpenclDevice& device, int lanes) {
    bands.lanes = static_cast<std::size_t>(lanes);
    bands.rows = grid.rows;
    bands.columns = grid.columns;
    bands.height = std::max(BandLayout::halo, (bands.rows + bands.lanes - 1) / bands.lanes);
    // The two further columns that each item walks over shall be a small share, and yet every compute unit
    // shall have an item, or better several, so that one that was held up leaves some of its share to the
    // others.
    constexpr std::size_t good_columns = 40, good_items_per_unit = 4;
    const std::size_t units = device.compute_units;
    const std::size_t items = std::clamp(bands.columns / good_columns, units, good_items_per_unit * units);
    item_columns = (bands.columns + items - 1) / items;
  }

  std::size_t items() const { return (bands.columns + item_columns - 1) / item_columns; }

  PairLayout pair_layout() const {
    PairLayout pair{.floats = (bands.columns + 2 * BandLayout::halo) * bands.column_floats(),
                    .node = {},
                    .copies = {},
                    .component = {}};
    const auto offset = [&](std::size_t column, std::size_t halo_row, std::size_t lane) {
      return (column + BandLayout::halo) * bands.column_floats() + halo_row * bands.row_floats() + lane;
    };
    for (std::size_t row = 0; row < bands.rows; ++row)
      for (std::size_t column = 0; column < bands.columns; ++column) {
        const std::size_t lane = row / bands.height, in_band = row % bands.height;
        const std::size_t node = pair.node.size();
        pair.node.push_back(offset(column, in_band + BandLayout::halo, lane));
        if (in_band < BandLayout::halo && lane > 0)
          pair.copies.push_back({offset(column, in_band + BandLayout::halo + bands.height, lane - 1), node});
        if (in_band + BandLayout::halo >= bands.height && lane + 1 < bands.lanes)
          pair.copies.push_back({offset(column, in_band + BandLayout::halo - bands.height, lane + 1), node});
      }
    for (std::size_t i = 0; i < pair.component.size(); ++i) pair.component[i] = i * bands.lanes;
    return pair;
  }
};

class OpenclGridBands final : public OpenclStages {
 public:
  OpenclGridBands(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s,
                  const OpenclDevice& device, DeviceMemory memory, const BandShape& shape)
      : OpenclStages(system, integrator, dt_s, device, memory, shape.pair_layout(), {}) {
    const BandLayout& bands = shape.bands;
    GridParameters parameters = parameters_of(system, grid);
    parameters.height = static_cast<int>(bands.height);
    parameters.item_columns = static_cast<int>(shape.item_columns);
    const auto place = [&](std::size_t row) { return row % bands.height * bands.lanes + row / bands.height; };
    std::vector<cl_int> unpinned(bands.height * bands.lanes, 0);
    for (std::size_t row = 0; row < bands.rows; ++row) unpinned[place(row)] = -1;
    Lines free(bands.columns, unpinned.size());
    for (const std::uint32_t pin : system.pins)
      free.line(pin % bands.columns, unpinned)[place(pin / bands.columns)] = 0;
    // All columns without a pin share the last line.
    const auto last = static_cast<cl_int>(free.numbers.size() / unpinned.size());
    free.numbers.insert(free.numbers.end(), unpinned.begin(), unpinned.end());
    std::replace(free.line_of.begin(), free.line_of.end(), -1, last);
    add_argument(std::span<const GridParameters>(&parameters, 1));
    add_argument(std::span<const cl_int>(free.line_of));
    add_argument(std::span<const cl_int>(free.numbers));
    add_buffer(shape.items() * 3 * bands.force_floats() * sizeof(float));
    prepare(grid_program_text(integrator, static_cast<int>(bands.lanes)),
            {cl::NDRange(shape.items()), cl::NDRange(1)}, system.start);
  }
};

}  // namespace

std::unique_ptr<Backend> make_opencl_grid(const System& system, const GridPatch& grid,
                                          const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes) {
  if (grid_program_walks(lanes))
    return std::make_unique<OpenclGridBands>(system, grid, integrator, dt_s, device, memory,
                                             BandShape(grid, device, lanes));
  return std::make_unique<OpenclGridNodes>(system, integrator, dt_s, device, memory, NodeShape(grid, device));
}

}  // namespace mssim
