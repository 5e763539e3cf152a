#pragma once

#include "commands/shared/prepared_scene.h"
#include "output/tables/structure_table.h"

namespace mssim {

/// What the mesh of a scene of bodies is. Throws std::invalid_argument for a scene without tetrahedra.
StructureRow structure_of(const PreparedScene& scene);

}  // namespace mssim
