#pragma once

#include "commands/prepared_scene.h"
#include "output/structure_table.h"

namespace mssim {

/// What the mesh of a scene of bodies is. Throws std::invalid_argument for a scene without tetrahedra.
StructureRow structure_of(const PreparedScene& scene);

}  // namespace mssim
