#pragma once

#include <string>

#include "output/exports/export_mesh.h"

namespace mssim {

/// The text of a Wavefront OBJ: points, and triangles as an object a part. Numbers read back as the same.
std::string obj_of(const ExportMesh& mesh, const ExportFrame& frame);

}  // namespace mssim
