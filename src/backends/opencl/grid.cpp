#include "backends/opencl/grid.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "backends/layouts/band_grid.h"
#include "backends/layouts/spring_constants.h"
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
  const std::vector<SpringConstants> springs = spring_constants_of(system, patch);
  for (const GridSpringKind kind : {structural, shear, bending}) {
    const SpringConstants& spring = springs[kind];
    grid.stiffness[kind] = spring.stiffness;
    grid.stiffness_rest[kind] = spring.stiffness_rest;
    grid.damping[kind] = spring.damping;
  }
  return grid;
}

/// Masks of numbers, one for every row or column that differs from the others.
struct Masks {
  std::vector<cl_int> mask_of;  ///< [rows or columns] a mask, or a negative number
  std::vector<cl_int> numbers;  ///< [masks][length]
  std::size_t length;

  Masks(std::size_t count, std::size_t mask_length) : mask_of(count, -1), length(mask_length) {}

  /// The mask of a row or column; made from `model` where there is none.
  std::span<cl_int> mask(std::size_t number, const std::vector<cl_int>& model) {
    if (mask_of[number] < 0) {
      mask_of[number] = static_cast<cl_int>(numbers.size() / length);
      numbers.insert(numbers.end(), model.begin(), model.end());
    }
    return std::span(numbers).subspan(static_cast<std::size_t>(mask_of[number]) * length, length);
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
      : OpenclStages(system, integrator, dt_s, device, memory, Storage::separate, shape.pair_layout(), {}) {
    GridParameters parameters = parameters_of(system, shape.grid);
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

/// Few work-items, each a walk over columns of bands (kernels/grid_bands.cl).
struct BandShape {
  BandLayout bands;
  std::size_t partitions;  ///< work-items

  static constexpr std::size_t halo = BandLayout::halo;
  static constexpr std::size_t partition_ghosts = 2 * halo;  // columns

  BandShape(const GridPatch& grid, const OpenclDevice& device, int lanes)
      : bands(grid, static_cast<std::size_t>(lanes)) {
    // A few partitions for every compute unit, so that one that was held up leaves some of its share to the
    // others, unless the two further columns that each partition walks over were more than a small share of
    // it.
    constexpr std::size_t good_columns = 40, most_partitions_per_unit = 4;
    const std::size_t units = device.compute_units;
    partitions =
        units * std::clamp<std::size_t>(bands.columns / (good_columns * units), 1, most_partitions_per_unit);
    // A partition's ghosts belong to the partitions beside it.
    partitions = std::clamp<std::size_t>(bands.columns / halo, 1, partitions);
  }

  /// First column of a partition.
  std::size_t first(std::size_t partition) const { return bands.columns * partition / partitions; }

  PairLayout pair_layout() const {
    PairLayout pair;
    pair.floats = bands.columns * bands.column_floats();
    pair.ghost_floats = partitions * partition_ghosts * bands.column_floats();
    for (std::size_t i = 0; i < pair.component.size(); ++i) pair.component[i] = i * bands.lanes;
    // Places in a column of each row of the cloth: in its band, and where that repeats it in a halo row of
    // the band above or below.
    Copies in_bands, in_halos;
    for (std::size_t row = 0; row < bands.rows; ++row) {
      const std::size_t lane = row / bands.height, in_band = row % bands.height + halo;
      const auto offset = [&](std::size_t layout_row, std::size_t in_lane) {
        return layout_row * bands.row_floats() + in_lane;
      };
      in_bands.emplace_back(bands.offset(row), row);
      if (in_band < 2 * halo && lane > 0)
        in_halos.emplace_back(offset(in_band + bands.height, lane - 1), row);
      if (in_band >= bands.height && lane + 1 < bands.lanes)
        in_halos.emplace_back(offset(in_band - bands.height, lane + 1), row);
    }
    const auto add_column = [&](Copies& copies, std::size_t start, std::size_t column, const Copies& rows) {
      for (const auto& [offset, row] : rows)
        copies.emplace_back(start + offset, row * bands.columns + column);
    };
    for (const auto& [offset, row] : in_bands)
      for (std::size_t column = 0; column < bands.columns; ++column)
        pair.node.push_back(column * bands.column_floats() + offset);
    for (std::size_t column = 0; column < bands.columns; ++column)
      add_column(pair.copies, column * bands.column_floats(), column, in_halos);
    for (std::size_t partition = 0; partition < partitions; ++partition)
      for (std::size_t ghost = 0; ghost < partition_ghosts; ++ghost) {
        const std::size_t column = first(ghost < halo ? partition : partition + 1) + ghost - halo;
        if (column >= bands.columns) continue;  // left of the cloth it wraps to a huge number
        for (const Copies* rows : {&in_bands, &in_halos})
          add_column(pair.ghosts, (partition * partition_ghosts + ghost) * bands.column_floats(), column,
                     *rows);
      }
    return pair;
  }

 private:
  using Copies = std::vector<std::pair<std::size_t, std::size_t>>;
};

class OpenclGridBands final : public OpenclStages {
 public:
  OpenclGridBands(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s,
                  const OpenclDevice& device, DeviceMemory memory, const BandShape& shape)
      : OpenclStages(system, integrator, dt_s, device, memory, Storage::in_place, shape.pair_layout(), {}) {
    const BandLayout& bands = shape.bands;
    GridParameters parameters = parameters_of(system, grid);
    parameters.height = static_cast<int>(bands.height);
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
    add_argument(std::span<const GridParameters>(&parameters, 1));
    add_argument(std::span<const cl_int>(free.mask_of));
    add_argument(std::span<const cl_int>(free.numbers));
    add_buffer(shape.partitions * 3 * 3 * bands.height * bands.lanes *
               sizeof(float));  // [partitions][3 columns][x y z]
    prepare(grid_program_text(integrator, static_cast<int>(bands.lanes)),
            {cl::NDRange(shape.partitions), cl::NDRange(1)}, system.start);
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
