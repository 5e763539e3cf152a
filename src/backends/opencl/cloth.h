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

/// Steps a cloth on an OpenCL device, `lanes` nodes at a time (1, 4, 8 or 16): with one lane a work-item owns
/// a node; with several, work-items walk over columns of `lanes` bands of rows, several steps per launch.
/// `steps_in_a_launch`: by default chosen from the size of the cloth. May throw cl::Error; throws Unsupported
/// if the cloth does not fit into the device's memory.
std::unique_ptr<Backend> make_opencl_grid(const System& system, const GridPatch& grid,
                                          const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes,
                                          std::optional<std::size_t> steps_in_a_launch = {});

/// How the work-items of a launch that walks over the columns of a cloth share them (kernels/grid_bands.cl),
/// and how many steps the launch takes.
struct BandShape {
  BandLayout bands;
  std::size_t steps = 1;       ///< per launch
  std::size_t ghosts = 0;      ///< columns on each side of a partition
  std::size_t partitions = 0;  ///< work-items

  /// The shape whose steps are fastest on `units` compute units with a cache of `cache_bytes`; with
  /// `steps_in_a_launch` if given.
  BandShape(const GridPatch& grid, const Integrator& integrator, std::size_t lanes, std::size_t units,
            std::uint64_t cache_bytes, std::optional<std::size_t> steps_in_a_launch = {});

  /// First column of a partition.
  std::size_t first(std::size_t partition) const { return bands.columns * partition / partitions; }
  /// Columns that a partition keeps of a trial pair: at least those between the first stage and what the last
  /// one gathers.
  std::size_t ring() const;

  /// Layout of the state, which is contiguous.
  PairLayout state_layout() const;
  std::size_t state_floats() const { return bands.columns * bands.column_floats(); }
  /// Layout of the ghosts, [partitions][2 ghosts] columns, all of them copies.
  PairLayout ghost_layout() const;
  std::size_t ghost_floats() const { return partitions * 2 * ghosts * bands.column_floats(); }

 private:
  /// The shape with these steps per launch, and up to most_partitions partitions, as the columns allow.
  BandShape with(std::size_t steps_in_a_launch, std::size_t most_partitions,
                 const Integrator& integrator) const;
  /// Cost of a step, in the time of a compute unit for one stage of a node.
  double step_cost(const Integrator& integrator, std::size_t units) const;
  /// Offsets in a column and the cloth's rows there: those of halo rows.
  using Places = std::vector<std::pair<std::size_t, std::size_t>>;
  Places rows_in_halos() const;
};

}  // namespace mssim
