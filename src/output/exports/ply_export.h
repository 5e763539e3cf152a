#pragma once

#include <string>

#include "output/exports/export_mesh.h"

namespace mssim {

/// The bytes of a PLY, binary and little-endian: of each point x, y, z, the velocity vx, vy, vz, the strain
/// of its springs, its node in the trace and its part, whose names are comments; and the triangles.
std::string ply_of(const ExportMesh& mesh, const ExportFrame& frame);

}  // namespace mssim
