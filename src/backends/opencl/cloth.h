#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "backends/layouts/band_grid.h"
#include "backends/opencl/stages.h"

namespace mssim {

/// Steps a cloth on an OpenCL device, `lanes` nodes side by side (1, 4, 8 or 16): with one lane a work-item
/// owns a node; with several, work-items walk over columns of as many bands of rows, several steps a launch.
/// `steps_in_a_launch`: chosen by the size of the cloth unless given. Lets cl::Error through; throws
/// Unsupported where the cloth does not fit into the device's memory.
std::unique_ptr<Backend> make_opencl_grid(const System& system, const GridPatch& grid,
                                          const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes,
                                          std::optional<std::size_t> steps_in_a_launch = {});

/// How the columns of a cloth are shared among the work-items of a launch that walks over them
/// (kernels/grid_bands.cl), and how many steps the launch takes.
struct BandShape {
  BandLayout bands;
  std::size_t steps = 1;       ///< of a launch
  std::size_t ghosts = 0;      ///< columns on each side of a partition
  std::size_t partitions = 0;  ///< work-items

  /// The shape whose steps take least on so many compute units with a cache of so many bytes;
  /// with `steps_in_a_launch` if that is given.
  BandShape(const GridPatch& grid, const Integrator& integrator, std::size_t lanes, std::size_t units,
            std::uint64_t cache_bytes, std::optional<std::size_t> steps_in_a_launch = {});

  /// First column of a partition.
  std::size_t first(std::size_t partition) const { return bands.columns * partition / partitions; }
  /// Columns that a partition keeps of a trial pair: at least as many as lie between the first stage and what
  /// the last one gathers.
  std::size_t ring() const;

  /// Layout of the state, which is one piece.
  PairLayout state_layout() const;
  std::size_t state_floats() const { return bands.columns * bands.column_floats(); }
  /// Layout of the ghosts, [partitions][2 ghosts] columns, all of them copies.
  PairLayout ghost_layout() const;
  std::size_t ghost_floats() const { return partitions * 2 * ghosts * bands.column_floats(); }

 private:
  /// The shape with so many steps a launch, and with so many partitions if the cloth has the columns.
  BandShape with(std::size_t steps_in_a_launch, std::size_t most_partitions,
                 const Integrator& integrator) const;
  /// How long a step takes, in the time in which a compute unit takes a node through a stage.
  double step_cost(const Integrator& integrator, std::size_t units) const;
  /// Places in a column of rows of the cloth, offset and row: those of halo rows.
  using Places = std::vector<std::pair<std::size_t, std::size_t>>;
  Places rows_in_halos() const;
};

}  // namespace mssim
