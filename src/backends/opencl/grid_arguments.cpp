#include "backends/opencl/grid_arguments.h"

#include "backends/layouts/spring_constants.h"

namespace mssim {

GridParameters grid_parameters_of(const System& system, const GridPatch& patch) {
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

}  // namespace mssim
